// What `gnomon scene info` prints.
#include "tools/scene_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "engine/scene/animation.h"
#include "engine/scene/area_light.h"

namespace gnomon {
namespace {

using Out = std::back_insert_iterator<std::string>;

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }
std::string text(const glm::dvec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }
glm::dvec3 position(const glm::dmat4& m) { return glm::dvec3(m[3]); }
glm::dvec3 forward(const glm::dmat4& m) { return -glm::dvec3(m[2]); }

void describe_meshes(const Scene& scene, Out out) {
  fmt::format_to(out, "meshes: {}\n", scene.meshes.size());
  for (const Mesh& mesh : scene.meshes)
    fmt::format_to(out, "  {}: {} triangles, {} vertices, material {}, {}{}\n", mesh.name, mesh.triangles(),
                   mesh.positions.size(), scene.materials[mesh.material].name,
                   mesh.watertight ? "watertight" : "open", mesh.colors.empty() ? "" : ", vertex colours");
}

void describe_materials(const Scene& scene, Out out) {
  fmt::format_to(out, "materials: {}\n", scene.materials.size());
  for (const Material& material : scene.materials) {
    const glm::vec4& c = material.base_color;
    fmt::format_to(
        out, "  {}: base colour ({:.3g}, {:.3g}, {:.3g}){}{}", material.name, c.x, c.y, c.z,
        material.double_sided ? ", double-sided" : "",
        material.alpha_masked ? fmt::format(", masked at alpha {:.3g}", material.alpha_cutoff) : "");
    if (material.base_color_texture) {
      const Texture& texture = scene.textures[*material.base_color_texture];
      fmt::format_to(out, ", texture {} {}x{}", texture.name, texture.width, texture.height);
    }
    fmt::format_to(out, "\n");
  }
}

const char* name_of(LightType type) {
  switch (type) {
    case LightType::spot:
      return "spot";
    case LightType::point:
      return "point";
    case LightType::directional:
      return "directional";
  }
  return "";
}

std::string text(const AreaLight& area, const Scene& scene) {
  switch (area.shape) {
    case AreaLight::Shape::rectangle:
      break;
    case AreaLight::Shape::disc:
      return fmt::format("disc of radius {:.6g}", 0.5 * area.width);
    case AreaLight::Shape::sphere:
      return fmt::format("sphere of radius {:.6g}", 0.5 * area.width);
    case AreaLight::Shape::polygon:
      return fmt::format("polygon of {} corners in {:.6g} x {:.6g}", area.outline.size(), area.width,
                         area.height);
  }
  std::string result = fmt::format("rectangle {:.6g} x {:.6g}", area.width, area.height);
  if (!area.emission) return result;
  const Texture& texture = scene.textures[*area.emission];
  return result + fmt::format(" with emission texture {} {}x{}", texture.name, texture.width, texture.height);
}

void describe_lights(const Scene& scene, Out out) {
  fmt::format_to(out, "lights: {}\n", scene.lights.size());
  for (const Light& light : scene.lights) {
    fmt::format_to(out, "  {}: {}, intensity {:.6g} {}", light.name, name_of(light.type), light.intensity,
                   light.type == LightType::directional ? "lx" : "cd");
    if (light.type != LightType::directional)
      fmt::format_to(out, ", at {}", text(position(light.world_from_light)));
    if (light.type != LightType::point)
      fmt::format_to(out, ", towards {}", text(forward(light.world_from_light)));
    if (light.type == LightType::spot)
      fmt::format_to(out, ", cone {:.4g} to {:.4g} degrees, map {:.4g} degrees", degrees(light.inner_cone),
                     degrees(light.outer_cone), degrees(light.map_fov));
    if (has_size(light)) {
      const std::string size =
          light.type == LightType::directional
              ? fmt::format("angular diameter {:.6g} degrees", degrees(angular_diameter(*light.area)))
              : "area: " + text(*light.area, scene);
      fmt::format_to(out, ", {}", size);
    }
    fmt::format_to(out, "\n");
  }
}

void describe_cameras(const Scene& scene, Out out) {
  fmt::format_to(out, "cameras: {}\n", scene.cameras.size());
  for (const Camera& camera : scene.cameras) {
    const std::string view =
        camera.span ? fmt::format("orthographic, {:.4g} x {:.4g}", 2 * camera.span->x, 2 * camera.span->y)
                    : fmt::format("{:.4g} degrees", degrees(camera.fov_y));
    fmt::format_to(out, "  {}: at {}, towards {}, {}, near {:.4g}", camera.name,
                   text(position(camera.world_from_camera)), text(forward(camera.world_from_camera)), view,
                   camera.near);
    if (camera.far) fmt::format_to(out, ", far {:.3g}", *camera.far);
    if (camera.aspect) fmt::format_to(out, ", aspect {:.4g}", *camera.aspect);
    fmt::format_to(out, "\n");
  }
}

void describe_animation(const Scene& scene, Out out) {
  if (!scene.animation) return;
  const Animation& moving = *scene.animation;
  fmt::format_to(out, "animation: {:.4g} s, moves {} instances, {} cameras, {} lights", duration(moving),
                 moving.instances.size(), moving.cameras.size(), moving.lights.size());
  if (const size_t count = moving.deformations.size()) fmt::format_to(out, "; the shape of {} meshes", count);
  if (const size_t count = moving.changing_lights.size())
    fmt::format_to(out, "; the intensity of {} lights", count);
  if (const size_t count = moving.changing_materials.size()) fmt::format_to(out, "; {} materials", count);
  fmt::format_to(out, "\n");
}

void describe_warnings(const SceneWarnings& warnings, Out out) {
  fmt::format_to(out, "dropped: {} triangles without area, {} not finite; {} duplicated vertices\n",
                 warnings.degenerate_triangles, warnings.nonfinite_triangles, warnings.duplicate_vertices);
  fmt::format_to(out, "warnings: {}\n", warnings.messages.size());
  for (const std::string& message : warnings.messages) fmt::format_to(out, "  {}\n", message);
}

}  // namespace

std::string describe_scene(const Scene& scene) {
  std::string result;
  const Out out(result);
  const auto open =
      std::count_if(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return !m.watertight; });
  fmt::format_to(out, "{}: {}\n", scene.name, scene.file.string());
  fmt::format_to(out, "triangles: {} in {} instances; {} of {} meshes open\n", scene.triangles(),
                 scene.instances.size(), open, scene.meshes.size());
  fmt::format_to(out, "bounds: {} to {}\n", text(scene.bounds.min), text(scene.bounds.max));
  describe_meshes(scene, out);
  describe_materials(scene, out);
  describe_lights(scene, out);
  describe_cameras(scene, out);
  describe_animation(scene, out);
  describe_warnings(scene.warnings, out);
  return result;
}

}  // namespace gnomon
