// Builds the scene that the stability walk bends, axis by axis.
#include "bench/stability/stability_scenes.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

constexpr float kFloorHalf = 6, kBlockerHalf = 1, kBlockerHeight = 2;  // scene units
constexpr double kLightDistance = 7;                                   // scene units, from the origin
constexpr double kFarDepth = 12;  // scene units: about the light's farthest receiver
constexpr glm::dvec3 kOffsetDirection(1.0, 0.5, -0.75);
constexpr glm::dvec3 kSphereCentre(-0.9, 0.5, 0.7);
constexpr float kSphereRadius = 0.5f;

glm::dmat4 frame(const glm::dvec3& eye, const glm::dvec3& target) {
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 up = std::abs(forward.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  return glm::inverse(glm::lookAt(eye, target, up));
}

// A quadrilateral [x0, x1] x [z0, z1] at height y, front side up.
void add_quad(Mesh& mesh, float x0, float x1, float z0, float z1, float y) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{x0, y, z0}, {x0, y, z1}, {x1, y, z1}, {x1, y, z0}});
  mesh.normals.insert(mesh.normals.end(), 4, {0, 1, 0});
  mesh.uvs.insert(mesh.uvs.end(), 4, {0, 0});
  for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + corner);
}

Mesh square(float half, float y, uint32_t times = 1) {
  Mesh mesh;
  for (uint32_t i = 0; i < times; ++i) add_quad(mesh, -half, half, -half, half, y);
  return mesh;
}

// About `triangles` of them, in equal squares.
Mesh grid(float half, uint64_t triangles) {
  const auto side = static_cast<uint32_t>(std::max(1.0, std::sqrt(double(triangles) / 2)));
  Mesh mesh;
  mesh.positions.reserve(size_t(side + 1) * (side + 1));
  mesh.indices.reserve(size_t(side) * side * 6);
  const auto place = [&](uint32_t i) {
    return half * (2 * static_cast<float>(i) / static_cast<float>(side) - 1);
  };
  for (uint32_t i = 0; i <= side; ++i)
    for (uint32_t k = 0; k <= side; ++k) mesh.positions.emplace_back(place(i), 0.0f, place(k));
  mesh.normals.assign(mesh.positions.size(), {0, 1, 0});
  mesh.uvs.assign(mesh.positions.size(), {0, 0});
  for (uint32_t i = 0; i < side; ++i)
    for (uint32_t k = 0; k < side; ++k) {
      const uint32_t a = i * (side + 1) + k, b = a + 1, c = a + side + 2, d = a + side + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  return mesh;
}

Mesh sphere(float radius, int rings, int segments) {
  Mesh mesh;
  for (int i = 0; i <= rings; ++i)
    for (int k = 0; k < segments; ++k) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * k / segments;
      const glm::vec3 n(std::sin(a) * std::cos(b), std::cos(a), -std::sin(a) * std::sin(b));
      mesh.normals.push_back(n);
      mesh.positions.push_back(radius * n);
    }
  mesh.uvs.assign(mesh.positions.size(), {0, 0});
  const auto vertex = [&](int i, int k) { return static_cast<uint32_t>(i * segments + k % segments); };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < segments; ++k) {
      const uint32_t a = vertex(i, k), b = vertex(i + 1, k), c = vertex(i + 1, k + 1), d = vertex(i, k + 1);
      if (i < rings - 1) mesh.indices.insert(mesh.indices.end(), {a, b, c});
      if (i > 0) mesh.indices.insert(mesh.indices.end(), {a, c, d});
    }
  mesh.watertight = true;
  return mesh;
}

// The blocker in strips, thin ones between wide ones.
Mesh slivers(double aspect) {
  constexpr int pieces = 8;
  const auto width = static_cast<float>(2 * kBlockerHalf / aspect);
  Mesh mesh;
  for (int i = 0; i < pieces; ++i) {
    const float from = kBlockerHalf * (2.0f * static_cast<float>(i) / pieces - 1);
    const float to = kBlockerHalf * (2.0f * static_cast<float>(i + 1) / pieces - 1);
    const float thin = std::min(from + width, to);
    add_quad(mesh, from, thin, -kBlockerHalf, kBlockerHalf, kBlockerHeight);
    if (thin < to) add_quad(mesh, thin, to, -kBlockerHalf, kBlockerHalf, kBlockerHeight);
  }
  return mesh;
}

// Squares over one another, all within a unit of height.
Mesh stack(uint32_t count) {
  Mesh mesh;
  for (uint32_t i = 0; i < count; ++i)
    add_quad(mesh, -kBlockerHalf, kBlockerHalf, -kBlockerHalf, kBlockerHalf,
             kBlockerHeight + static_cast<float>(i) / static_cast<float>(count));
  return mesh;
}

Instance& add(Scene& scene, Mesh mesh, const glm::dmat4& world_from_object = glm::dmat4(1.0),
              bool double_sided = false) {
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
  Material material;
  material.double_sided = double_sided;
  mesh.material = static_cast<uint32_t>(scene.materials.size());
  scene.materials.push_back(material);
  Instance instance;
  instance.mesh = static_cast<uint32_t>(scene.meshes.size());
  instance.name = "part " + std::to_string(instance.mesh);
  instance.world_from_object = world_from_object;
  mesh.name = instance.name;
  scene.meshes.push_back(std::move(mesh));
  return scene.instances.emplace_back(instance);
}

Mesh floor_of(const StabilitySetup& s) {
  if (s.triangles > 4) return grid(kFloorHalf, s.triangles);
  if (s.triangles != 1) return square(kFloorHalf, 0, std::max(1u, s.layers));
  Mesh mesh = square(kFloorHalf, 0);
  mesh.indices.resize(3);
  return mesh;
}

void add_meshes(Scene& scene, const StabilitySetup& s) {
  add(scene, floor_of(s));
  if (s.flat || s.triangles == 1) return;
  if (s.depth_complexity > 1)
    add(scene, stack(s.depth_complexity));
  else if (s.sliver_aspect > 1)
    add(scene, slivers(s.sliver_aspect));
  else
    add(scene, square(kBlockerHalf, kBlockerHeight));
  add(scene, sphere(kSphereRadius, 12, 24), glm::translate(glm::dmat4(1.0), kSphereCentre));
}

glm::dmat4 light_place(const StabilitySetup& s) {
  if (s.flat) return frame({0, kLightDistance, 0}, {0, 0, 0});
  if (s.light_inside) return frame(kSphereCentre, {0, 0, 0});
  if (s.light_height >= 0) return frame({2, s.light_height, 1}, {0, s.light_height, 0.2});
  const double angle = s.incidence * std::numbers::pi / 180;
  const glm::dvec3 to_light(0.8 * std::sin(angle), std::cos(angle), 0.6 * std::sin(angle));
  return frame(kLightDistance * to_light, {0, 0, 0});
}

void add_lights(Scene& scene, const StabilitySetup& s) {
  constexpr LightType types[] = {LightType::spot, LightType::directional, LightType::point};
  const uint32_t count = std::max(1u, s.lights);
  for (uint32_t i = 0; i < count; ++i) {
    Light light;
    light.name = "light " + std::to_string(i);
    light.type = s.flat ? LightType::directional : types[i % 3];
    const glm::dmat4 turn =
        glm::rotate(glm::dmat4(1.0), 2 * std::numbers::pi * i / count, glm::dvec3(0, 1, 0));
    light.world_from_light = turn * light_place(s);
    light.outer_cone = 1.5;  // radians: outside the square frustum of 90 degrees
    light.intensity =
        light.type == LightType::directional ? 1 : kLightDistance * kLightDistance * s.scale * s.scale;
    if (s.light_size > 0) {
      light.area.emplace();
      light.area->width = light.area->height = s.light_size * s.scale;
    }
    scene.lights.push_back(light);
  }
}

// Something very near the light, in a corner of its frustum that lights nothing the camera sees.
void add_near_caster(Scene& scene, double depth) {
  const glm::dmat4 local = glm::translate(glm::dmat4(1.0), glm::dvec3(0.9, 0.9, -1.0) * depth) *
                           glm::rotate(glm::dmat4(1.0), 0.5 * std::numbers::pi, glm::dvec3(1, 0, 0)) *
                           glm::scale(glm::dmat4(1.0), glm::dvec3(0.02 * depth));
  add(scene, square(1, 0), scene.lights.front().world_from_light * local, true);
}

void add_camera(Scene& scene, const StabilitySetup& s) {
  Camera camera;
  camera.world_from_camera =
      s.triangles == 0 ? frame({3.2, 4.4, 4.0}, {6.4, 9.0, 8.0}) : frame({3.2, 4.4, 4.0}, {-0.2, 0.3, 0.1});
  camera.fov_y = s.fov * std::numbers::pi / 180;
  camera.near = s.scale * (s.depth_range > 0 ? kFarDepth / s.depth_range : 0.1);
  scene.cameras.push_back(camera);
}

// Rigid frames keep their axes; their places scale.
void place(glm::dmat4& frame, double scale, const glm::dvec3& shift) {
  frame[3] = glm::dvec4(scale * glm::dvec3(frame[3]) + shift, 1.0);
}

void transform(Scene& scene, double scale, const glm::dvec3& shift) {
  const glm::dmat4 world = glm::scale(glm::translate(glm::dmat4(1.0), shift), glm::dvec3(scale));
  for (Instance& instance : scene.instances) {
    instance.world_from_object = world * instance.world_from_object;
    for (const glm::vec3& p : scene.meshes[instance.mesh].positions)
      scene.bounds.add(glm::dvec3(instance.world_from_object * glm::dvec4(glm::dvec3(p), 1.0)));
  }
  for (Camera& camera : scene.cameras) place(camera.world_from_camera, scale, shift);
  for (Light& light : scene.lights) place(light.world_from_light, scale, shift);
}

// ------------------------------------------------------------------------------ a file without lights

class TemporaryFolder {
 public:
  TemporaryFolder() : path_((fs::temp_directory_path() / "gnomon-stability-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) fail("cannot make a temporary folder", path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  fs::path file(const std::string& name) const { return fs::path(path_) / name; }

 private:
  std::string path_;
};

// All of the scene's instances as one mesh; no lights.
void write_gltf(const Scene& scene, const TemporaryFolder& folder) {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto first = static_cast<uint32_t>(positions.size() / 3);
    for (const glm::vec3& p : mesh.positions) {
      const glm::vec3 world(instance.world_from_object * glm::dvec4(glm::dvec3(p), 1.0));
      positions.insert(positions.end(), {world.x, world.y, world.z});
    }
    for (const uint32_t i : mesh.indices) indices.push_back(first + i);
  }
  const size_t position_bytes = positions.size() * sizeof(float),
               index_bytes = indices.size() * sizeof(uint32_t);
  std::ofstream bin(folder.file("scene.bin"), std::ios::binary);
  bin.write(reinterpret_cast<const char*>(positions.data()), std::streamsize(position_bytes));
  bin.write(reinterpret_cast<const char*>(indices.data()), std::streamsize(index_bytes));
  constexpr int float_type = 5126, uint_type = 5125;  // glTF component types
  using nlohmann::json;
  const auto one = [](json element) { return json::array({std::move(element)}); };
  json gltf;
  gltf["asset"]["version"] = "2.0";
  gltf["buffers"] = one({{"uri", "scene.bin"}, {"byteLength", position_bytes + index_bytes}});
  gltf["bufferViews"].push_back({{"buffer", 0}, {"byteLength", position_bytes}});
  gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", position_bytes}, {"byteLength", index_bytes}});
  gltf["accessors"].push_back(
      {{"bufferView", 0}, {"componentType", float_type}, {"count", positions.size() / 3}, {"type", "VEC3"}});
  gltf["accessors"].push_back(
      {{"bufferView", 1}, {"componentType", uint_type}, {"count", indices.size()}, {"type", "SCALAR"}});
  json primitive = {{"indices", 1}};
  primitive["attributes"]["POSITION"] = 0;
  gltf["meshes"] = one({{"primitives", one(primitive)}});
  gltf["nodes"] = one({{"mesh", 0}});
  gltf["scenes"] = one({{"nodes", one(0)}});
  gltf["scene"] = 0;
  std::ofstream text(folder.file("scene.gltf"));
  text << gltf.dump();
  if (!bin.flush() || !text.flush())
    fail("cannot write a scene without lights", folder.file("scene.gltf").string());
}

Scene loaded_without_lights(const Scene& scene) {
  const TemporaryFolder folder;
  write_gltf(scene, folder);
  Scene loaded = load_scene(folder.file("scene.gltf"));
  loaded.cameras = scene.cameras;
  loaded.name = scene.name;
  return loaded;
}

}  // namespace

Scene stability_scene(const StabilitySetup& s) {
  Scene scene;
  scene.name = "stability";
  scene.file = "stability";
  add_meshes(scene, s);
  add_lights(scene, s);
  add_camera(scene, s);
  if (s.depth_range > 0) add_near_caster(scene, kFarDepth / s.depth_range);
  transform(scene, s.scale, s.offset * kOffsetDirection);
  return s.lights == 0 ? loaded_without_lights(scene) : scene;
}

}  // namespace gnomon
