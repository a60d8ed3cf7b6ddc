// The CPU's side of shaders/glsl/frame/frame.glsl: what every shader sees in set 0. std140/std430 layouts.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/light/light_view.h"
#include "engine/scene/scene.h"

namespace gnomon {

struct FrameData {
  glm::mat4 clip_from_relative;  // camera projection; positions are relative to the camera's eye
  glm::mat4 view_from_relative;  // rotation
  // Relative position at view depth 1 of the image's top left corner; of an orthographic camera at the eye's
  // depth, in parts of w, its image_scale().
  glm::vec4 ray_corner;
  glm::vec4 ray_dx, ray_dy;  // step of it per pixel
  glm::vec4 viewport;        // width, height, 1/width, 1/height
  glm::vec4 depth;           // near plane (world units), 1 when reversed z, far plane or 0, `depth_end`
  glm::uvec4 counts;         // lights, unused, frame index, unused
  glm::mat4 previous_clip_from_relative;  // the previous frame's camera; relative to this frame's eye
};

struct LightData {
  glm::vec4 rows[3];    // light_from_relative, rigid
  glm::vec4 position;   // relative; w: 0 spot, 1 point, 2 directional
  glm::vec4 direction;  // unit, the way it shines; w: range in world units, 0 = unlimited
  glm::vec4 intensity;  // linear RGB, candela or lux
  glm::vec4 cone;       // cosines of the inner and outer half angle
  // Half width and half height of its area, world units; its AreaLight::Shape; of a directional light the
  // tangent of half its angular diameter. All 0 without a size.
  glm::vec4 size;
};

struct LightViewData {
  glm::mat4 clip_from_relative;
  glm::vec4 rows[3];  // light_from_relative, rigid, looks along -z
  glm::vec4 range;    // near, far, half width, half height (tangents, or world units)
  // light, 1 when orthographic; of the i-th of all views, first and number of those of light i
  glm::uvec4 info;
};

struct InstanceData {
  glm::mat4 relative_from_object;
  glm::vec4 normal_columns[3];  // relative_from_object's cofactor: for normals, any scale
  glm::uvec4 info;              // first triangle, material, 1 when mirrored, 1 when some animation moves it
};

struct MaterialData {
  glm::vec4 base_color;
  glm::vec4 alpha;  // cutoff (0: opaque), 1 when double-sided
};

// `previous`: the camera of the frame before; of the first frame, its own. `depth_end`: of an orthographic
// camera, the view depth that device depths reach to; see depth_end().
FrameData frame_data(const Camera& camera, const Camera& previous, uint32_t width, uint32_t height,
                     bool reversed_z, uint32_t lights, uint32_t frame, double depth_end = 0);
std::vector<LightData> light_data(const Scene& scene, const glm::dvec3& eye);
// `views`: light by light, some of each.
std::vector<LightViewData> light_view_data(const std::vector<LightView>& views, const glm::dvec3& eye);
std::vector<InstanceData> instance_data(const Scene& scene, const std::vector<uint32_t>& first_triangle,
                                        const glm::dvec3& eye);
std::vector<MaterialData> material_data(const Scene& scene);

}  // namespace gnomon
