// Fills the data that every shader sees: camera, lights and views.
#include "engine/render/frame_data.h"
#include "engine/light/light_view.h"
#include "engine/scene/camera.h"
#include "engine/scene/wide_spot.h"

#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/area_light.h"

namespace gnomon {
namespace {

// Depth from `near` to `end`, linear; what lies beyond either is not in the image.
glm::dmat4 orthographic_projection(const glm::dvec2& half, double near, double end, bool reversed_z) {
  glm::dmat4 p(1.0);
  p[0][0] = 1.0 / half.x;
  p[1][1] = -1.0 / half.y;
  p[2][2] = (reversed_z ? 1.0 : -1.0) / (end - near);
  p[3][2] = (reversed_z ? end : -near) / (end - near);
  return p;
}

// Vulkan clip space (y down). Perspective: infinite far plane; reversed: depth = near / z; standard: 1 - near
// / z. `near`, `end`: of the image's camera, so that another one's depths compare with it.
glm::dmat4 camera_projection(const Camera& camera, double aspect, bool reversed_z, double near, double end) {
  if (camera.span) return orthographic_projection(half_extent(camera, aspect), near, end, reversed_z);
  const double focal = 1.0 / half_extent(camera, aspect).y;
  glm::dmat4 p(0.0);
  p[0][0] = focal / aspect;
  p[1][1] = -focal;
  p[2][3] = -1.0;
  p[2][2] = reversed_z ? 0.0 : -1.0;
  p[3][2] = reversed_z ? camera.near : -camera.near;
  return p;
}

glm::dmat4 view_rotation(const Camera& camera) {
  return glm::dmat4(glm::transpose(glm::dmat3(camera.world_from_camera)));
}

glm::vec4 light_size(const Light& light) {
  if (!has_size(light)) return glm::vec4(0.0f);
  const AreaLight& area = *light.area;
  const auto shape = double(area.shape);
  if (light.type == LightType::directional) return {0.0, 0.0, shape, 0.5 * area.width};
  return {0.5 * area.width, 0.5 * area.height, shape, 0.0};
}

// Rows of a rigid light_from_world, for positions relative to `eye`. Subtracted in double: exact at far
// origins.
void relative_rows(const glm::dmat4& light_from_world, const glm::dvec3& eye, glm::vec4 (&rows)[3]) {
  const glm::dmat4 m = light_from_world * glm::translate(glm::dmat4(1.0), eye);
  for (int r = 0; r < 3; ++r) rows[r] = glm::vec4(m[0][r], m[1][r], m[2][r], m[3][r]);
}

}  // namespace

FrameData frame_data(const Camera& camera, const Camera& previous, uint32_t width, uint32_t height,
                     bool reversed_z, uint32_t lights, uint32_t frame, double depth_end) {
  const double aspect = double(width) / height;
  const glm::dmat3 world_from_camera(camera.world_from_camera);
  const glm::dmat4 view = view_rotation(camera);
  const double scale = image_scale(camera, aspect);
  const double half = half_extent(camera, aspect).y / scale, half_width = half * aspect;
  FrameData data{};
  data.clip_from_relative =
      glm::mat4(camera_projection(camera, aspect, reversed_z, camera.near, depth_end) * view);
  data.view_from_relative = glm::mat4(view);
  const double ahead = camera.span ? 0.0 : -1.0;
  data.ray_corner =
      glm::vec4(world_from_camera * glm::dvec3(-half_width, half, ahead), camera.span ? scale : 0.0);
  data.ray_dx = glm::vec4(world_from_camera[0] * (2.0 * half_width / width), 0.0);
  data.ray_dy = glm::vec4(world_from_camera[1] * (-2.0 * half / height), 0.0);
  data.viewport = {float(width), float(height), 1.0f / float(width), 1.0f / float(height)};
  data.depth = {float(camera.near), reversed_z ? 1.0f : 0.0f, float(camera.far.value_or(0.0)),
                float(depth_end)};
  data.counts = {lights, 0, frame, 0};
  const glm::dvec3 step(camera.world_from_camera[3] - previous.world_from_camera[3]);
  data.previous_clip_from_relative =
      glm::mat4(camera_projection(previous, aspect, reversed_z, camera.near, depth_end) *
                view_rotation(previous) * glm::translate(glm::dmat4(1.0), step));
  return data;
}

std::vector<LightData> light_data(const Scene& scene, const glm::dvec3& eye) {
  std::vector<LightData> result;
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    LightData data{};
    relative_rows(glm::inverse(light.world_from_light), eye, data.rows);
    const bool wide = light.type == LightType::spot && view_type(light) == LightType::point;
    const double type = wide ? 3 : light.type == LightType::spot ? 0 : light.type == LightType::point ? 1 : 2;
    data.position = glm::vec4(glm::dvec3(light.world_from_light[3]) - eye, type);
    data.direction =
        glm::vec4(-glm::normalize(glm::dvec3(light.world_from_light[2])), light.range.value_or(0.0));
    data.intensity = glm::vec4(light.color * light.intensity, 0.0);
    data.cone = glm::vec4(std::cos(light.inner_cone), std::cos(light.outer_cone), 0.0, 0.0);
    data.size = light_size(light);
    result.push_back(data);
  }
  return result;
}

std::vector<LightViewData> light_view_data(const std::vector<LightView>& views, const glm::dvec3& eye) {
  std::vector<LightViewData> result;
  for (const LightView& view : views) {
    LightViewData data{};
    data.clip_from_relative =
        glm::mat4(view.clip_from_light() * view.light_from_world * glm::translate(glm::dmat4(1.0), eye));
    relative_rows(view.light_from_world, eye, data.rows);
    data.range = glm::vec4(view.near, view.far, view.half_width, view.half_height);
    data.info = {view.light, view.orthographic ? 1u : 0u, 0u, 0u};
    result.push_back(data);
  }
  for (uint32_t i = 0; i < views.size(); ++i) {
    glm::uvec4& of_light = result[views[i].light].info;
    if (of_light.w++ == 0) of_light.z = i;
  }
  return result;
}

std::vector<InstanceData> instance_data(const Scene& scene, const std::vector<uint32_t>& first_triangle,
                                        const glm::dvec3& eye) {
  std::vector<InstanceData> result;
  for (const Instance& instance : scene.instances) {
    InstanceData data{};
    data.relative_from_object = glm::mat4(glm::translate(glm::dmat4(1.0), -eye) * instance.world_from_object);
    // Hidden: all vertices in one point, so that no pass draws anything of it.
    if (!instance.visible) data.relative_from_object = glm::mat4(0.0f), data.relative_from_object[3].w = 1.0f;
    const glm::dmat3 linear(instance.world_from_object);
    // The cofactor matrix turns normals rightly for every scale, and its sign follows a mirrored instance's
    // winding.
    const glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                              glm::cross(linear[0], linear[1]));
    for (int c = 0; c < 3; ++c) data.normal_columns[c] = glm::vec4(cofactor[c], 0.0);
    data.info = {first_triangle[instance.mesh], scene.meshes[instance.mesh].material,
                 glm::determinant(linear) < 0 ? 1u : 0u, instance.moving ? 1u : 0u};
    result.push_back(data);
  }
  return result;
}

std::vector<MaterialData> material_data(const Scene& scene) {
  std::vector<MaterialData> result;
  for (const Material& m : scene.materials)
    result.push_back(
        {m.base_color, {m.alpha_masked ? m.alpha_cutoff : 0.0f, m.double_sided ? 1.0f : 0.0f, 0, 0}});
  return result;
}

}  // namespace gnomon
