// A scene as the CPU knows it: meshes, materials, instances, cameras and lights of a glTF file, and facts
// about it.
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
  std::vector<glm::vec2> uvs;     // as many as positions (zero when the file has none)
  std::vector<glm::vec4> colors;  // COLOR_0, linear; as many as positions, or empty
  std::vector<uint32_t> indices;  // 3 per triangle, counter-clockwise is front
  uint32_t material = 0;
  bool watertight = false;  // every edge of the welded mesh has exactly two opposite triangles
  Bounds bounds;            // object space
  size_t triangles() const { return indices.size() / 3; }
};

struct Texture {  // 8-bit sRGB RGBA, row 0 at the top (glTF's v = 0)
  std::string name;
  uint32_t width = 1, height = 1;
  std::vector<uint8_t> rgba;
  bool repeat_u = true, repeat_v = true, nearest = false;
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
  bool moving = false;  // some animation moves it
};

struct Camera {  // right-handed, looks along -z; always projected with an infinite far plane
  std::string name;
  glm::dmat4 world_from_camera{1.0};  // rigid
  double fov_y = 0.7853981633974483;  // radians
  double near = 0.1;                  // world units
  std::optional<double> aspect;       // width / height; absent: the viewport's
  bool moving = false;                // some animation moves it
};

enum class LightType { spot, point, directional };

// A planar shape in the light's local x-y plane, centred on the light, that emits along its local -z. A
// sphere is the disc that faces -z.
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

struct SceneWarnings {  // counted, so that a usable scene with flaws is used and its flaws are told
  uint64_t degenerate_triangles = 0, nonfinite_triangles = 0, duplicate_vertices = 0;
  std::vector<std::string> messages;  // one sentence each, file and place included
};

struct Animation;  // engine/animation.h

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

// What passes ask about in need(). World units, double precision.
struct SceneFacts {
  uint64_t triangles = 0;
  uint32_t lights = 0;
  bool has_alpha_mask = false;
  bool has_double_sided = false;
  bool has_open_meshes = false;
  bool animated = false;
  bool casters_move = false;
  double nearest_depth = 0;   // no visible surface is nearer to the camera along its axis
  double middle_depth = 1;    // the camera's distance to the scene's middle
  double smallest_pixel = 0;  // no pixel shows less of a visible surface than this, world units
  // per light:
  std::vector<std::string> shadowless;  // why the camera sees none of its shadows; empty: it may see some
  std::vector<bool> light_moves;
  std::vector<double> light_size;  // largest side of the area light; 0 for a point
  std::vector<double> penumbra;    // no penumbra that the camera sees is wider, pixels

  // Does its area make no difference to any pixel?
  bool shines_as_point(uint32_t light) const { return penumbra[light] < negligible_penumbra; }
  // Pixels. Of the silhouette's pixels no more than this part have their centre in the penumbra.
  static constexpr double negligible_penumbra = 1.0 / 64;
  // Why the camera sees no shadow of any light; empty: it may see some.
  std::string no_shadow() const;
  static constexpr const char* no_caster = "no caster reaches what the camera sees";  // of shadowless
};
// Tests on bounds that find something to do when in doubt. `aspect`: width / height of the view. `height`: of
// the view in pixels; 0: unknown, and nothing is small compared with a pixel.
SceneFacts scene_facts(const Scene& scene, const Camera& camera, double aspect, uint32_t height = 0);
// The same without anything that allows to leave something out.
SceneFacts promising_nothing(SceneFacts facts);

// A shadow-map face: one layer of the map. All matrices in double; subtract an origin before going to float.
// Clip space is Vulkan's: y down, z in [0,1]; depth grows with distance from the light in both encodings.
struct LightFace {
  uint32_t light = 0;
  bool orthographic = false;
  glm::dmat4 light_from_world{1.0};  // rigid; looks along -z
  double half_width = 1,
         half_height = 1;    // tangent of the half angle (perspective) or world units (orthographic)
  double near = 1, far = 2;  // distance along the view axis, world units; fitted to the scene
  glm::dmat4 clip_from_light() const;  // perspective or orthographic projection
};
// Faces in layer order: 1 for spot and directional, 6 for point (+x -x +y -y +z -z of the light's own frame).
// `border`: texels kept outside each point-light face's 90 degrees, of `map_size`, so that walks and filters
// near an edge stay in the face. `map_size` in texels.
std::vector<LightFace> light_faces(const Scene& scene, uint32_t map_size, uint32_t border);

}  // namespace gnomon
