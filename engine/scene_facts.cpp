#include <algorithm>
#include <array>
#include <cmath>

#include "engine/area_light.h"
#include "engine/mesh_clean.h"
#include "engine/scene.h"

namespace gnomon {
namespace {

using Corners = std::array<glm::dvec3, 8>;

struct Body {       // an instance, by its bounds
  Corners corners;  // world, relative to the scene's centre
  bool planar = false;
  glm::dvec3 point{0.0}, normal{0.0};  // of a planar one's plane
};

Corners corners_of(const Bounds& box, const glm::dmat4& transform) {
  Corners corners;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                            (i & 4) != 0 ? box.max.z : box.min.z);
    corners[static_cast<size_t>(i)] = glm::dvec3(transform * glm::dvec4(corner, 1.0));
  }
  return corners;
}

Bounds bounds_of(const Corners& corners, const glm::dmat3& axes) {
  Bounds box;
  for (const glm::dvec3& p : corners) box.add(axes * p);
  return box;
}

bool overlap(const Bounds& a, const Bounds& b) {
  return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

// Some plane of an open pyramid (looking along -z) has all corners outside.
bool outside_pyramid(const Corners& corners, const glm::dmat4& view_from_world, double half_width,
                     double half_height, double nearest) {
  std::array<int, 5> outside{};
  for (const glm::dvec3& p : corners) {
    const glm::dvec3 v(view_from_world * glm::dvec4(p, 1.0));
    outside[0] += v.x < half_width * v.z;
    outside[1] += -v.x < half_width * v.z;
    outside[2] += v.y < half_height * v.z;
    outside[3] += -v.y < half_height * v.z;
    outside[4] += -v.z < nearest;
  }
  return std::find(outside.begin(), outside.end(), 8) != outside.end();
}

// The light as points whose convex hull holds it: its centre, or points around its area.
struct Source {
  bool directional = false;
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
  if (!shines_as_area(light))
    source.points.emplace_back(placed[3]);
  else
    for (const glm::dvec3& p : enclosing_points(*light.area))
      source.points.emplace_back(placed * glm::dvec4(p, 1.0));
  if (light.type == LightType::spot) source.half_tangent = std::tan(0.5 * light.map_fov);
  return source;
}

// All of the caster is behind the plane of a planar receiver, seen from every point of the light, or in the
// plane.
bool behind(const Body& caster, const Body& receiver, const Source& source, double tolerance) {
  if (!receiver.planar) return false;
  const auto height = [&](const glm::dvec3& p) { return glm::dot(p - receiver.point, receiver.normal); };
  double side = 0;
  if (source.directional) {
    side = glm::dot(glm::dvec3(glm::transpose(source.light_from_world)[2]), receiver.normal);
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
    Body body{
        corners_of(mesh.bounds, placed), flat.planar, glm::dvec3(placed * glm::dvec4(flat.point, 1.0)), {}};
    if (flat.planar)
      body.normal = glm::normalize(glm::inverse(glm::transpose(glm::dmat3(placed))) * flat.normal);
    bodies.push_back(body);
  }
  return bodies;
}

bool casts_visible_shadow(const std::vector<Body>& bodies, const std::vector<bool>& visible,
                          const Source& source, double tolerance) {
  for (size_t r = 0; r < bodies.size(); ++r) {
    if (!visible[r]) continue;
    if (source.half_tangent > 0 && outside_pyramid(bodies[r].corners, source.light_from_world,
                                                   source.half_tangent, source.half_tangent, 0.0))
      continue;
    for (size_t c = 0; c < bodies.size(); ++c) {
      if (c == r && bodies[c].planar) continue;  // a plane cannot shadow itself
      if (c == r || may_shadow(bodies[c], bodies[r], source, tolerance)) return true;
    }
  }
  return false;
}

}  // namespace

SceneFacts scene_facts(const Scene& scene, const Camera& camera, double aspect) {
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
  const double half_height = std::tan(0.5 * camera.fov_y);
  std::vector<bool> visible;
  for (const Body& body : bodies)
    visible.push_back(!outside_pyramid(body.corners, view, half_height * aspect, half_height, camera.near));
  for (const Light& light : scene.lights) {
    const bool moving = facts.casters_move || light.moving || camera.moving;  // somewhere on the way it may
    facts.light_moves.push_back(light.moving);
    facts.casts_visible_shadow.push_back(
        moving ||
        casts_visible_shadow(bodies, visible, source_of(light, origin), 1e-6 * scene.bounds.radius()));
    facts.light_size.push_back(shines_as_area(light) ? std::max(light.area->width, light.area->height) : 0.0);
  }
  return facts;
}

}  // namespace gnomon
