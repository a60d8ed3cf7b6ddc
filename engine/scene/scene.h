// A scene as the CPU knows it: meshes, materials, instances, cameras and lights of a glTF file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct Bounds {  // axis-aligned, world units; empty when min > max
  glm::dvec3 min{1e300}, max{-1e300};
  bool empty() const { return min.x > max.x; }
  void add(const glm::dvec3& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  glm::dvec3 centre() const { return 0.5 * (min + max); }
  double radius() const { return empty() ? 0.0 : 0.5 * glm::length(max - min); }
};

// One glTF primitive. Object space; triangles only; indices are valid, no triangle is degenerate or
// non-finite (such ones are dropped at load and counted).
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3>
      normals;  // as many as positions, unit length (made from the faces when the file has none)
  std::vector<glm::vec2> uvs;     // of the material's texture, transformed as it says; as many as positions
                                  // (zero when the file has none)
  std::vector<glm::vec4> colors;  // COLOR_0, linear; as many as positions, or empty
  std::vector<uint32_t> indices;  // 3 per triangle, counter-clockwise is front
  uint32_t material = 0;
  bool watertight = false;  // every edge of the welded mesh has exactly two opposite triangles
  Bounds bounds;            // object space
  size_t triangles() const { return indices.size() / 3; }
};

enum class Wrap { clamp, repeat, mirror };  // beyond the edges of a texture

struct Texture {  // 8-bit sRGB RGBA, row 0 at the top (glTF's v = 0)
  std::string name;
  uint32_t width = 1, height = 1;
  std::vector<uint8_t> rgba;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;
};

struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};  // linear
  std::optional<uint32_t> base_color_texture;
  bool double_sided = false;
  bool alpha_masked = false;  // coverage: base colour alpha >= alpha_cutoff
  float alpha_cutoff = 0.5f;
};

struct Instance {
  std::string name;
  uint32_t mesh = 0;
  glm::dmat4 world_from_object{1.0};
  bool moving = false;  // some animation moves it, or changes its mesh or its visibility
  bool visible = true;  // hidden ones neither show nor cast shadows
};

struct Camera {  // right-handed, looks along -z
  std::string name;
  glm::dmat4 world_from_camera{1.0};  // rigid
  double fov_y = 0.7853981633974483;  // radians
  double near = 0.1;                  // world units
  std::optional<double> far;          // world units; absent: no limit
  std::optional<double> aspect;       // width / height; absent: the viewport's
  std::optional<glm::dvec2> span;     // orthographic: half width and height, world units
  bool moving = false;                // some animation moves it
};

// Half width and height of what an image of that aspect (width / height) shows of a camera: tangents, or
// world units of an orthographic one. A camera of another aspect is wholly in the image, its shapes
// unchanged.
glm::dvec2 half_extent(const Camera& camera, double image_aspect);

enum class LightType { spot, point, directional };

// Of a spot light a shape in its local x-y plane that emits along -z (a sphere: the disc that faces -z), of a
// point light a sphere, of a directional light the disc that it is seen as, on the plane at distance 1.
struct AreaLight {
  enum class Shape { rectangle, disc, sphere, polygon } shape = Shape::rectangle;
  double width = 0, height = 0;      // world units, of the bounding rectangle
  std::vector<glm::dvec2> outline;   // of a polygon: simple, either orientation; local x, y in world units
  std::optional<uint32_t> emission;  // index into Scene::textures: colour of a rectangle's parts, row 0 at +y
  bool operator==(const AreaLight&) const = default;
};

struct Light {  // shines along its local -z (spot, directional)
  std::string name;
  LightType type = LightType::spot;
  glm::dmat4 world_from_light{1.0};                        // rigid
  glm::dvec3 color{1.0};                                   // linear
  double intensity = 1;                                    // candela (spot, point) or lux (directional)
  double inner_cone = 0, outer_cone = 0.7853981633974483;  // radians, half angles (spot)
  double map_fov = 1.5707963267948966;  // radians, full angle of a spot's square shadow-map frustum
  std::optional<double> range;          // world units; absent: no limit
  std::optional<AreaLight> area;        // from extras.area_light of the light's node, or of the scene
  bool moving = false;                  // some animation moves it
};

struct SceneWarnings {  // counted, so that a usable scene with flaws is used and its flaws are reported
  uint64_t degenerate_triangles = 0, nonfinite_triangles = 0, duplicate_vertices = 0;
  std::vector<std::string> messages;  // one sentence each, file and place included
};

struct Animation;  // engine/scene/animation.h

struct Scene {
  std::filesystem::path file;
  std::string name;  // file name without folder and extension
  std::vector<Mesh> meshes;
  std::vector<Texture> textures;
  std::vector<Material> materials;  // never empty
  std::vector<Instance> instances;
  std::vector<Camera> cameras;                 // never empty: a default one frames the scene
  std::vector<Light> lights;                   // never empty: a default one shines on the scene
  Bounds bounds;                               // world, over all instances' vertices, at time 0
  std::shared_ptr<const Animation> animation;  // null: nothing moves
  SceneWarnings warnings;
  uint64_t triangles() const;  // over all instances
};

// Reads .glb or .gltf. Throws Error (file, place) for what cannot be used; warns in Scene::warnings for the
// rest.
Scene load_scene(const std::filesystem::path& file);

}  // namespace gnomon
