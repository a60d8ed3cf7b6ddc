// Fits the projections of a light's views to the scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <span>

#include "engine/base/error.h"
#include "engine/light/light_fit.h"
#include "engine/light/light_view.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"
#include "engine/scene/wide_spot.h"

namespace gnomon {
namespace {

constexpr double kMargin = 0.01;  // of near and far, and of an orthographic map's half width
// Of far. Perspective depth tells far distances apart by 6e-8 / kSmallestNear of them: a texel of a map of
// 4096 a side. Nearer casters are drawn as if they were there.
constexpr double kSmallestNear = 1e-4;
constexpr double kSmallestDepth = 1e-9;  // of the scene's radius: nothing nearer to the light counts

struct Range {  // of depths along the view axis; empty when lo > hi
  double lo = 1e300, hi = -1e300;
  bool empty() const { return lo > hi; }
  void add(double d) { lo = std::min(lo, d), hi = std::max(hi, d); }
  void add(const Range& other) { lo = std::min(lo, other.lo), hi = std::max(hi, other.hi); }
};

// A half space dot(normal, p) + offset >= 0 in light space.
struct Plane {
  glm::dvec3 normal;
  double offset = 0;
  double distance(const glm::dvec3& p) const { return glm::dot(normal, p) + offset; }
};
using Frustum = std::array<Plane, 5>;  // four sides through the light, and z <= -nearest

Frustum perspective_frustum(double half_width, double half_height, double nearest) {
  return {Plane{{1, 0, -half_width}}, Plane{{-1, 0, -half_width}}, Plane{{0, 1, -half_height}},
          Plane{{0, -1, -half_height}}, Plane{{0, 0, -1}, -nearest}};
}

// A triangle against 5 planes has at most 8 corners (Sutherland and Hodgman 1974).
struct Polygon {
  std::array<glm::dvec3, 10> corners{};
  size_t count = 0;
  void add(const glm::dvec3& p) {
    if (count < corners.size()) corners[count++] = p;
  }
};

Polygon clip(const Polygon& polygon, const Plane& plane) {
  Polygon result;
  for (size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
    const double da = plane.distance(a), db = plane.distance(b);
    if (da >= 0) result.add(a);
    if ((da >= 0) != (db >= 0)) result.add(a + (b - a) * (da / (da - db)));
  }
  return result;
}

struct Transformed {  // one mesh in light space; outcodes: bit i set when outside plane i
  std::vector<glm::dvec3> positions;
  std::vector<uint8_t> outcodes;
};

uint8_t outcode(const Frustum& frustum, const glm::dvec3& p) {
  uint8_t code = 0;
  for (size_t i = 0; i < frustum.size(); ++i)
    code = static_cast<uint8_t>(code | (frustum[i].distance(p) < 0 ? 1u << i : 0u));
  return code;
}

void add_clipped(const Frustum& frustum, uint8_t crossed, const std::array<glm::dvec3, 3>& triangle,
                 Range& range) {
  Polygon polygon;
  for (const glm::dvec3& p : triangle) polygon.add(p);
  for (size_t i = 0; i < frustum.size(); ++i)
    if ((crossed >> i & 1) != 0) polygon = clip(polygon, frustum[i]);
  for (size_t i = 0; i < polygon.count; ++i) range.add(-polygon.corners[i].z);
}

// The corners of an object-space box decide first: all outside one plane, or all inside.
std::pair<uint8_t, uint8_t> box_outcodes(const Bounds& box, const glm::dmat4& light_from_object,
                                         const Frustum& frustum) {
  uint8_t all = 0xFF, any = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                            (i & 4) != 0 ? box.max.z : box.min.z);
    const uint8_t code = outcode(frustum, glm::dvec3(light_from_object * glm::dvec4(corner, 1.0)));
    all &= code, any |= code;
  }
  return {all, any};
}

// Depths of the part of a mesh inside the frustum: its triangles are clipped, so that a large one counts with
// what the frustum holds of it and with nothing else.
void add_mesh(const Mesh& mesh, const glm::dmat4& light_from_object, const Frustum& frustum,
              Transformed& work, Range& range) {
  const auto [all, any] = box_outcodes(mesh.bounds, light_from_object, frustum);
  if (all != 0) return;
  const auto to_light = [&](const glm::vec3& p) {
    return glm::dvec3(light_from_object * glm::dvec4(glm::dvec3(p), 1.0));
  };
  if (any == 0) {
    for (const glm::vec3& p : mesh.positions) range.add(-to_light(p).z);
    return;
  }
  work.positions.resize(mesh.positions.size());
  work.outcodes.resize(mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    work.positions[i] = to_light(mesh.positions[i]);
    work.outcodes[i] = outcode(frustum, work.positions[i]);
    if (work.outcodes[i] == 0) range.add(-work.positions[i].z);
  }
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const uint8_t crossed = work.outcodes[a] | work.outcodes[b] | work.outcodes[c];
    if (crossed == 0 || (work.outcodes[a] & work.outcodes[b] & work.outcodes[c]) != 0) continue;
    add_clipped(frustum, crossed, {work.positions[a], work.positions[b], work.positions[c]}, range);
  }
}

double scene_size(const Scene& scene) {
  const double radius = scene.bounds.radius();
  return radius > 0 && std::isfinite(radius) ? radius : 1.0;
}

// Which instances are measured: all, those that stand still, or those that move.
enum class Which { all, still, moving };
bool takes(Which which, const Instance& instance) {
  if (!instance.visible) return false;
  return which == Which::all || instance.moving == (which == Which::moving);
}

// `from`: nothing nearer to the view's apex counts.
Range depths_inside(const Scene& scene, const LightView& view, Which which, double from = 0) {
  const Frustum frustum =
      perspective_frustum(view.half_width, view.half_height, from + kSmallestDepth * scene_size(scene));
  Range range;
  Transformed work;
  for (const Instance& instance : scene.instances)
    if (takes(which, instance))
      add_mesh(scene.meshes[instance.mesh], view.light_from_world * instance.world_from_object, frustum, work,
               range);
  return range;
}

void set_perspective_range(LightView& view, Range range, double size) {
  if (range.empty()) range = {0.01 * size, size};  // nothing in sight: any valid range will do
  view.far = range.hi * (1.0 + kMargin);
  view.near = std::max(range.lo * (1.0 - kMargin), view.far * kSmallestNear);
}

}  // namespace

// What one light sees of some of the scene's instances.
struct ViewFit {
  Range depths;  // spot and point lights
  Bounds box;    // directional lights: along the light's axes, about the scene's centre at time 0
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
glm::dmat4 centred_axes(const Scene& scene, uint32_t index) {
  glm::dmat4 axes = scene.lights[index].world_from_light;
  axes[3] = glm::dvec4(scene.bounds.centre(), 1.0);
  return axes;
}

Bounds box_along(const Scene& scene, const glm::dmat4& axes, Which which) {
  const glm::dmat4 light_from_world = glm::inverse(axes);
  Bounds box;
  for (const Instance& instance : scene.instances) {
    if (!takes(which, instance)) continue;
    const glm::dmat4 light_from_object = light_from_world * instance.world_from_object;
    for (const glm::vec3& p : scene.meshes[instance.mesh].positions)
      box.add(glm::dvec3(light_from_object * glm::dvec4(glm::dvec3(p), 1.0)));
  }
  return box;
}

// Fitted to the vertices along the light's own axes: the map is centred on them and the nearest vertex is one
// scene depth away.
LightView directional_view(const Scene& scene, uint32_t index, Bounds box) {
  LightView view;
  view.light = index;
  view.orthographic = true;
  glm::dmat4 axes = centred_axes(scene, index);
  if (box.empty()) box.add(glm::dvec3(0.0));
  const double size = scene_size(scene);
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

ViewFit measure(const Scene& scene, uint32_t index, const std::vector<LightView>& views, Which which) {
  ViewFit fit;
  if (scene.lights[index].type == LightType::directional)
    fit.box = box_along(scene, centred_axes(scene, index), which);
  for (const LightView& view : views) fit.depths.add(depths_inside(scene, view, which));
  return fit;
}

// One range for all views of a light, so that depths can be compared across them. `still`: what was measured
// of the instances that stand still; nullptr: nothing.
void add_views(const Scene& scene, uint32_t index, uint32_t map_size, uint32_t border, const ViewFit* still,
               std::vector<LightView>& result) {
  std::vector<LightView> views = unfitted_views(scene, index, map_size, border);
  ViewFit fit = measure(scene, index, views, still != nullptr ? Which::moving : Which::all);
  if (still != nullptr) {
    fit.depths.add(still->depths);
    if (!still->box.empty()) fit.box.add(still->box.min), fit.box.add(still->box.max);
  }
  for (LightView& view : views) set_perspective_range(view, fit.depths, scene_size(scene));
  if (views.empty()) views.push_back(directional_view(scene, index, fit.box));
  result.insert(result.end(), views.begin(), views.end());
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

std::vector<LightView> light_views(const Scene& scene, uint32_t map_size, uint32_t border) {
  std::vector<LightView> views;
  for (uint32_t i = 0; i < scene.lights.size(); ++i) add_views(scene, i, map_size, border, nullptr, views);
  return views;
}

LightFit::LightFit(const Scene& scene, uint32_t map_size, uint32_t border)
    : map_size_(map_size), border_(border), still_(scene.lights.size()) {
  for (uint32_t i = 0; i < scene.lights.size(); ++i)
    if (!scene.lights[i].moving)
      still_[i] = measure(scene, i, unfitted_views(scene, i, map_size, border), Which::still);
}
LightFit::LightFit(LightFit&&) noexcept = default;
LightFit& LightFit::operator=(LightFit&&) noexcept = default;
LightFit::~LightFit() = default;

std::vector<LightView> LightFit::views(const Scene& scene) const {
  std::vector<LightView> views;
  for (uint32_t i = 0; i < scene.lights.size(); ++i)
    add_views(scene, i, map_size_, border_, scene.lights[i].moving ? nullptr : &still_[i], views);
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
  Range depths = depths_inside(scene, behind, Which::all, back);
  depths.lo -= back, depths.hi -= back;
  AreaView result{centre, 0};
  set_perspective_range(result.view, depths, scene_size(scene));
  // Receivers at depth z lie within +-t z of the axis, seen from a sample at x within (+-t z - x) / z. Nearer
  // than the light's own size the window would only widen.
  const double nearest = std::min(std::max(result.view.near, std::max(x, y)), result.view.far);
  const double spread = 0.5 * (1.0 / nearest - 1.0 / result.view.far);
  result.converge = 0.5 * (1.0 / nearest + 1.0 / result.view.far);
  result.view.half_width += x * spread, result.view.half_height += y * spread;
  return result;
}

}  // namespace gnomon
