// Finds out whether far triangles cast shadows on far triangles.
#include "engine/light/casts_beyond.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/light/caster_culling.h"
#include "engine/scene/area_light.h"

namespace gnomon {
namespace {

constexpr size_t kMostTriangles = 1 << 16;
constexpr size_t kMostPairs = 1 << 26;  // a tenth of a second
// Sine of the angle that two triangles may overlap by, as the light sees them, and still only touch: vertices
// are floats.
constexpr double kTouching = 1e-6;
constexpr double kViewMargin = 1.01;  // of what the camera sees, for filters that look beyond the image

using Polygon = std::vector<glm::dvec3>;

// A convex polygon as the light sees it: directions, or places on a plane across the light's way as (x, y,
// 1).
struct Outline {
  Polygon corners;
  glm::dvec3 axis{0.0};  // of a cone around it
  double cosine = -1;    // of its half angle; -1: it may be anywhere
  double sine = 0;
};

Outline outline_of(Polygon corners) {
  Outline outline{std::move(corners), glm::dvec3(0.0), -1, 0};
  for (glm::dvec3& p : outline.corners) {
    const double length = glm::length(p);
    if (length > 0) p /= length;
    outline.axis += p;
  }
  const double length = glm::length(outline.axis);
  if (!(length > 1e-3)) return outline;
  outline.axis /= length;
  double cosine = 1;
  for (const glm::dvec3& p : outline.corners) cosine = std::min(cosine, glm::dot(outline.axis, p));
  if (cosine <= 0) return outline;  // wider than half of all directions: corners do not bound it
  outline.cosine = cosine, outline.sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)) + kTouching;
  return outline;
}

bool apart(const Outline& a, const Outline& b) {
  if (a.cosine < 0 || b.cosine < 0) return false;
  return glm::dot(a.axis, b.axis) < a.cosine * b.cosine - a.sine * b.sine;
}

// Is one of `a`'s edges between the two? An outline that is seen edge-on hides nothing.
bool edge_between(const Outline& a, const Outline& b) {
  const size_t count = a.corners.size();
  for (size_t i = 0; i < count; ++i) {
    glm::dvec3 normal = glm::cross(a.corners[i], a.corners[(i + 1) % count]);
    const double length = glm::length(normal);
    if (!(length > 0)) continue;
    normal /= length;
    double own = 0;  // furthest corner of `a` from the edge
    for (const glm::dvec3& p : a.corners)
      if (const double side = glm::dot(normal, p); std::abs(side) > std::abs(own)) own = side;
    if (std::abs(own) <= kTouching) return true;
    const bool beyond = std::all_of(b.corners.begin(), b.corners.end(), [&](const glm::dvec3& p) {
      return (own > 0 ? 1.0 : -1.0) * glm::dot(normal, p) <= kTouching;
    });
    if (beyond) return true;
  }
  return false;
}

struct Far {                            // a triangle beyond the reach
  std::array<glm::dvec3, 3> corners{};  // in the light's frame
  Outline outline;
  Polygon seen;  // the part of it that the camera sees, in the light's frame; empty: none
};

// A half space dot(normal, p) + offset >= 0.
struct Plane {
  glm::dvec3 normal;
  double offset;
};

// Sutherland and Hodgman 1974.
Polygon clipped(const Polygon& polygon, const Plane& plane) {
  Polygon result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = glm::dot(plane.normal, a) + plane.offset, db = glm::dot(plane.normal, b) + plane.offset;
    if (da >= 0) result.push_back(a);
    if ((da >= 0) != (db >= 0)) result.push_back(a + (b - a) * (da / (da - db)));
  }
  return result;
}

// What a camera sees, in its own frame.
std::vector<Plane> planes_of(const SeenFrom& seen) {
  const glm::dvec2 half = kViewMargin * half_extent(seen.camera, seen.aspect);
  std::vector<Plane> planes{{{0, 0, -1}, -seen.camera.near}};
  if (seen.camera.far) planes.push_back({{0, 0, 1}, *seen.camera.far});
  for (const double side : {-1.0, 1.0}) {
    if (seen.camera.span) {
      planes.push_back({{side, 0, 0}, half.x});
      planes.push_back({{0, side, 0}, half.y});
    } else {
      planes.push_back({{side, 0, -half.x}, 0});
      planes.push_back({{0, side, -half.y}, 0});
    }
  }
  return planes;
}

class FarTriangles {
 public:
  FarTriangles(const Scene& scene, const Light& light, const glm::dvec3& middle, double reach,
               const SeenFrom& seen)
      : scene_(scene), seen_(seen), reach_(reach), planes_(planes_of(seen)) {
    directional_ = light.type == LightType::directional;
    glm::dmat4 axes = light.world_from_light;
    if (directional_) axes[3] = glm::dvec4(middle, 1.0);
    light_from_world_ = glm::inverse(axes);
    camera_from_light_ = glm::inverse(seen.camera.world_from_camera) * axes;
    light_from_camera_ = glm::inverse(camera_from_light_);
  }

  // False when there are too many.
  bool collect() {
    for (const Instance& instance : scene_.instances) {
      if (!instance.visible) continue;
      const auto box = box_corners(scene_, instance, glm::dvec3(0.0));
      const bool beyond = std::any_of(box.begin(), box.end(), [&](const glm::dvec3& p) {
        return is_far(glm::dvec3(light_from_world_ * glm::dvec4(p, 1.0)));
      });
      if (beyond && !add(instance)) return false;
    }
    return true;
  }

  // As a point of the light sees them, in the light's frame.
  bool some_casts(const glm::dvec3& from) {
    size_t receivers = 0;
    for (Far& far : triangles_) {
      far.outline = outline({far.corners.begin(), far.corners.end()}, from);
      receivers += far.seen.empty() ? 0 : 1;
    }
    if (receivers * triangles_.size() > kMostPairs) return true;
    for (const Far& receiver : triangles_) {
      if (receiver.seen.empty()) continue;
      const Outline seen = outline(receiver.seen, from);
      for (const Far& caster : triangles_)
        if (&caster != &receiver && !apart(caster.outline, seen) && !edge_between(caster.outline, seen) &&
            !edge_between(seen, caster.outline) && !behind(caster, receiver, from))
          return true;
    }
    return false;
  }

 private:
  bool is_far(const glm::dvec3& p) const {
    return std::max(std::max(std::abs(p.x), std::abs(p.y)), std::abs(p.z)) > reach_;
  }

  bool add(const Instance& instance) {
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const glm::dmat4 light_from_object = light_from_world_ * instance.world_from_object;
    const double winding = glm::determinant(glm::dmat3(instance.world_from_object)) < 0 ? -1 : 1;
    const bool both_sides = scene_.materials[mesh.material].double_sided;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Far far;
      for (size_t k = 0; k < 3; ++k)
        far.corners[k] =
            glm::dvec3(light_from_object * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[i + k]]), 1.0));
      if (std::none_of(far.corners.begin(), far.corners.end(), [&](const auto& p) { return is_far(p); }))
        continue;
      if (triangles_.size() == kMostTriangles) return false;
      far.seen = seen_part(far.corners, both_sides ? 0 : winding);
      triangles_.push_back(std::move(far));
    }
    return true;
  }

  // `front`: 1 where its winding shows the front, -1 of a mirrored instance, 0 where both sides are seen.
  Polygon seen_part(const std::array<glm::dvec3, 3>& corners, double front) const {
    Polygon polygon(corners.begin(), corners.end());
    if (seen_.camera.moving || scene_.animation != nullptr) return polygon;
    for (glm::dvec3& p : polygon) p = glm::dvec3(camera_from_light_ * glm::dvec4(p, 1.0));
    const glm::dvec3 normal = glm::cross(polygon[1] - polygon[0], polygon[2] - polygon[0]);
    const glm::dvec3 to_eye = seen_.camera.span ? glm::dvec3(0, 0, 1) : -polygon[0];
    if (front * glm::dot(normal, to_eye) < 0) return {};
    for (const Plane& plane : planes_) polygon = clipped(polygon, plane);
    for (glm::dvec3& p : polygon) p = glm::dvec3(light_from_camera_ * glm::dvec4(p, 1.0));
    return polygon;
  }

  Outline outline(Polygon polygon, const glm::dvec3& from) const {
    for (glm::dvec3& p : polygon) p = directional_ ? glm::dvec3(p.x, p.y, reach_) : p - from;
    return outline_of(std::move(polygon));
  }

  // All of the caster is on the side of the receiver's plane that is away from the light.
  bool behind(const Far& caster, const Far& receiver, const glm::dvec3& from) const {
    const auto& r = receiver.corners;
    glm::dvec3 normal = glm::cross(r[1] - r[0], r[2] - r[0]);
    const double length = glm::length(normal);
    if (!(length > 0)) return true;
    normal /= length;
    const glm::dvec3 to_light = directional_ ? glm::dvec3(0, 0, 1) : from - r[0];
    if (glm::dot(normal, to_light) < 0) normal = -normal;
    return std::all_of(caster.corners.begin(), caster.corners.end(), [&](const glm::dvec3& p) {
      return glm::dot(normal, p - r[0]) <= kTouching * glm::length(p - r[0]);
    });
  }

  const Scene& scene_;
  const SeenFrom& seen_;
  double reach_;
  std::vector<Plane> planes_;
  bool directional_ = false;
  glm::dmat4 light_from_world_{1.0}, camera_from_light_{1.0}, light_from_camera_{1.0};
  std::vector<Far> triangles_;
};

}  // namespace

bool casts_beyond(const Scene& scene, const Light& light, const glm::dvec3& middle, double reach,
                  const SeenFrom& seen) {
  FarTriangles far(scene, light, middle, reach, seen);
  if (!far.collect() || far.some_casts(glm::dvec3(0.0))) return true;
  if (light.type == LightType::directional || !has_size(light)) return false;
  const std::vector<glm::dvec3> border = border_points(*light.area);
  return std::any_of(border.begin(), border.end(), [&](const glm::dvec3& p) { return far.some_casts(p); });
}

}  // namespace gnomon
