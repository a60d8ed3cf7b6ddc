// Shapes of area lights: areas, emission, and sample points on them.
#include "engine/scene/area_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/error.h"
#include "engine/base/sobol.h"
#include "engine/image/srgb.h"
#include "engine/scene/surface.h"

namespace gnomon {
namespace {

constexpr double kBorderTolerance = 1e-9;  // of the light's size

bool is_round(const AreaLight& area) {
  return area.shape == AreaLight::Shape::disc || area.shape == AreaLight::Shape::sphere;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// On which side of the line from a to b is p? Positive: left.
double side_of(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) { return cross(b - a, p - a); }

bool in_box(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
  return glm::all(glm::lessThanEqual(glm::min(a, b), p)) && glm::all(glm::lessThanEqual(p, glm::max(a, b)));
}

// Do two segments have a point in common?
bool segments_meet(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  const double sc = side_of(a, b, c), sd = side_of(a, b, d), sa = side_of(c, d, a), sb = side_of(c, d, b);
  if ((sc > 0) != (sd > 0) && (sa > 0) != (sb > 0) && sc != 0 && sd != 0 && sa != 0 && sb != 0) return true;
  return (sc == 0 && in_box(a, b, c)) || (sd == 0 && in_box(a, b, d)) || (sa == 0 && in_box(c, d, a)) ||
         (sb == 0 && in_box(c, d, b));
}

double polygon_area(const std::vector<glm::dvec2>& outline) {
  double twice = 0;
  for (size_t i = 1; i + 1 < outline.size(); ++i)
    twice += cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
  return 0.5 * std::abs(twice);
}

glm::dvec2 half_size(const std::vector<glm::dvec2>& outline) {
  glm::dvec2 half(0.0);
  for (const glm::dvec2& p : outline) half = glm::max(half, glm::abs(p));
  return half;
}

// Two edges that meet where they should not; empty when the outline is simple.
std::string crossing_edges(const std::vector<glm::dvec2>& outline) {
  const size_t n = outline.size();
  const auto corner = [&](size_t i) -> const glm::dvec2& { return outline[i % n]; };
  for (size_t i = 0; i < n; ++i) {
    const glm::dvec2 edge = corner(i + 1) - corner(i), next = corner(i + 2) - corner(i + 1);
    if (edge == glm::dvec2(0.0))
      return fmt::format("corners {} and {} of the outline coincide", i, (i + 1) % n);
    if (cross(edge, next) == 0 && glm::dot(edge, next) < 0)
      return fmt::format("the outline turns back on itself at corner {}", (i + 1) % n);
  }
  for (size_t i = 0; i < n; ++i)
    for (size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // neighbours
      if (segments_meet(corner(i), corner(i + 1), corner(j), corner(j + 1)))
        return fmt::format("edges {} and {} of the outline meet", i, j);
    }
  return {};
}

bool on_polygon(const AreaLight& area, const glm::dvec2& p) {
  const double tolerance = kBorderTolerance * std::max(area.width, area.height);
  bool inside = false;
  for (size_t i = 0, j = area.outline.size() - 1; i < area.outline.size(); j = i++) {
    const glm::dvec2 &a = area.outline[j], &b = area.outline[i];
    const glm::dvec2 edge = b - a;
    const double side = cross(edge, p - a), along = glm::dot(edge, p - a), squared = glm::dot(edge, edge);
    const double slack = kBorderTolerance * squared;
    if (side * side <= tolerance * tolerance * squared && along >= -slack && along <= squared + slack)
      return true;  // on the edge
    // Does the ray towards +x cross the edge?
    if ((a.y > p.y) != (b.y > p.y) && (side > 0) == (edge.y > 0)) inside = !inside;
  }
  return inside;
}

// Weights of a row's texels in its mean over [low, high], in texels (texel i covers [i, i + 1]). Texels -1
// and `size` may have a weight: they repeat the border.
class AxisMean {
 public:
  AxisMean(double low, double high, uint32_t size, bool nearest)
      : size_(static_cast<int>(size)), nearest_(nearest), point_(high - low < shortest) {
    const double middle = nearest ? 0.0 : 0.5;  // of a texel's footprint, after its left end
    low_ = low - middle, high_ = point_ ? low_ : high - middle;
    first = static_cast<int>(std::floor(low_));
    last = nearest ? static_cast<int>(std::floor(high_)) : static_cast<int>(std::floor(high_)) + 1;
  }
  int first = 0, last = 0;
  int texel(int i) const { return std::clamp(i, 0, size_ - 1); }
  double weight(int i) const {
    if (point_) return nearest_ ? 1.0 : std::max(0.0, 1.0 - std::abs(low_ - i));
    return (footprint(high_ - i) - footprint(low_ - i)) / (high_ - low_);
  }

 private:
  static constexpr double shortest = 1e-6;  // texels; shorter intervals are points

  // Integral of a texel's weight up to `t`: a box on [0, 1], or a tent on [-1, 1].
  double footprint(double t) const {
    if (nearest_) return std::clamp(t, 0.0, 1.0);
    if (t <= 0) return 0.5 * std::pow(std::max(0.0, 1.0 + t), 2);
    return 1.0 - 0.5 * std::pow(std::max(0.0, 1.0 - t), 2);
  }

  int size_ = 1;
  bool nearest_ = false, point_ = false;
  double low_ = 0, high_ = 0;
};

glm::dvec3 texture_mean(const Texture& texture, const AxisMean& x, const AxisMean& y) {
  glm::dvec3 sum(0.0);
  for (int j = y.first; j <= y.last; ++j) {
    const uint8_t* row = &texture.rgba[4 * size_t{texture.width} * static_cast<size_t>(y.texel(j))];
    glm::dvec3 of_row(0.0);
    for (int i = x.first; i <= x.last; ++i) {
      const uint8_t* p = row + 4 * static_cast<size_t>(x.texel(i));
      of_row += x.weight(i) * glm::dvec3(srgb_decode(p[0]), srgb_decode(p[1]), srgb_decode(p[2]));
    }
    sum += y.weight(j) * of_row;
  }
  return sum;
}

uint32_t grid_side(uint32_t n) {
  const auto side = static_cast<uint32_t>(std::lround(std::sqrt(static_cast<double>(n))));
  if (uint64_t{side} * side != n)
    fail(fmt::format("{} points are no square grid", n), {}, {}, "a square number: 1, 4, 9, 16, ...");
  return side;
}

std::vector<glm::dvec2> grid_points(const AreaLight& area, uint32_t n, bool corners) {
  const uint32_t side = grid_side(n);
  const auto coordinate = [&](uint32_t i) {
    return corners && side > 1 ? double(i) / (side - 1) : (i + 0.5) / side;
  };
  std::vector<glm::dvec2> points;
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const glm::dvec2 p = place_on(area, {coordinate(x), coordinate(y)});
      if (on_light(area, p)) points.push_back(p);
    }
  return points;
}

std::vector<glm::dvec2> sobol_points(const AreaLight& area, uint32_t n, uint32_t seed) {
  if (area.shape == AreaLight::Shape::polygon)  // or the search might never end
    if (const std::string problem = outline_problem(area.outline); !problem.empty()) fail(problem);
  const SobolPoints sobol(n);
  std::vector<glm::dvec2> points;
  for (uint32_t i = 0; points.size() < n; ++i) {
    const glm::dvec2 p = place_on(area, sobol.scrambled(i, seed));
    if (on_light(area, p)) points.push_back(p);
  }
  return points;
}

}  // namespace

std::string outline_problem(const std::vector<glm::dvec2>& outline) {
  if (outline.size() < 3) return fmt::format("an outline of {} corners: 3 are the least", outline.size());
  if (outline.size() > kMostCorners)
    return fmt::format("an outline of {} corners: {} are the most", outline.size(), kMostCorners);
  for (const glm::dvec2& p : outline)
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return "the outline is not finite";
  if (std::string crossing = crossing_edges(outline); !crossing.empty()) return crossing;
  const double share = coverage(polygon_light(outline));
  if (!(share >= kLeastCoverage))
    return fmt::format(
        "the outline covers {:.2g} of the rectangle around it, centred on the light: {} is the least",
        std::isfinite(share) ? share : 0.0, kLeastCoverage);
  return {};
}

AreaLight polygon_light(std::vector<glm::dvec2> outline) {
  const glm::dvec2 half = half_size(outline);
  return {AreaLight::Shape::polygon, 2 * half.x, 2 * half.y, std::move(outline), {}};
}

bool has_size(const Light& light) {
  if (!light.area) return false;
  switch (light.type) {
    case LightType::spot:
      return true;
    case LightType::point:
      return light.area->shape == AreaLight::Shape::sphere;
    case LightType::directional:
      return light.area->shape == AreaLight::Shape::disc;
  }
  return false;
}

AreaLight angular_disc(double diameter) {
  const double side = 2 * std::tan(0.5 * diameter);
  return {AreaLight::Shape::disc, side, side, {}, {}};
}

double angular_diameter(const AreaLight& disc) { return 2 * std::atan(0.5 * disc.width); }

glm::dvec2 place_on(const AreaLight& area, const glm::dvec2& u) {
  return (u - 0.5) * glm::dvec2(area.width, area.height);
}

bool on_light(const AreaLight& area, const glm::dvec2& local) {
  const glm::dvec2 half = 0.5 * glm::dvec2(area.width, area.height);
  if (is_round(area)) return glm::length(local / half) <= 1 + kBorderTolerance;
  if (glm::any(glm::greaterThan(glm::abs(local), half * (1 + kBorderTolerance)))) return false;
  return area.shape == AreaLight::Shape::rectangle || on_polygon(area, local);
}

double coverage(const AreaLight& area) {
  if (area.shape == AreaLight::Shape::rectangle) return 1;
  if (is_round(area)) return 0.25 * std::numbers::pi;
  return polygon_area(area.outline) / (area.width * area.height);
}

std::vector<glm::dvec3> enclosing_points(const AreaLight& area) {
  std::vector<glm::dvec3> points;
  if (area.shape == AreaLight::Shape::polygon) {
    for (const glm::dvec2& p : area.outline) points.emplace_back(p, 0.0);
    return points;
  }
  const double x = 0.5 * area.width, y = 0.5 * area.height;
  const bool body = area.shape == AreaLight::Shape::sphere;
  for (const double z : {body ? x : 0.0, -x}) {
    for (const glm::dvec2& p : {glm::dvec2(x, y), glm::dvec2(x, -y), glm::dvec2(-x, y), glm::dvec2(-x, -y)})
      points.emplace_back(p, z);
    if (!body) break;
  }
  return points;
}

std::vector<glm::dvec3> border_points(const AreaLight& area) {
  const double x = 0.5 * area.width, y = 0.5 * area.height;
  if (area.shape == AreaLight::Shape::sphere)
    return {{x, 0, 0}, {-x, 0, 0}, {0, y, 0}, {0, -y, 0}, {0, 0, x}, {0, 0, -x}};
  if (area.shape != AreaLight::Shape::disc) return enclosing_points(area);
  const double diagonal = std::sqrt(0.5);
  std::vector<glm::dvec3> points = {{x, 0, 0}, {-x, 0, 0}, {0, y, 0}, {0, -y, 0}};
  for (const glm::dvec2& p : {glm::dvec2(x, y), glm::dvec2(x, -y), glm::dvec2(-x, y), glm::dvec2(-x, -y)})
    points.emplace_back(diagonal * p, 0.0);
  return points;
}

glm::dvec3 emission_at(const Scene& scene, const AreaLight& area, const glm::dvec2& local) {
  return emission_in(scene, area, local, local);
}

glm::dvec3 emission_in(const Scene& scene, const AreaLight& area, const glm::dvec2& min,
                       const glm::dvec2& max) {
  if (!area.emission) return glm::dvec3(1.0);
  const Texture& texture = scene.textures.at(*area.emission);
  const glm::dvec2 size(area.width, area.height), texels(texture.width, texture.height);
  const auto column = [&](double x) { return std::clamp(x / size.x + 0.5, 0.0, 1.0) * texels.x; };
  const auto row = [&](double y) { return std::clamp(0.5 - y / size.y, 0.0, 1.0) * texels.y; };
  return texture_mean(texture, AxisMean(column(min.x), column(max.x), texture.width, texture.nearest),
                      AxisMean(row(max.y), row(min.y), texture.height, texture.nearest));
}

glm::dvec3 mean_emission(const Scene& scene, const AreaLight& area) {
  const glm::dvec2 half = 0.5 * glm::dvec2(area.width, area.height);
  return emission_in(scene, area, -half, half);
}

double emission_weight(const glm::dvec3& rgb) { return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b; }

std::vector<glm::dvec2> area_points(const AreaLight& area, uint32_t n, AreaPattern pattern, uint32_t seed) {
  if (n == 0) return {};
  if (pattern == AreaPattern::sobol) return sobol_points(area, n, seed);
  return grid_points(area, n, pattern == AreaPattern::grid_corners);
}

Scene with_light_scale(Scene scene, double factor) {
  if (!(factor >= 0 && std::isfinite(factor)))
    fail(fmt::format("light scale {:g}: must be a finite number, at least 0", factor), scene.file.string());
  if (factor == 1) return scene;
  for (Light& light : scene.lights) {
    if (!light.area) continue;
    AreaLight& area = *light.area;
    area.width *= factor, area.height *= factor;
    for (glm::dvec2& corner : area.outline) corner *= factor;
    if (!std::isfinite(area.width) || !std::isfinite(area.height))
      fail(fmt::format("light scale {:g} makes light '{}' infinite", factor, light.name),
           scene.file.string());
    if (area.width == 0 || area.height == 0) light.area.reset();
  }
  return scene;
}

glm::dvec2 concentric_disc(const glm::dvec2& u) {
  const glm::dvec2 a = 2.0 * u - 1.0;
  if (a == glm::dvec2(0.0)) return a;
  constexpr double quarter = 0.25 * std::numbers::pi;
  const bool by_x = std::abs(a.x) > std::abs(a.y);
  const double radius = by_x ? a.x : a.y;
  const double angle = by_x ? quarter * (a.y / a.x) : 2 * quarter - quarter * (a.x / a.y);
  return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

}  // namespace gnomon
