// Writes a scene as a .glb file, so that other programs show what Gnomon has read.
#include "tools/scene_export.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>

#include "engine/image/png.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;

constexpr int kFloat = 5126, kUnsignedInt = 5125;                // component types
constexpr int kVertices = 34962, kIndices = 34963;               // targets of buffer views
constexpr int kNearest = 9728, kLinear = 9729;                   // filters
constexpr int kClamp = 33071, kMirror = 33648, kRepeat = 10497;  // wrap modes

class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {}

  std::string write() {
    for (const Mesh& mesh : scene_.meshes) document_["meshes"].push_back(mesh_json(mesh));
    for (const Texture& texture : scene_.textures) add_texture(texture);
    for (const Material& material : scene_.materials)
      document_["materials"].push_back(material_json(material));
    for (const Instance& instance : scene_.instances)
      if (instance.visible) add_node(instance.name, instance.world_from_object, {{"mesh", instance.mesh}});
    for (size_t i = 0; i < scene_.cameras.size(); ++i) {
      document_["cameras"].push_back(camera_json(scene_.cameras[i]));
      add_node(scene_.cameras[i].name, scene_.cameras[i].world_from_camera, {{"camera", i}});
    }
    for (size_t i = 0; i < scene_.lights.size(); ++i) add_light(scene_.lights[i], i);
    document_["buffers"] = {{{"byteLength", data_.size()}}};
    return container();
  }

 private:
  size_t add_view(std::span<const std::byte> bytes, int target) {
    data_.resize((data_.size() + 3) / 4 * 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    data_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    document_["bufferViews"].push_back(std::move(view));
    return document_["bufferViews"].size() - 1;
  }

  template <typename T>
  size_t add_accessor(const std::vector<T>& values, const char* type, int component, int target) {
    document_["accessors"].push_back({{"bufferView", add_view(std::as_bytes(std::span(values)), target)},
                                      {"componentType", component},
                                      {"count", values.size()},
                                      {"type", type}});
    return document_["accessors"].size() - 1;
  }

  Json mesh_json(const Mesh& mesh) {
    glm::vec3 low(mesh.positions.front()), high(low);
    for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
    const size_t positions = add_accessor(mesh.positions, "VEC3", kFloat, kVertices);
    document_["accessors"][positions]["min"] = {low.x, low.y, low.z};
    document_["accessors"][positions]["max"] = {high.x, high.y, high.z};
    Json attributes = {{"POSITION", positions},
                       {"NORMAL", add_accessor(mesh.normals, "VEC3", kFloat, kVertices)},
                       {"TEXCOORD_0", add_accessor(mesh.uvs, "VEC2", kFloat, kVertices)}};
    if (!mesh.colors.empty()) attributes["COLOR_0"] = add_accessor(mesh.colors, "VEC4", kFloat, kVertices);
    return {{"name", mesh.name},
            {"primitives",
             {{{"attributes", attributes},
               {"indices", add_accessor(mesh.indices, "SCALAR", kUnsignedInt, kIndices)},
               {"material", mesh.material}}}}};
  }

  static int wrap_mode(Wrap wrap) {
    return wrap == Wrap::clamp ? kClamp : wrap == Wrap::mirror ? kMirror : kRepeat;
  }

  void add_texture(const Texture& texture) {
    const std::string bytes = png::encode(texture.rgba, texture.width, texture.height, 4, texture.name);
    const size_t index = document_["images"].is_array() ? document_["images"].size() : 0;
    document_["images"].push_back({{"name", texture.name},
                                   {"mimeType", "image/png"},
                                   {"bufferView", add_view(std::as_bytes(std::span(bytes)), 0)}});
    const int filter = texture.nearest ? kNearest : kLinear;
    document_["samplers"].push_back({{"wrapS", wrap_mode(texture.wrap_u)},
                                     {"wrapT", wrap_mode(texture.wrap_v)},
                                     {"magFilter", filter},
                                     {"minFilter", filter}});
    document_["textures"].push_back({{"name", texture.name}, {"source", index}, {"sampler", index}});
  }

  static Json material_json(const Material& material) {
    const glm::vec4& c = material.base_color;
    Json surface = {{"baseColorFactor", {c.r, c.g, c.b, c.a}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
    if (material.base_color_texture) surface["baseColorTexture"]["index"] = *material.base_color_texture;
    Json result = {{"name", material.name}, {"pbrMetallicRoughness", surface}};
    if (material.double_sided) result["doubleSided"] = true;
    if (!material.alpha_masked) return result;
    result["alphaMode"] = "MASK";
    result["alphaCutoff"] = material.alpha_cutoff;
    return result;
  }

  static Json camera_json(const Camera& camera) {
    if (camera.span) {  // its far plane is not optional
      constexpr double kFar = 1e9;
      const Json view = {{"xmag", camera.span->x},
                         {"ymag", camera.span->y},
                         {"znear", camera.near},
                         {"zfar", camera.far.value_or(camera.near + kFar)}};
      return {{"name", camera.name}, {"type", "orthographic"}, {"orthographic", view}};
    }
    Json view = {{"yfov", camera.fov_y}, {"znear", camera.near}};
    if (camera.far) view["zfar"] = *camera.far;
    if (camera.aspect) view["aspectRatio"] = *camera.aspect;
    return {{"name", camera.name}, {"type", "perspective"}, {"perspective", view}};
  }

  Json& add_node(const std::string& name, const glm::dmat4& world, Json node) {
    node["name"] = name;
    for (int i = 0; i < 16; ++i) node["matrix"].push_back(world[i / 4][i % 4]);
    document_["scenes"][0]["nodes"].push_back(document_["nodes"].size());
    document_["nodes"].push_back(std::move(node));
    return document_["nodes"].back();
  }

  void add_light(const Light& light, size_t index) {
    const char* types[] = {"spot", "point", "directional"};  // as LightType has them
    Json json = {{"name", light.name},
                 {"type", types[static_cast<size_t>(light.type)]},
                 {"color", {light.color.r, light.color.g, light.color.b}},
                 {"intensity", light.intensity}};
    if (light.range) json["range"] = *light.range;
    if (light.type == LightType::spot)
      json["spot"] = {{"innerConeAngle", light.inner_cone}, {"outerConeAngle", light.outer_cone}};
    document_["extensions"]["KHR_lights_punctual"]["lights"].push_back(json);
    Json node = {{"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}};
    if (light.type == LightType::spot)
      node["extras"]["light"]["fovy_deg"] = light.map_fov * 180 / std::numbers::pi;
    if (light.area) node["extras"]["area_light"] = area_json(*light.area);
    add_node(light.name, light.world_from_light, std::move(node));
    document_["extensionsUsed"] = {"KHR_lights_punctual"};
  }

  static Json area_json(const AreaLight& area) {
    const char* shapes[] = {"rectangle", "disc", "sphere", "polygon"};  // as AreaLight::Shape has them
    Json json = {{"shape", shapes[static_cast<size_t>(area.shape)]}};
    if (area.shape == AreaLight::Shape::polygon)
      for (const glm::dvec2& corner : area.outline) json["outline"].push_back({corner.x, corner.y});
    else
      json["width"] = area.width, json["height"] = area.height;
    if (area.emission) json["emission"] = *area.emission;
    return json;
  }

  std::string container() const {
    std::string text = document_.dump(-1, ' ', false, Json::error_handler_t::replace), binary = data_;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto word = [](size_t value) {
      std::string bytes;
      for (size_t i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
      return bytes;
    };
    return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
           word(binary.size()) + std::string("BIN\0", 4) + binary;
  }

  const Scene& scene_;
  std::string data_;
  Json document_ = {{"asset", {{"version", "2.0"}, {"generator", "gnomon"}}},
                    {"scene", 0},
                    {"scenes", {{{"nodes", Json::array()}}}},
                    {"nodes", Json::array()}};
};

}  // namespace

std::string to_glb(const Scene& scene) { return Writer(scene).write(); }

}  // namespace gnomon
