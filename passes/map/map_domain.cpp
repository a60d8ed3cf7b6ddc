// Warns of what of a scene lies outside of what shadow maps can resolve.
#include "passes/map/map_domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/light/light_view.h"
#include "engine/light/view_set.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/render_settings.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"
#include "passes/map/map_traits.h"

namespace gnomon {
namespace {

constexpr double kMostGrazed = 0.5;        // share of the lit surface beyond which a light is warned of
constexpr double kMostOfMap = 0.1;         // share of the map's side that a filter may be wide
constexpr uint32_t kLeastUsefulSide = 16;  // texels: below, shadows of the ordinary stability scene are lost
constexpr double kMostRise = 0.1;          // share of the depth range over half a kernel
constexpr double kLeastTexels = 0.5;       // of the map's side, a pixel of the image's
constexpr uint64_t kMostLooks =
    1 << 17;  // from a light's points at triangles, evenly spread over the scene's

using Corners = std::array<glm::dvec3, 3>;

// `triangle`: of the mesh; with light_from_object in the light's frame.
Corners corners(const Mesh& mesh, size_t triangle, const glm::dmat4& to) {
  Corners result;
  for (size_t k = 0; k < 3; ++k)
    result[k] = glm::dvec3(to * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]), 1.0));
  return result;
}

// What a light shines on.
struct LitArea {
  std::vector<glm::dvec3> points;  // of the light, in its frame
  bool directional;
  double slope;  // from which a surface counts as grazed
  double all = 0, grazed = 0;
};

// `c` in the light's frame. `front`: 1 where its winding shows the front, -1 of a mirrored instance, 0 where
// both sides count.
void add(LitArea& area, const Corners& c, int front) {
  const glm::dvec3 twice = glm::cross(c[1] - c[0], c[2] - c[0]), middle = (c[0] + c[1] + c[2]) / 3.0;
  const double size = glm::length(twice);
  bool faces = false, grazes = false, above = false, below = false;
  for (const glm::dvec3& point : area.points) {
    const glm::dvec3 to_light = area.directional ? glm::dvec3(0, 0, 1) : point - middle;
    const double cosine = glm::dot(twice, to_light) / (size * glm::length(to_light));  // may be no number
    const bool lit = (front == 0 ? std::abs(cosine) : front * cosine) > 0;
    faces = faces || lit;
    grazes = grazes || (lit && cosine * cosine * (1 + area.slope * area.slope) < 1);
    above = above || cosine > 0;
    below = below || cosine < 0;
  }
  if (!faces) return;
  area.all += size;
  // A light on both sides of a surface's plane grazes it from where it crosses that.
  if (grazes || (above && below)) area.grazed += size;
}

bool crosses(const Corners& c,
             const glm::dvec3& direction) {  // a ray from the origin (Moeller and Trumbore 1997)
  const glm::dvec3 a = c[1] - c[0], b = c[2] - c[0], p = glm::cross(direction, b);
  const double determinant = glm::dot(a, p);
  if (determinant == 0) return false;
  const double u = -glm::dot(c[0], p) / determinant;
  const glm::dvec3 q = glm::cross(-c[0], a);
  const double v = glm::dot(direction, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && glm::dot(b, q) / determinant > 0;
}

bool inside(const Mesh& mesh, const glm::dmat4& light_from_object) {
  const glm::dvec3 place(glm::inverse(light_from_object)[3]);
  if (glm::any(glm::lessThan(place, mesh.bounds.min)) || glm::any(glm::greaterThan(place, mesh.bounds.max)))
    return false;
  const glm::dvec3 direction(0.5377, 0.7071, 0.4591);  // along no axis, so that it seldom meets an edge
  bool odd = false;
  for (size_t i = 0; i < mesh.triangles(); ++i)
    odd ^= crosses(corners(mesh, i, light_from_object), direction);
  return odd;
}

}  // namespace

double grazed_share(const Scene& scene, const Light& light, double slope,
                    const std::vector<glm::dvec3>& points) {
  const glm::dmat4 light_from_world = glm::inverse(light.world_from_light);
  const uint64_t stride = 1 + scene.triangles() * points.size() / kMostLooks;
  LitArea area{points, light.type == LightType::directional, slope};
  uint64_t place = 0;  // of the instance's first triangle among all
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::dmat4 to = light_from_world * instance.world_from_object;
    const int winding = glm::determinant(to) < 0 ? -1 : 1;
    const int front = scene.materials[mesh.material].double_sided ? 0 : winding;
    for (uint64_t i = (stride - place % stride) % stride; i < mesh.triangles(); i += stride)
      add(area, corners(mesh, i, to), front);
    place += mesh.triangles();
  }
  return area.all > 0 ? area.grazed / area.all : 0;
}

const Instance* surrounding_caster(const Scene& scene, const Light& light) {
  if (light.type == LightType::directional) return nullptr;
  const glm::dmat4 light_from_world = glm::inverse(light.world_from_light);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.watertight && inside(mesh, light_from_world * instance.world_from_object)) return &instance;
  }
  return nullptr;
}

namespace {

// Slope beyond which a map of `side` texels, foreshortened by it, tells as little as one of
// kLeastUsefulSide.
double most_slope(uint32_t side) { return std::clamp(double(side) / kLeastUsefulSide, 1.0, kSteepestSlope); }

void warn_about_light(Environment& e, const Light& light, uint32_t side, MapsFrom from) {
  constexpr double degrees = 180 / std::numbers::pi;
  const double slope = most_slope(side);
  const bool area = from == MapsFrom::area && shines_as_area(light);
  const double share =
      grazed_share(e.scene(), light, slope, area ? border_points(*light.area) : std::vector{glm::dvec3(0.0)});
  if (share > kMostGrazed)
    e.warn(fmt::format(
        "{}light '{}' meets {:.0f} % of what it shines on at more than {:.0f} degrees from the normal: "
        "shadows there are coarser than elsewhere",
        area ? "some part of " : "", light.name, 100 * share, std::atan(slope) * degrees));
  if (const Instance* caster = surrounding_caster(e.scene(), light))
    e.warn(
        fmt::format("light '{}' is inside of '{}', which leaves few texels' depths for the rest of the scene",
                    light.name, caster->name));
}

// engine/light/light_views.cpp lets no perspective range be wider.
constexpr double kWidestRange = 1e4 * (1 - 1e-9);  // far / near

void warn_about_range(Environment& e) {
  for (const LightView& view : e.views("views").views) {
    if (view.orthographic || view.far < kWidestRange * view.near) continue;
    e.warn(fmt::format(
        "what is nearer to light '{}' than {:.3g} casts as if it were there, and receives no shadow",
        e.scene().lights[view.light].name, view.near));
    return;
  }
}

}  // namespace

void warn_about_maps(Environment& e, uint32_t side, MapsFrom from) {
  const uint32_t pixels = std::max(e.settings().width, e.settings().height);
  if (side < kLeastUsefulSide)
    e.warn(fmt::format("a map of {} texels a side tells little: use at least {}", side, kLeastUsefulSide));
  else if (side < kLeastTexels * pixels)
    e.warn(fmt::format("a map of {} texels a side is coarse for an image of {} pixels", side, pixels));
  for (const Light& light : e.scene().lights) warn_about_light(e, light, side, from);
  warn_about_range(e);
}

void warn_about_kernel(Environment& e, uint32_t side) {
  const auto kernel = e.params().integer("kernel");
  if (kernel > 1 && static_cast<double>(kernel) > kMostOfMap * side)
    e.warn(fmt::format("a kernel of {} texels covers much of a map of {}: shadows are blurred away", kernel,
                       side));
}

void warn_about_rise(Environment& e, uint32_t side) {
  const double half_kernel = 0.5 * static_cast<double>(e.params().integer("kernel"));
  for (const LightView& view : e.views("views").views) {
    const double middle = view.orthographic ? 1.0 : 0.5 * (view.near + view.far);
    const double texel = 2 * std::max(view.half_width, view.half_height) * middle / side;
    const double slope = kMostRise * (view.far - view.near) / (half_kernel * texel);
    const Light& light = e.scene().lights[view.light];
    const double share = slope < kSteepestSlope ? grazed_share(e.scene(), light, slope) : 0;
    if (share <= kMostGrazed) continue;
    e.warn(
        fmt::format("{:.0f} % of what light '{}' shines on rises, within half a kernel of {:.0f} texels, "
                    "over more than {:.0f} % "
                    "of the map's depth range: a smaller kernel or a larger map would tell it from occluders",
                    100 * share, light.name, 2 * half_kernel, 100 * kMostRise));
    return;
  }
}

}  // namespace gnomon
