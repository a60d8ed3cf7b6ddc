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

class Builder {
 public:
  explicit Builder(std::string name);
  ~Builder();

  uint32_t texture(const std::string& name, const std::string& png);
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
  void sun(const glm::dvec3& direction, double radiance);
  std::string glb() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::generate
