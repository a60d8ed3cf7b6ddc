// How far a pixel is from a true shadow edge, on its own tangent plane and in shadow texels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/light/light_view.h"
#include "engine/scene/area_light.h"
#include "engine/truth/reference_tracer.h"

namespace gnomon {
namespace {

struct Plane {
  glm::dvec3 point{0}, normal{0};
};

// The faces of one light's map and where their texels meet a plane. Positions relative to the rays' origin.
class TexelGrid {
 public:
  TexelGrid(const std::vector<LightView>& faces, uint32_t light, uint32_t map_size, const glm::dvec3& origin)
      : map_size_(map_size) {
    for (const LightView& face : faces) {
      if (face.light != light) continue;
      // Rigid, so that the shift to the origin stays in double.
      glm::dmat4 from_origin = face.light_from_world;
      from_origin[3] = face.light_from_world * glm::dvec4(origin, 1.0);
      faces_.push_back({face, from_origin, glm::transpose(glm::dmat3(face.light_from_world))});
    }
  }
  bool empty() const { return faces_.empty(); }

  // The light-space frame of the face that sees `point`: for six faces the major axis decides.
  size_t face_of(const glm::dvec3& point) const {
    size_t best = 0;
    double depth = -1e300;
    for (size_t i = 0; i < faces_.size(); ++i) {
      const double z = -(faces_[i].from_origin * glm::dvec4(point, 1.0)).z;
      if (z > depth) depth = z, best = i;
    }
    return best;
  }

  // Where the ray of the map through `plane.point`, moved by (du, dv) texels, meets the plane; nothing when
  // it is parallel to it or meets it behind the light.
  std::optional<glm::dvec3> on_plane(size_t index, const Plane& plane, double du, double dv) const {
    const auto& [face, from_origin, to_origin] = faces_[index];
    const glm::dvec3 p(from_origin * glm::dvec4(plane.point, 1.0));
    const glm::dvec3 normal = glm::dmat3(from_origin) * plane.normal;
    const double step_x = 2 * face.half_width / map_size_, step_y = 2 * face.half_height / map_size_;
    glm::dvec3 q;
    if (face.orthographic) {
      if (std::abs(normal.z) < 1e-9) return std::nullopt;
      q = p + glm::dvec3(du * step_x, dv * step_y, 0);
      q.z -= (normal.x * du * step_x + normal.y * dv * step_y) / normal.z;
    } else {
      if (p.z >= 0) return std::nullopt;
      const glm::dvec3 direction(p.x / -p.z + du * step_x, p.y / -p.z + dv * step_y, -1);
      const double distance = glm::dot(normal, p) / glm::dot(normal, direction);
      // Beyond a thousandfold the plane is seen edge-on.
      if (!(distance > 0) || distance > -1e3 * p.z) return std::nullopt;
      q = distance * direction;
    }
    return plane.point + to_origin * (q - p);
  }

 private:
  struct Frame {
    LightView face;
    glm::dmat4 from_origin;
    glm::dmat3 to_origin;
  };
  std::vector<Frame> faces_;
  double map_size_;
};

// Offsets within a disc, nearest first, so that a near edge ends the search early.
std::vector<glm::dvec2> disc(double texels) {
  const double step = texels > 4 ? 1.0 : 0.5;
  const int n = static_cast<int>(std::floor(texels / step + 1e-9));
  std::vector<glm::dvec2> offsets;
  for (int y = -n; y <= n; ++y)
    for (int x = -n; x <= n; ++x)
      if (std::hypot(x, y) * step <= texels + 1e-9) offsets.emplace_back(x * step, y * step);
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const auto& a, const auto& b) { return glm::dot(a, a) < glm::dot(b, b); });
  return offsets;
}

// The light's centre, and points of the border of an area light that was traced as one.
std::vector<ShadowTarget> targets_of(const Light& light, const ShadowTarget& centre, bool area) {
  std::vector<ShadowTarget> targets{centre};
  if (!area) return targets;
  // The centre of a polygon may be outside of it.
  if (!on_light(*light.area, glm::dvec2(0.0))) targets.clear();
  const glm::dmat3 axes(light.world_from_light);
  for (const glm::dvec3& point : border_points(*light.area))
    targets.push_back({centre.value + axes * point, centre.infinite});
  return targets;
}

// A colour of light sources on a plane: all lit (1), all unlit (0) or mixed (-1).
int state_at(const RayScene& rays, const Plane& plane, const glm::dvec3& point,
             const std::vector<ShadowTarget>& targets, TriangleId self) {
  int state = -2;
  for (const ShadowTarget& target : targets) {
    const glm::dvec3 to_light = target.infinite ? target.value : target.value - point;
    const bool lit =
        glm::dot(plane.normal, to_light) > 0 && !rays.occluded(point, plane.normal, target, self);
    if (state != -2 && state != static_cast<int>(lit)) return -1;
    state = lit;
  }
  return state;
}

}  // namespace

std::vector<bool> ReferenceTracer::away_from_edges(const Reference& reference, uint32_t light,
                                                   const Camera& camera, const std::vector<uint32_t>& pixels,
                                                   double texels, uint32_t map_size) const {
  const Scene& scene = impl_->scene;
  const std::shared_ptr<const RayScene> traced = impl_->rays_of(camera);
  const RayScene& rays = *traced;
  if (light >= scene.lights.size() || light >= reference.lights)
    fail(fmt::format("no light {}: the scene has {}", light, scene.lights.size()), scene.file.string());
  if (map_size == 0 || !(texels >= 0))
    fail("distance to edges: the map's size and the distance must be positive");
  const SeenFrom seen{camera, static_cast<double>(reference.width) / reference.height};
  const TexelGrid grid(light_views(scene, map_size, 0, seen), light, map_size, rays.origin());
  if (grid.empty()) fail(fmt::format("light {} has no map face", light), scene.file.string());
  const glm::dvec3 eye = glm::dvec3(camera.world_from_camera[3]) - rays.origin();
  const auto offsets = disc(texels);
  const auto targets =
      targets_of(scene.lights[light], centre_of(scene.lights[light], rays),
                 is_area(scene.lights[light], reference.samples > 1 ? reference.samples : 0));

  const auto is_away = [&](uint32_t pixel) {
    const float value = reference.visibility[light].at(pixel);
    const uint8_t domain = reference.domain[light].at(pixel);
    const bool traced = domain == Reference::counted || domain == Reference::outside_light;
    if (!traced || (value != 0 && value != 1)) return false;
    const glm::dvec3 position = glm::dvec3(reference.position[pixel]);
    // The stored position is a float's: found again with the ray through it, which also tells the triangle.
    const auto hit = rays.first_hit(eye, position, 0.999);
    if (!hit || hit->distance > 1.001) return false;
    const Plane plane{hit->position, hit->normal};
    const size_t face = grid.face_of(plane.point);
    for (const glm::dvec2& offset : offsets) {
      const auto point = grid.on_plane(face, plane, offset.x, offset.y);
      if (!point || state_at(rays, plane, *point, targets, hit->triangle) != static_cast<int>(value))
        return false;
    }
    return true;
  };

  std::vector<char> away(pixels.size());  // not vector<bool>: threads write neighbours
  parallel_rows(static_cast<uint32_t>(pixels.size()), {},
                [&](uint32_t i) { away[i] = is_away(pixels[i]) ? 1 : 0; });
  return {away.begin(), away.end()};
}

}  // namespace gnomon
