// Area lights as shapes: which points lie on one, how brightly each part shines, and sample points on it.
// Pure.
//
// "Local" is the light's own frame: x and y in world units, the light's centre at 0. A sphere stands for the
// disc through its centre that faces -z; only the reference sees it as a body. A directional light's disc is
// at distance 1: its local points are what directions towards it differ by from the light's own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

// Outlines that cover less of the rectangle around them cannot be sampled by rejection in reasonable time.
inline constexpr double kLeastCoverage = 0.01;
inline constexpr size_t kMostCorners = 1024;

// What keeps an outline from being a polygon light: too few (3) or too many corners, numbers that are not
// finite, corners that coincide, edges that meet, coverage below kLeastCoverage of the rectangle that is
// centred on the light. Empty when it can be used.
std::string outline_problem(const std::vector<glm::dvec2>& outline);
// A polygon light; `outline` must have no problem. Width and height are those of the smallest rectangle
// centred on the light that holds it.
AreaLight polygon_light(std::vector<glm::dvec2> outline);

// Has the light a size, so that its shadows have penumbrae? A spot light with any shape, a point light with a
// sphere, a directional light with a disc.
bool has_size(const Light& light);
// Is it an area in a plane that does not depend on the receiver, so that its points are lights of their own?
// Spot lights with a size alone.
inline bool shines_as_area(const Light& light) { return light.area && light.type == LightType::spot; }

// The size of a directional light: the disc of an angular diameter, radians, in (0, pi).
AreaLight angular_disc(double diameter);
// Its inverse.
double angular_diameter(const AreaLight& disc);

// A point of the bounding rectangle. `u` in [0, 1] x [0, 1]; (0, 0) is the corner at -x, -y.
glm::dvec2 place_on(const AreaLight& area, const glm::dvec2& u);
// Is a local point on the light? Its border belongs to it, up to 1e-9 of its size.
bool on_light(const AreaLight& area, const glm::dvec2& local);
// Share of the bounding rectangle that is on the light, (0, 1].
double coverage(const AreaLight& area);

// Local points whose convex hull holds the whole light, a sphere's body too (x, y, z).
std::vector<glm::dvec3> enclosing_points(const AreaLight& area);
// Points of the light's border, local: corners, eight of a rim, or the six poles of a sphere.
std::vector<glm::dvec3> border_points(const AreaLight& area);

// Emission relative to the light's colour and intensity, linear RGB in [0, 1]; 1 for a light without a
// texture. The texture covers the bounding rectangle, column 0 at -x and row 0 at +y, filtered as it says
// (nearest or bilinear, in linear space), clamped at its borders; its alpha is ignored. Points outside count
// as the nearest on the border.
glm::dvec3 emission_at(const Scene& scene, const AreaLight& area, const glm::dvec2& local);
// Exact mean of emission_at() over the part of [min, max] on the bounding rectangle: the emission of a cell.
// Takes time proportional to the texels in it.
glm::dvec3 emission_in(const Scene& scene, const AreaLight& area, const glm::dvec2& min,
                       const glm::dvec2& max);
// The same over the whole light.
glm::dvec3 mean_emission(const Scene& scene, const AreaLight& area);
// Relative luminance (ITU-R BT.709): how much an emission counts in a visibility.
double emission_weight(const glm::dvec3& rgb);

enum class AreaPattern {
  sobol,         // Owen-scrambled Sobol points
  grid_centres,  // centres of k x k equal cells of the bounding rectangle
  grid_corners   // k x k points of a regular grid whose outer ones are on the bounding rectangle's border
};

// Sample points on the light, local. `sobol`: exactly `n`, the first of the sequence over the bounding
// rectangle that are on the light. Grids: row by row from -y, those of n = k x k points that are on the
// light, so that they may be fewer (a grid of one point is the centre). Deterministic; `seed` counts for
// `sobol` alone. Error when a grid's `n` is not a square, or the outline of a polygon has a problem.
std::vector<glm::dvec2> area_points(const AreaLight& area, uint32_t n, AreaPattern pattern,
                                    uint32_t seed = 0);

// The scene with every light's area `factor` times as wide and as high, a directional light's disc too; 0:
// all are points. Error when the factor is negative or not finite, or a light becomes larger than any number.
Scene with_light_scale(Scene scene, double factor);

// Maps [0, 1] x [0, 1] to the unit disc; keeps relative areas and neighbourhoods, so that a stratified set
// stays one (Shirley and Chiu 1997, "A low distortion map between disk and square").
glm::dvec2 concentric_disc(const glm::dvec2& u);

}  // namespace gnomon
