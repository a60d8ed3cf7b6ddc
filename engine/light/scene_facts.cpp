// Finds what of a scene decides which passes it needs.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/light/caster_culling.h"
#include "engine/light/scene_facts.h"
#include "engine/scene/area_light.h"
#include "engine/scene/mesh_clean.h"
#include "engine/scene/scene.h"
#include "engine/scene/wide_spot.h"

namespace gnomon {
namespace {

using Corners = std::array<glm::dvec3, 8>;

struct View {
  glm::dvec4 eye;  // relative to the scene's centre; w = 0: the direction towards an orthographic one
  std::vector<bool> visible;  // per body
  ViewVolume volume;
};

struct Body {       // an instance, by its bounds
  Corners corners;  // world, relative to the scene's centre
  bool planar = false;
  glm::dvec3 point{0.0}, normal{0.0};  // of a planar one's plane
};

Bounds bounds_of(const Corners& corners, const glm::dmat3& axes) {
  Bounds box;
  for (const glm::dvec3& p : corners) box.add(axes * p);
  return box;
}

bool overlap(const Bounds& a, const Bounds& b) {
  return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

// The light as points whose convex hull holds it: its centre, or points around its area.
struct Source {
  bool directional = false;
  glm::dvec4 place{0.0};  // light_place(), relative to the scene's centre
  double radius = 0;      // of the area around it; of a directional light, of what it can move shadows by
  double half_angle = 0;  // of a directional light: tangent of half its angular diameter
  std::optional<double> range;
  glm::dmat4 light_from_world{1.0};  // relative to the scene's centre
  std::vector<glm::dvec3> points;
  double half_tangent = 0;  // of a spot's square frustum; 0: all directions
};

Source source_of(const Light& light, const glm::dvec3& origin) {
  Source source;
  source.directional = light.type == LightType::directional;
  glm::dmat4 placed = light.world_from_light;
  placed[3] -= glm::dvec4(origin, 0.0);
  source.light_from_world = glm::inverse(placed);
  source.place = light_place(light, origin);
  if (light.type != LightType::directional) source.range = light.range;
  if (source.directional && has_size(light)) source.half_angle = 0.5 * light.area->width;
  if (source.directional || !has_size(light))
    source.points.emplace_back(placed[3]);
  else
    for (const glm::dvec3& p : enclosing_points(*light.area))
      source.points.emplace_back(placed * glm::dvec4(p, 1.0));
  for (const glm::dvec3& p : source.points)
    source.radius = std::max(source.radius, glm::distance(p, glm::dvec3(placed[3])));
  if (light.type == LightType::spot && !is_cut(light)) source.half_tangent = std::tan(0.5 * light.map_fov);
  return source;
}

// All of the caster is behind the plane of a planar receiver, seen from every point of the light, or in the
// plane.
bool behind(const Body& caster, const Body& receiver, const Source& source, double tolerance) {
  if (!receiver.planar) return false;
  const auto height = [&](const glm::dvec3& p) { return glm::dot(p - receiver.point, receiver.normal); };
  double side = 0;
  if (source.directional) {
    side = glm::dot(glm::dvec3(source.place), receiver.normal);
    // Of the light's disc some points are on the other side.
    const double across = std::sqrt(std::max(0.0, 1 - side * side));
    if (std::abs(side) <= source.half_angle * across) return false;
  } else {
    for (const glm::dvec3& p : source.points) {
      const double h = height(p);
      if (side != 0 && h * side <= 0) return false;
      side = h;
    }
  }
  if (std::abs(side) <= tolerance) return false;
  return std::all_of(caster.corners.begin(), caster.corners.end(),
                     [&](const glm::dvec3& p) { return height(p) * (side > 0 ? 1.0 : -1.0) <= tolerance; });
}

// Could a segment from the light to the receiver's bounds meet the caster's? Answers yes when in doubt: boxes
// around the hull of light and receiver, along the world's and along the light's axes.
bool may_shadow(const Body& caster, const Body& receiver, const Source& source, double tolerance) {
  if (behind(caster, receiver, source, tolerance)) return false;
  const glm::dmat3 light_axes(source.light_from_world);
  if (source.directional) {
    const Bounds from = bounds_of(caster.corners, light_axes);
    Bounds onto = bounds_of(receiver.corners, light_axes);
    const double aside = source.half_angle * std::max(0.0, from.max.z - onto.min.z);
    onto.min -= glm::dvec3(aside, aside, 0), onto.max += glm::dvec3(aside, aside, 0);
    onto.max.z = std::max(onto.max.z, from.max.z);  // towards the light without end
    return overlap(from, onto);
  }
  for (const glm::dmat3& axes : {glm::dmat3(1.0), light_axes}) {
    Bounds hull = bounds_of(receiver.corners, axes);
    for (const glm::dvec3& p : source.points) hull.add(axes * p);
    if (!overlap(bounds_of(caster.corners, axes), hull)) return false;
  }
  return true;
}

// The longest way towards a directional light from what the camera may see to what may cast a shadow on it.
double way_to_light(const std::vector<Body>& bodies, const View& view, const Source& source) {
  double lowest = 1e300, highest = -1e300;
  for (size_t i = 0; i < bodies.size(); ++i)
    for (const glm::dvec3& p : bodies[i].corners) {
      const double height = glm::dot(p, glm::dvec3(source.place));
      highest = std::max(highest, height);
      if (view.visible[i]) lowest = std::min(lowest, height);
    }
  return std::max(0.0, highest - lowest);
}

// A penumbra is at most as wide as the light, times the way from the nearest caster to the farthest receiver,
// over that from the light to the caster. World units.
double widest_penumbra(const std::vector<Body>& bodies, const View& view, const Source& source) {
  if (source.directional) return 2 * source.radius;
  if (source.radius == 0) return 0;
  const glm::dvec3 centre(source.place);
  double nearest = 1e300, farthest = 0;
  for (size_t i = 0; i < bodies.size(); ++i) {
    Bounds box;
    for (const glm::dvec3& p : bodies[i].corners) {
      box.add(p);
      if (view.visible[i]) farthest = std::max(farthest, glm::distance(p, centre));
    }
    nearest = std::min(nearest, glm::distance(glm::clamp(centre, box.min, box.max), centre));
  }
  const double gap = nearest - source.radius;
  if (farthest <= nearest) return 0;
  return gap > 0 ? 2 * source.radius * (farthest - nearest) / gap : 1e300;
}

std::vector<Body> bodies_of(const Scene& scene, const glm::dvec3& origin) {
  struct Flat {
    bool known = false, planar = false;
    glm::dvec3 point{0.0}, normal{0.0};
  };
  std::vector<Flat> flats(scene.meshes.size());
  std::vector<Body> bodies;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    Flat& flat = flats[instance.mesh];
    if (!flat.known) flat.planar = is_planar(mesh, flat.point, flat.normal), flat.known = true;
    glm::dmat4 placed = instance.world_from_object;
    placed[3] -= glm::dvec4(origin, 0.0);
    Body body{box_corners(scene, instance, origin),
              flat.planar,
              glm::dvec3(placed * glm::dvec4(flat.point, 1.0)),
              {}};
    if (flat.planar)
      body.normal = glm::normalize(glm::inverse(glm::transpose(glm::dmat3(placed))) * flat.normal);
    bodies.push_back(body);
  }
  return bodies;
}

// The camera sees only the side of a planar receiver that faces away from the light's centre.
bool faces_away(const Body& receiver, const Source& source, const glm::dvec4& eye) {
  if (!receiver.planar) return false;
  constexpr double kGrazing = 1e-3;  // sine of the angle below which planar meshes' triangles may differ
  const double seen = glm::dot(glm::dvec3(eye) - eye.w * receiver.point, receiver.normal);
  const glm::dvec3 to_light = glm::dvec3(source.place) - source.place.w * receiver.point;
  const double side = glm::dot(to_light, receiver.normal) * (seen < 0 ? -1.0 : 1.0);
  return side < -kGrazing * glm::length(to_light);
}

// Nothing of the bounds is within the light's range.
bool out_of_range(const Body& receiver, const Source& source) {
  if (!source.range) return false;
  Bounds box;
  for (const glm::dvec3& p : receiver.corners) box.add(p);
  const glm::dvec3 centre(source.place);
  return glm::distance(glm::clamp(centre, box.min, box.max), centre) > *source.range;
}

// Why the camera sees no shadow of a light; empty: it may see one.
std::string shadowless_reason(const std::vector<Body>& bodies, const View& view, const Source& source,
                              double tolerance) {
  std::vector<size_t> seen;
  for (size_t r = 0; r < bodies.size(); ++r)
    if (view.visible[r]) seen.push_back(r);
  if (seen.empty()) return "the camera sees nothing";
  const auto keep = [&](auto&& leaves_out) {
    std::erase_if(seen, [&](size_t r) { return leaves_out(bodies[r]); });
    return seen.empty();
  };
  if (keep([&](const Body& r) { return out_of_range(r, source); }))
    return "nothing that the camera sees is within the light's range";
  if (source.half_tangent > 0 && keep([&](const Body& r) {
        return outside_pyramid(r.corners, source.light_from_world, source.half_tangent, source.half_tangent,
                               0.0);
      }))
    return "nothing that the camera sees is in the light's frustum";
  if (keep([&](const Body& r) { return faces_away(r, source, view.eye); }))
    return "everything that the camera sees faces away from the light";
  const LightVolume between(view.volume, source.place, source.radius + tolerance);
  for (size_t c = 0; c < bodies.size(); ++c) {
    if (!between.meets(bodies[c].corners)) continue;
    for (const size_t r : seen) {
      if (c == r && bodies[c].planar) continue;  // a plane cannot shadow itself
      if (c == r || may_shadow(bodies[c], bodies[r], source, tolerance)) return {};
    }
  }
  return SceneFacts::no_caster;
}

}  // namespace

SceneFacts scene_facts(const Scene& scene, const Camera& camera, double aspect, uint32_t height) {
  SceneFacts facts;
  facts.triangles = scene.triangles();
  facts.lights = static_cast<uint32_t>(scene.lights.size());
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& material = scene.materials[mesh.material];
    facts.has_alpha_mask |= material.alpha_masked;
    facts.has_double_sided |= material.double_sided;
    facts.has_open_meshes |= !mesh.watertight;
    facts.casters_move |= instance.moving;
  }
  facts.animated = scene.animation != nullptr;
  const glm::dvec3 origin = scene.bounds.empty() ? glm::dvec3(0.0) : scene.bounds.centre();
  const std::vector<Body> bodies = bodies_of(scene, origin);
  glm::dmat4 placed = camera.world_from_camera;
  placed[3] -= glm::dvec4(origin, 0.0);
  const glm::dmat4 view = glm::inverse(placed);
  const double half = half_extent(camera, aspect).y;
  View seen{camera.span ? placed[2] : placed[3], {}, ViewVolume(scene, camera, aspect, origin)};
  for (const Body& body : bodies) seen.visible.push_back(!outside_view(body.corners, view, camera, aspect));
  facts.middle_depth = camera.span ? half : std::max(glm::length(glm::dvec3(placed[3])), 1e-30);
  const bool still = !facts.casters_move && !camera.moving;
  facts.nearest_depth = still ? std::max(seen.volume.nearest(), camera.near) : camera.near;
  if (camera.span) facts.nearest_depth = half;
  if (height > 0) facts.smallest_pixel = 2 * (camera.span ? 1.0 : half) / height * facts.nearest_depth;
  for (const Light& light : scene.lights) {
    facts.light_moves.push_back(light.moving);
    const bool may = !still || light.moving;  // somewhere on the way
    Source source = source_of(light, origin);
    if (source.directional) source.radius = source.half_angle * way_to_light(bodies, seen, source);
    facts.shadowless.push_back(may ? std::string()
                                   : shadowless_reason(bodies, seen, source, 1e-6 * scene.bounds.radius()));
    const double widest = may ? 1e300 : widest_penumbra(bodies, seen, source);
    facts.penumbra.push_back(widest == 0 ? 0.0 : widest / std::max(facts.smallest_pixel, 1e-300));
    facts.light_size.push_back(has_size(light) ? std::max(light.area->width, light.area->height) : 0.0);
  }
  return facts;
}

std::string SceneFacts::no_shadow() const {
  std::string reason;
  for (const std::string& why : shadowless) {
    if (why.empty()) return {};
    if (reason.find(why) == std::string::npos) reason += (reason.empty() ? "" : "; ") + why;
  }
  return reason;
}

SceneFacts promising_nothing(SceneFacts facts) {
  facts.has_alpha_mask = facts.has_double_sided = facts.has_open_meshes = true;
  facts.animated = facts.casters_move = true;
  facts.nearest_depth = facts.smallest_pixel = 0;
  facts.penumbra.assign(facts.penumbra.size(), 1e300);
  facts.shadowless.assign(facts.shadowless.size(), {});
  facts.light_moves.assign(facts.light_moves.size(), true);
  return facts;
}

}  // namespace gnomon
