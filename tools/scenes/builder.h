// Builds a glTF 2.0 binary file in memory. Deterministic: positions, normals and coordinates are rounded to
// multiples of 2^-16, rotations and directions to 1e-9, so that last-bit differences between maths libraries
// do not show.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon::generate {

struct Shape {  // triangles, counter-clockwise in front; world or object units
  std::vector<glm::dvec3> positions, normals;
  std::vector<glm::dvec2> uvs;  // empty, or as many as positions
  std::vector<uint32_t> indices;

  uint32_t vertex(const glm::dvec3& position, const glm::dvec3& normal);
  void triangle(uint32_t a, uint32_t b, uint32_t c);
  // Flat, with vertices of its own; corners counter-clockwise.
  void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);
  void flat_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);
};

struct Surface {
  std::string name;
  glm::dvec3 color{0.8};  // linear
  bool double_sided = false;
  std::optional<double> alpha_cutoff;  // MASK
  std::optional<uint32_t> texture;
};

struct Placement {
  glm::dvec3 translation{0.0};
  glm::dmat3 rotation{1.0};
  glm::dvec3 scale{1.0};
};

struct Motion {          // key frames, interpolated linearly
  std::string property;  // of a node: translation, rotation or scale
  std::vector<double> times;
  std::vector<glm::dvec4> values;  // x, y, z, or a quaternion's x, y, z, w
};
// A rotation as Motion has it.
glm::dvec4 rotation_value(const glm::dmat3& rotation);
// The rotation that looks along -z in `direction`; `up` is y, or -z when looking straight up or down.
glm::dmat3 looking(const glm::dvec3& direction);

class Builder {
 public:
  explicit Builder(std::string name);
  ~Builder();

  // Clamped at its borders; bilinear, or nearest.
  uint32_t texture(const std::string& name, const std::string& png, bool nearest = false);
  uint32_t material(const Surface& surface);
  uint32_t mesh(const std::string& name, const Shape& shape, uint32_t material);
  void node(const std::string& name, uint32_t mesh, const Placement& placement = {});
  // One mesh at the origin.
  void add(const std::string& name, const Shape& shape, uint32_t material);
  // fov_y in degrees.
  void camera(const glm::dvec3& eye, const glm::dvec3& target, double fov_y, double near);
  // A spot light whose cone holds a square frustum of `map_fov` degrees; as bright as gives a white surface
  // facing it at the target the radiance `radiance`. Area light: a square of `side`, or 4 % of the distance.
  void spot(const glm::dvec3& eye, const glm::dvec3& target, double map_fov, double radiance = 0.7,
            double side = 0);
  // The same with a name and an area of any shape; `area.emission` is what texture() returned.
  void area_spot(const std::string& name, const glm::dvec3& eye, const glm::dvec3& target, double map_fov,
                 double radiance, const AreaLight& area);
  // `angular_diameter`: degrees; 0: a point infinitely far away.
  void sun(const glm::dvec3& direction, double radiance, double angular_diameter = 0);
  // A point light, a sphere of `radius`; a white surface facing it at `distance` has the radiance `radiance`.
  void lamp(const glm::dvec3& place, double distance, double radiance, double radius);
  // Animates the last node of that name.
  void move(const std::string& node, const Motion& motion);
  std::string glb() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::generate
