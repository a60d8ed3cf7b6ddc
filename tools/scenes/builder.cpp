// Builds a glTF 2.0 binary file in memory.
#include "tools/scenes/builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

namespace gnomon::generate {
namespace {

using Json = nlohmann::json;

constexpr double kGrid = 65536.0;
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963, kTypeFloat = 5126, kTypeShort = 5123,
              kTypeInt = 5125;

float on_grid(double value) { return static_cast<float>(std::round(value * kGrid) / kGrid) + 0.0f; }
double rounded(double value) { return std::round(value * 1e9) / 1e9 + 0.0; }
Json to_json(const glm::dvec3& v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

Json rotation_json(const glm::dmat3& rotation) {
  const glm::dvec4 q = rotation_value(rotation);
  return {rounded(q.x), rounded(q.y), rounded(q.z), rounded(q.w)};
}

Json area_json(const AreaLight& area) {
  using Kind = AreaLight::Shape;  // Shape is a mesh here
  Json json = Json::object();
  if (area.shape == Kind::polygon) {
    json["shape"] = "polygon";
    for (const glm::dvec2& p : area.outline) json["outline"].push_back({p.x, p.y});
  } else if (area.shape == Kind::rectangle) {
    json = {{"width", area.width}, {"height", area.height}};
  } else {
    json = {{"shape", area.shape == Kind::disc ? "disc" : "sphere"}, {"radius", 0.5 * area.width}};
  }
  if (area.emission) json["emission"] = *area.emission;
  return json;
}

}  // namespace

glm::dvec4 rotation_value(const glm::dmat3& rotation) {
  glm::dquat q = glm::normalize(glm::quat_cast(rotation));
  if (q.w < 0) q = -q;
  return {q.x, q.y, q.z, q.w};
}

glm::dmat3 looking(const glm::dvec3& direction) {
  const glm::dvec3 z = -glm::normalize(direction);
  const glm::dvec3 up = std::abs(z.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 x = glm::normalize(glm::cross(up, z));
  return {x, glm::cross(z, x), z};
}

uint32_t Shape::vertex(const glm::dvec3& position, const glm::dvec3& normal) {
  positions.push_back(position);
  normals.push_back(normal);
  return static_cast<uint32_t>(positions.size() - 1);
}

void Shape::triangle(uint32_t a, uint32_t b, uint32_t c) { indices.insert(indices.end(), {a, b, c}); }

void Shape::quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const glm::dvec3 n = glm::normalize(glm::cross(c - a, d - b));
  const uint32_t first = vertex(a, n);
  for (const glm::dvec3& p : {b, c, d}) vertex(p, n);
  triangle(first, first + 1, first + 2);
  triangle(first, first + 2, first + 3);
}

void Shape::flat_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
  const uint32_t first = vertex(a, n);
  vertex(b, n);
  vertex(c, n);
  triangle(first, first + 1, first + 2);
}

struct Builder::Impl {
  Json document;
  std::string bytes;

  size_t view(const void* data, size_t size, int target) {
    while (bytes.size() % 4 != 0) bytes.push_back('\0');
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    document["bufferViews"].push_back(view);
    bytes.append(static_cast<const char*>(data), size);
    return document["bufferViews"].size() - 1;
  }

  size_t accessor(size_t view, int component, size_t count, const char* type) {
    document["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return document["accessors"].size() - 1;
  }

  size_t vectors(const std::vector<glm::dvec3>& values, bool with_bounds) {
    std::vector<float> data;
    glm::vec3 low(1e30f), high(-1e30f);
    for (const glm::dvec3& v : values) {
      const glm::vec3 p(on_grid(v.x), on_grid(v.y), on_grid(v.z));
      low = glm::min(low, p), high = glm::max(high, p);
      data.insert(data.end(), {p.x, p.y, p.z});
    }
    const size_t result =
        accessor(view(data.data(), data.size() * 4, kArrayBuffer), kTypeFloat, values.size(), "VEC3");
    if (with_bounds) {
      document["accessors"][result]["min"] = {low.x, low.y, low.z};
      document["accessors"][result]["max"] = {high.x, high.y, high.z};
    }
    return result;
  }

  size_t coordinates(const std::vector<glm::dvec2>& values) {
    std::vector<float> data;
    for (const glm::dvec2& v : values) data.insert(data.end(), {on_grid(v.x), on_grid(v.y)});
    return accessor(view(data.data(), data.size() * 4, kArrayBuffer), kTypeFloat, values.size(), "VEC2");
  }

  size_t triangles(const Shape& shape) {
    if (shape.positions.size() < 65535) {
      const std::vector<uint16_t> small(shape.indices.begin(), shape.indices.end());
      return accessor(view(small.data(), small.size() * 2, kElementBuffer), kTypeShort, small.size(),
                      "SCALAR");
    }
    return accessor(view(shape.indices.data(), shape.indices.size() * 4, kElementBuffer), kTypeInt,
                    shape.indices.size(), "SCALAR");
  }

  size_t add_node(Json node) {
    document["nodes"].push_back(std::move(node));
    const size_t index = document["nodes"].size() - 1;
    document["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  size_t add_light(const Json& light) {
    document["extensionsUsed"] = Json::array({"KHR_lights_punctual"});
    Json& lights = document["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(light);
    return lights.size() - 1;
  }
};

Builder::Builder(std::string name) : impl_(std::make_unique<Impl>()) {
  impl_->document["asset"] = {{"version", "2.0"}, {"generator", "gnomon scene generate"}};
  impl_->document["scene"] = 0;
  impl_->document["scenes"] = Json::array({{{"name", std::move(name)}, {"nodes", Json::array()}}});
}

Builder::~Builder() = default;

uint32_t Builder::texture(const std::string& name, const std::string& png, bool nearest) {
  Json& document = impl_->document;
  const size_t view = impl_->view(png.data(), png.size(), 0);
  document["images"].push_back({{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
  constexpr int filter_nearest = 9728, filter_linear = 9729, clamp_to_edge = 33071;
  const int filter = nearest ? filter_nearest : filter_linear;
  const Json sampler = {
      {"magFilter", filter}, {"minFilter", filter}, {"wrapS", clamp_to_edge}, {"wrapT", clamp_to_edge}};
  Json& samplers = document["samplers"];
  const auto found = std::find(samplers.begin(), samplers.end(), sampler);
  const auto index = static_cast<size_t>(found - samplers.begin());
  if (index == samplers.size()) samplers.push_back(sampler);
  document["textures"].push_back(
      {{"name", name}, {"source", document["images"].size() - 1}, {"sampler", index}});
  return static_cast<uint32_t>(document["textures"].size() - 1);
}

uint32_t Builder::material(const Surface& surface) {
  const glm::dvec3& c = surface.color;
  Json pbr = {{"baseColorFactor", {c.x, c.y, c.z, 1.0}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
  if (surface.texture) pbr["baseColorTexture"] = {{"index", *surface.texture}};
  Json material = {{"name", surface.name}, {"pbrMetallicRoughness", pbr}};
  if (surface.double_sided) material["doubleSided"] = true;
  if (surface.alpha_cutoff) material["alphaMode"] = "MASK", material["alphaCutoff"] = *surface.alpha_cutoff;
  impl_->document["materials"].push_back(material);
  return static_cast<uint32_t>(impl_->document["materials"].size() - 1);
}

uint32_t Builder::mesh(const std::string& name, const Shape& shape, uint32_t material) {
  Json attributes = {{"POSITION", impl_->vectors(shape.positions, true)},
                     {"NORMAL", impl_->vectors(shape.normals, false)}};
  if (!shape.uvs.empty()) attributes["TEXCOORD_0"] = impl_->coordinates(shape.uvs);
  const Json primitive = {
      {"attributes", attributes}, {"indices", impl_->triangles(shape)}, {"material", material}};
  impl_->document["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
  return static_cast<uint32_t>(impl_->document["meshes"].size() - 1);
}

void Builder::node(const std::string& name, uint32_t mesh, const Placement& placement) {
  Json node = {{"name", name}, {"mesh", mesh}};
  if (placement.translation != glm::dvec3(0.0)) node["translation"] = to_json(placement.translation);
  if (placement.rotation != glm::dmat3(1.0)) node["rotation"] = rotation_json(placement.rotation);
  if (placement.scale != glm::dvec3(1.0)) node["scale"] = to_json(placement.scale);
  impl_->add_node(std::move(node));
}

void Builder::add(const std::string& name, const Shape& shape, uint32_t material) {
  node(name, mesh(name, shape, material));
}

void Builder::camera(const glm::dvec3& eye, const glm::dvec3& target, double fov_y, double near) {
  impl_->document["cameras"].push_back(
      {{"name", "camera"},
       {"type", "perspective"},
       {"perspective", {{"yfov", rounded(fov_y / 180 * std::numbers::pi)}, {"znear", near}}}});
  impl_->add_node({{"name", "camera"},
                   {"camera", impl_->document["cameras"].size() - 1},
                   {"translation", to_json(eye)},
                   {"rotation", rotation_json(looking(target - eye))}});
}

void Builder::spot(const glm::dvec3& eye, const glm::dvec3& target, double map_fov, double radiance,
                   double side) {
  const double square = side > 0 ? side : std::round(4.0 * glm::length(target - eye)) / 100.0;
  area_spot("light", eye, target, map_fov, radiance, {AreaLight::Shape::rectangle, square, square, {}, {}});
}

void Builder::area_spot(const std::string& name, const glm::dvec3& eye, const glm::dvec3& target,
                        double map_fov, double radiance, const AreaLight& area) {
  const double distance = glm::length(target - eye), degree = std::numbers::pi / 180;
  const double diagonal =
      std::atan(std::sqrt(2.0) * std::tan(0.5 * map_fov * degree));  // the square is inside the cone
  const size_t light = impl_->add_light(
      {{"name", name},
       {"type", "spot"},
       {"intensity", std::round(radiance * std::numbers::pi * distance * distance)},
       {"spot", {{"innerConeAngle", rounded(diagonal)}, {"outerConeAngle", rounded(diagonal + degree)}}}});
  impl_->add_node({{"name", name},
                   {"translation", to_json(eye)},
                   {"rotation", rotation_json(looking(target - eye))},
                   {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}},
                   {"extras", {{"area_light", area_json(area)}, {"light", {{"fovy_deg", map_fov}}}}}});
}

void Builder::lamp(const glm::dvec3& place, double distance, double radiance, double radius) {
  const size_t light =
      impl_->add_light({{"name", "lamp"},
                        {"type", "point"},
                        {"intensity", std::round(radiance * std::numbers::pi * distance * distance)}});
  impl_->add_node({{"name", "lamp"},
                   {"translation", to_json(place)},
                   {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}},
                   {"extras", {{"area_light", {{"shape", "sphere"}, {"radius", radius}}}}}});
}

void Builder::sun(const glm::dvec3& direction, double radiance, double angular_diameter) {
  const size_t light = impl_->add_light(
      {{"name", "sun"}, {"type", "directional"}, {"intensity", rounded(radiance * std::numbers::pi)}});
  Json node = {{"name", "sun"},
               {"rotation", rotation_json(looking(direction))},
               {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
  if (angular_diameter > 0) node["extras"]["area_light"]["angular_diameter"] = angular_diameter;
  impl_->add_node(std::move(node));
}

void Builder::move(const std::string& node, const Motion& motion) {
  Json& document = impl_->document;
  size_t index = document["nodes"].size() - 1;
  while (index > 0 && document["nodes"][index]["name"] != node) --index;
  std::vector<float> times, values;
  for (const double t : motion.times) times.push_back(on_grid(t));
  const int components = motion.property == "rotation" ? 4 : 3;
  for (const glm::dvec4& v : motion.values)
    for (int i = 0; i < components; ++i) values.push_back(on_grid(v[i]));
  const size_t input =
      impl_->accessor(impl_->view(times.data(), times.size() * 4, 0), kTypeFloat, times.size(), "SCALAR");
  document["accessors"][input]["min"] = {times.front()};  // glTF asks for both
  document["accessors"][input]["max"] = {times.back()};
  const size_t output = impl_->accessor(impl_->view(values.data(), values.size() * 4, 0), kTypeFloat,
                                        motion.values.size(), components == 4 ? "VEC4" : "VEC3");
  if (!document.contains("animations"))
    document["animations"] = Json::array({{{"channels", Json::array()}, {"samplers", Json::array()}}});
  Json& animation = document["animations"][0];
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", index}, {"path", motion.property}}}});
  animation["samplers"].push_back({{"input", input}, {"output", output}});
}

std::string Builder::glb() const {
  Json document = impl_->document;
  std::string data = impl_->bytes;
  data.resize((data.size() + 3) / 4 * 4, '\0');
  document["buffers"] = Json::array({{{"byteLength", data.size()}}});
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string file = "glTF";
  const auto word = [&](size_t value) {
    for (int i = 0; i < 4; ++i) file.push_back(static_cast<char>(value >> (8 * i) & 0xFF));
  };
  word(2);
  word(12 + 8 + text.size() + 8 + data.size());
  word(text.size());
  file += "JSON" + text;
  word(data.size());
  file += std::string("BIN\0", 4) + data;
  return file;
}

}  // namespace gnomon::generate
