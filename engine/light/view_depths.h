// How far from a light the scene's vertices are: what its views are fitted to.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/light/light_view.h"
#include "engine/scene/scene.h"

namespace gnomon {

// Bounds of vertices, kept apart by their distance from the middle, so that what is far off can be left out.
class Shells {
 public:
  void add(double distance, const glm::dvec3& p);
  void add(const Shells& other);
  Bounds all() const;
  // Distances that no vertex is near: between one, and the next one at least `ratio` times as far. Nearest
  // first.
  std::vector<double> gaps(double ratio) const;

 private:
  struct Shell {  // distances from a power of two to the next
    double nearest = 1e300, farthest = -1e300;
    Bounds box;
  };
  std::vector<Shell> shells_;  // by exponent; empty: no vertex
};

// Which instances are measured: all, those that stand still, or those that move.
enum class Which { all, still, moving };

// What counts.
struct Measured {
  Which which = Which::all;
  // Of directional lights: what distances are from, along the light's axes, the largest of the three.
  glm::dvec3 middle{0.0};                                  // world
  double reach = std::numeric_limits<double>::infinity();  // no vertex that is further off
  double size = 1;  // of the scene, world units: nothing much smaller is told apart
};

// Radius of the scene's bounds; 1 where there is none.
double scene_size(const Scene& scene);
// Depths along a perspective view's axis of all that its frustum holds, each as (d, d, d): triangles are
// clipped to it. `from`: nothing nearer to the view's apex counts.
Shells depths_inside(const Scene& scene, const LightView& view, const Measured& measured, double from = 0);
// Vertices along axes at some place in the world.
Shells box_along(const Scene& scene, const glm::dmat4& axes, const Measured& measured);

}  // namespace gnomon
