// Samples an area light as a point of the scene sees it.
#include "engine/truth/reference_light.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/area_light.h"

namespace gnomon {
namespace {

using Shape = AreaLight::Shape;

// Any axis perpendicular to a unit vector.
glm::dvec3 perpendicular(const glm::dvec3& n) {
  const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(n, axis));
}

// Where the ray from `from` towards `through` enters a sphere; its nearest point where rounding lets it miss.
glm::dvec3 sphere_entry(const glm::dvec3& from, const glm::dvec3& through, const glm::dvec3& centre,
                        double radius) {
  const glm::dvec3 direction = glm::normalize(through - from), to_centre = centre - from;
  const double along = glm::dot(direction, to_centre);
  const glm::dvec3 across = to_centre - along * direction;
  return from + (along - std::sqrt(std::max(0.0, radius * radius - glm::dot(across, across)))) * direction;
}

}  // namespace

std::optional<LightSample> AreaView::sample(const glm::dvec2& u) const {
  const bool round = area_->shape == Shape::disc || area_->shape == Shape::sphere;
  const glm::dvec2 s = round ? 0.5 * concentric_disc(u) : u - 0.5;
  const glm::dvec2 local = s * glm::dvec2(area_->width, area_->height);
  if (area_->shape == Shape::polygon && !on_light(*area_, local)) return std::nullopt;
  LightSample result{centre_ + s.x * edge_x_ + s.y * edge_y_};
  if (area_->shape == Shape::sphere)
    result.target = sphere_entry(receiver_, result.target, centre_, 0.5 * area_->width);
  if (area_->emission) result.weight = emission_weight(emission_at(*scene_, *area_, local));
  return result;
}

AreaSampler::AreaSampler(const Scene& scene, const Light& light, const ShadowTarget& centre) {
  view_.scene_ = &scene;
  view_.area_ = &*light.area;
  view_.centre_ = centre.value;
  view_.infinite_ = centre.infinite;
  view_.edge_x_ = light.area->width * glm::dvec3(light.world_from_light[0]);
  view_.edge_y_ = light.area->height * glm::dvec3(light.world_from_light[1]);
  if (light.area->shape == Shape::polygon)
    if (const std::string problem = outline_problem(light.area->outline); !problem.empty())
      fail("light '" + light.name + "': " + problem, scene.file.string());
}

AreaView AreaSampler::seen_from(const glm::dvec3& receiver) const {
  AreaView view = view_;
  view.receiver_ = receiver;
  if (view.area_->shape != Shape::sphere) return view;
  const double radius = 0.5 * view.area_->width;
  const glm::dvec3 to_centre = view.centre_ - receiver;
  const double distance = glm::length(to_centre);
  // With the cone's half angle a, sin a = radius / distance: the disc's radius is distance * tan a.
  const double tangent_length = std::sqrt(std::max(0.0, (distance - radius) * (distance + radius)));
  view.surrounds_ = !(tangent_length > 1e-6 * radius);
  if (view.surrounds_) return view;
  const glm::dvec3 axis = to_centre / distance;
  const double side = 2 * radius * distance / tangent_length;
  const glm::dvec3 x = perpendicular(axis);
  view.edge_x_ = side * x;
  view.edge_y_ = side * glm::cross(axis, x);
  return view;
}

}  // namespace gnomon
