// Fits the projections of a light's views to the scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <optional>

#include "engine/base/error.h"
#include "engine/light/casts_beyond.h"
#include "engine/light/light_fit.h"
#include "engine/light/light_view.h"
#include "engine/light/view_depths.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"
#include "engine/scene/wide_spot.h"

namespace gnomon {
namespace {

constexpr double kMargin = 0.01;  // of near and far, and of an orthographic map's half width
// Of far. Perspective depth tells far distances apart by 6e-8 / kSmallestNear of them: a texel of a map of
// 4096 a side. Nearer casters are drawn as if they were there.
constexpr double kSmallestNear = 1e-4;
// A view is fitted to what is near where the next vertex is so many times as far, and nothing there casts on
// what the camera sees: its map would be as many times as coarse.
constexpr double kWorthLeavingOut = 16;

struct Range {  // of depths along the view axis; empty when lo > hi
  double lo = 1e300, hi = -1e300;
  bool empty() const { return lo > hi; }
};

Range range_of(const Shells& depths) {
  const Bounds all = depths.all();
  return {all.min.x, all.max.x};
}

void set_perspective_range(LightView& view, Range range, double size) {
  if (range.empty()) range = {0.01 * size, size};  // nothing in sight: any valid range will do
  view.far = range.hi * (1.0 + kMargin);
  view.near = std::max(range.lo * (1.0 - kMargin), view.far * kSmallestNear);
  view.farthest = view.far;
}

}  // namespace

// What one light sees of some of the scene's instances.
struct ViewFit {
  Shells depths;  // spot and point lights
  Shells box;     // directional lights: along the light's axes, about the scene's centre at time 0
};

namespace {

LightView spot_view(const Scene& scene, uint32_t index) {
  const Light& light = scene.lights[index];
  LightView view;
  view.light = index;
  view.light_from_world = glm::inverse(light.world_from_light);
  view.half_width = view.half_height = std::tan(0.5 * light.map_fov);
  return view;
}

// The light's axes at the scene's centre, so that far origins lose no digits: the position of a directional
// light means nothing.
glm::dmat4 axes_at(const Light& light, const glm::dvec3& place) {
  glm::dmat4 axes = light.world_from_light;
  axes[3] = glm::dvec4(place, 1.0);
  return axes;
}
glm::dmat4 centred_axes(const Scene& scene, uint32_t index) {
  return axes_at(scene.lights[index], scene.bounds.centre());
}

// Fitted to the vertices along the light's own axes: the map is centred on them and the nearest vertex is one
// scene depth away. `axes`: those that `box` is along. `size`: of what the view shows.
LightView directional_view(uint32_t index, glm::dmat4 axes, Bounds box, double size) {
  LightView view;
  view.light = index;
  view.orthographic = true;
  if (box.empty()) box.add(glm::dvec3(0.0));
  const double depth = std::max(box.max.z - box.min.z, 1e-3 * size);
  const glm::dvec3 centre = box.centre();
  axes[3] = axes * glm::dvec4(centre.x, centre.y, box.max.z + depth, 1.0);
  view.light_from_world = glm::inverse(axes);
  view.half_width = std::max(0.5 * (box.max.x - box.min.x) * (1.0 + kMargin), 1e-3 * size);
  view.half_height = std::max(0.5 * (box.max.y - box.min.y) * (1.0 + kMargin), 1e-3 * size);
  view.near = (1.0 - kMargin) * depth;
  view.far = (1.0 + kMargin) * 2.0 * depth;
  return view;
}

struct Axes {
  glm::dvec3 forward, up;
};
// Layer order, and the direction that is up in each face of the cube: +y on the four sides; +z on +y and -z
// on -y, so that the upper edge of each side meets the y faces without a turn about the z axis.
constexpr std::array<Axes, 6> kCubeAxes = {{{{1, 0, 0}, {0, 1, 0}},
                                            {{-1, 0, 0}, {0, 1, 0}},
                                            {{0, 1, 0}, {0, 0, 1}},
                                            {{0, -1, 0}, {0, 0, -1}},
                                            {{0, 0, 1}, {0, 1, 0}},
                                            {{0, 0, -1}, {0, 1, 0}}}};

std::vector<LightView> point_views(const Scene& scene, uint32_t index, uint32_t map_size, uint32_t border) {
  if (map_size <= 2 * static_cast<uint64_t>(border))
    fail("a border of " + std::to_string(border) + " texels leaves nothing of a map of " +
             std::to_string(map_size),
         {}, "light '" + scene.lights[index].name + "'", "use a larger shadow map");
  const double half = static_cast<double>(map_size) / (static_cast<double>(map_size) - 2.0 * border);
  std::vector<LightView> views;
  for (const Axes& axes : kCubeAxes) {
    glm::dmat4 light_from_face(1.0);
    light_from_face[0] = glm::dvec4(glm::cross(axes.forward, axes.up), 0.0);
    light_from_face[1] = glm::dvec4(axes.up, 0.0);
    light_from_face[2] = glm::dvec4(-axes.forward, 0.0);
    LightView view;
    view.light = index;
    view.light_from_world = glm::inverse(scene.lights[index].world_from_light * light_from_face);
    view.half_width = view.half_height = half;
    views.push_back(view);
  }
  return views;
}

// Without their ranges; of a directional light none, as all of its view is fitted.
std::vector<LightView> unfitted_views(const Scene& scene, uint32_t index, uint32_t map_size,
                                      uint32_t border) {
  switch (view_type(scene.lights[index])) {
    case LightType::spot:
      return {spot_view(scene, index)};
    case LightType::point:
      return point_views(scene, index, map_size, border);
    case LightType::directional:
      break;
  }
  return {};
}

ViewFit measure(const Scene& scene, uint32_t index, const std::vector<LightView>& views,
                const Measured& measured) {
  ViewFit fit;
  if (scene.lights[index].type == LightType::directional)
    fit.box = box_along(scene, centred_axes(scene, index), measured);
  for (const LightView& view : views) fit.depths.add(depths_inside(scene, view, measured));
  return fit;
}

Measured measured_of(const Scene& scene, Which which, const glm::dvec3& middle) {
  return {which, middle, std::numeric_limits<double>::infinity(), scene_size(scene)};
}

// How far the vertices are that views have to show; nothing: all of them. The penumbrae of a sun with a size
// may reach further than what casts them.
std::optional<double> needed_reach(const Scene& scene, uint32_t index, const ViewFit& fit,
                                   const glm::dvec3& middle, const SeenFrom& seen) {
  const Light& light = scene.lights[index];
  const bool directional = light.type == LightType::directional;
  if (directional && has_size(light)) return std::nullopt;
  for (const double reach : (directional ? fit.box : fit.depths).gaps(kWorthLeavingOut))
    if (!casts_beyond(scene, light, middle, reach, seen)) return reach;
  return std::nullopt;
}

// Views of what is near alone. What is further off casts from where the view ends, and receives what is cast.
void fit_to_near(const Scene& scene, uint32_t index, const Measured& near, std::vector<LightView>& views) {
  const bool perspective = !views.empty();
  ViewFit fit = measure(scene, index, views, near);
  if (perspective) {
    for (LightView& view : views) {
      const double farthest = view.farthest;
      set_perspective_range(view, range_of(fit.depths), near.size);
      view.farthest = farthest;
    }
    return;
  }
  // Once more about its own centre: the scene's may be so far off that rounding tells.
  glm::dmat4 axes = centred_axes(scene, index);
  axes = axes_at(scene.lights[index], glm::dvec3(axes * glm::dvec4(fit.box.all().centre(), 1.0)));
  const Bounds box = box_along(scene, axes, near).all();
  views.push_back(directional_view(index, axes, box, box.radius()));
}

// One range for all views of a light, so that depths can be compared across them. `still`: what was measured
// of the instances that stand still; nullptr: nothing. `middle`: see Measured.
void add_views(const Scene& scene, uint32_t index, uint32_t map_size, uint32_t border, const ViewFit* still,
               const glm::dvec3& middle, const std::optional<SeenFrom>& seen,
               std::vector<LightView>& result) {
  std::vector<LightView> views = unfitted_views(scene, index, map_size, border);
  const Which which = still != nullptr ? Which::moving : Which::all;
  ViewFit fit = measure(scene, index, views, measured_of(scene, which, middle));
  if (still != nullptr) fit.depths.add(still->depths), fit.box.add(still->box);
  for (LightView& view : views) set_perspective_range(view, range_of(fit.depths), scene_size(scene));
  const auto reach = seen ? needed_reach(scene, index, fit, middle, *seen) : std::nullopt;
  if (reach)
    fit_to_near(scene, index, {Which::all, middle, *reach, *reach}, views);
  else if (views.empty())
    views.push_back(directional_view(index, centred_axes(scene, index), fit.box.all(), scene_size(scene)));
  result.insert(result.end(), views.begin(), views.end());
}

// What distances of directional lights' vertices are from.
glm::dvec3 middle_of(const Scene& scene, const std::optional<SeenFrom>& seen) {
  return seen ? glm::dvec3(seen->camera.world_from_camera[3]) : scene.bounds.centre();
}

}  // namespace

glm::dmat4 LightView::clip_from_light() const {
  glm::dmat4 clip(0.0);
  clip[0].x = 1.0 / half_width;
  clip[1].y = -1.0 / half_height;
  if (orthographic) {
    clip[2].z = -1.0 / (far - near);
    clip[3].z = -near / (far - near);
    clip[3].w = 1.0;
  } else {
    clip[2].z = -far / (far - near);
    clip[3].z = -near * far / (far - near);
    clip[2].w = -1.0;
  }
  return clip;
}

std::vector<LightView> light_views(const Scene& scene, uint32_t map_size, uint32_t border,
                                   const std::optional<SeenFrom>& seen) {
  std::vector<LightView> views;
  for (uint32_t i = 0; i < scene.lights.size(); ++i)
    add_views(scene, i, map_size, border, nullptr, middle_of(scene, seen), seen, views);
  return views;
}

LightFit::LightFit(const Scene& scene, uint32_t map_size, uint32_t border,
                   const std::optional<SeenFrom>& seen)
    : map_size_(map_size),
      border_(border),
      seen_(seen),
      middle_(middle_of(scene, seen)),
      still_(scene.lights.size()) {
  for (uint32_t i = 0; i < scene.lights.size(); ++i)
    if (!scene.lights[i].moving)
      still_[i] = measure(scene, i, unfitted_views(scene, i, map_size, border),
                          measured_of(scene, Which::still, middle_));
}
LightFit::LightFit(LightFit&&) noexcept = default;
LightFit& LightFit::operator=(LightFit&&) noexcept = default;
LightFit::~LightFit() = default;

std::vector<LightView> LightFit::views(const Scene& scene) const {
  std::vector<LightView> views;
  for (uint32_t i = 0; i < scene.lights.size(); ++i)
    add_views(scene, i, map_size_, border_, scene.lights[i].moving ? nullptr : &still_[i], middle_, seen_,
              views);
  return views;
}

// Between light and receivers lies the hull of the light's rectangle and the frustum. The frustum from an
// apex behind the light, which the rectangle just fits, holds it.
AreaView area_view(const Scene& scene, const LightView& centre) {
  const Light& light = scene.lights[centre.light];
  if (!shines_as_area(light)) return {centre, 0};
  const double x = 0.5 * light.area->width, y = 0.5 * light.area->height;
  const double back = std::max(x / centre.half_width, y / centre.half_height);
  LightView behind = centre;
  behind.light_from_world =
      glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -back)) * centre.light_from_world;
  Measured measured = measured_of(scene, Which::all, glm::dvec3(0.0));
  if (centre.far < centre.farthest) measured.reach = centre.far + back;
  Range depths = range_of(depths_inside(scene, behind, measured, back));
  depths.lo -= back, depths.hi -= back;
  AreaView result{centre, 0};
  set_perspective_range(result.view, depths, scene_size(scene));
  if (centre.far < centre.farthest) result.view.farthest = centre.farthest;
  // Receivers at depth z lie within +-t z of the axis, seen from a sample at x within (+-t z - x) / z. Nearer
  // than the light's own size the window would only widen.
  const double farthest = result.view.farthest;
  const double nearest = std::min(std::max(result.view.near, std::max(x, y)), farthest);
  const double spread = 0.5 * (1.0 / nearest - 1.0 / farthest);
  result.converge = 0.5 * (1.0 / nearest + 1.0 / farthest);
  result.view.half_width += x * spread, result.view.half_height += y * spread;
  return result;
}

}  // namespace gnomon
