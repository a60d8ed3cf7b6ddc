// Shapes for the generated scenes. Closed ones are watertight: shared edges have exactly equal end points.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

#include "tools/scenes/builder.h"

namespace gnomon::generate {

// Deterministic random numbers (PCG-XSH-RR, O'Neill 2014), the same on every platform.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed * 2 + 1) { next(); }
  uint32_t next();
  double in(double low, double high);

 private:
  uint64_t state_;
};

// z is drawn first, x last. Arguments of a function are evaluated in an order that compilers choose: what is
// drawn is always named first.
glm::dvec3 in_box(Random& random, const glm::dvec3& low, const glm::dvec3& high);

glm::dmat3 turn(double angle, const glm::dvec3& axis);  // degrees

void add_box(Shape& shape, const glm::dvec3& centre, const glm::dvec3& half,
             const glm::dmat3& rotation = glm::dmat3(1.0));
// Closed; tapered when the radii differ.
void add_cylinder(Shape& shape, const glm::dvec3& base, const glm::dvec3& top, double base_radius,
                  double top_radius, int sides);
// A subdivided icosahedron: 20 * 4^levels faces, vertices on the sphere, closed.
void add_sphere(Shape& shape, const glm::dvec3& centre, const glm::dvec3& radii, int levels);
// The rectangle [-half, half] of the plane y = `height`, facing up, `cells` squares a side.
void add_ground(Shape& shape, const glm::dvec2& half, double height, int cells = 1);

using Patch = std::function<glm::dvec3(double, double)>;  // (u, v) in [0, 1] x [0, 1]
// n x m cells of a patch, smooth normals to the side that du x dv points to; open.
void add_patch(Shape& shape, const Patch& patch, int n, int m);

struct Lattice {
  int n = 8, m = 8;  // cells in u and v
  bool closed_u = false, closed_v = false;
  double thickness = 0.2;
  double hole = 0.3;  // a cell's rim on each side of its hole, as a share of the cell
};
// A shell of the given thickness about a patch with one rectangular hole per cell; closed.
void add_lattice(Shape& shape, const Patch& patch, const Lattice& lattice);

// A profile in x and y, extruded from z = -half_depth to half_depth: between the lower and the upper line,
// given at the same xs (increasing); closed.
void add_extruded_strip(Shape& shape, const std::vector<double>& xs, const std::vector<double>& lower,
                        const std::vector<double>& upper, double half_depth, const Placement& placement);

}  // namespace gnomon::generate
