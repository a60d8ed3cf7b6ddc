// What a triangle of a scene looks like at a point: base colour, alpha and normal, on the CPU.
#include "engine/scene/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/image/srgb.h"

namespace gnomon {
namespace {

template <typename T>
T interpolate(const std::vector<T>& values, const Mesh& mesh, uint32_t triangle, const Barycentric& weights) {
  const uint32_t* index = &mesh.indices[3 * size_t{triangle}];
  return weights.x * values[index[0]] + weights.y * values[index[1]] + weights.z * values[index[2]];
}

uint32_t wrapped(int64_t i, uint32_t size, Wrap wrap) {
  const auto n = static_cast<int64_t>(size);
  const auto modulo = [i](int64_t m) { return ((i % m) + m) % m; };
  switch (wrap) {
    case Wrap::repeat:
      return static_cast<uint32_t>(modulo(n));
    case Wrap::mirror:
      return static_cast<uint32_t>(std::min(modulo(2 * n), 2 * n - 1 - modulo(2 * n)));
    default:
      return static_cast<uint32_t>(std::clamp<int64_t>(i, 0, n - 1));
  }
}

// In texels. In double, and reduced to one repetition first, so that large coordinates keep their fraction.
double texels(double c, Wrap wrap, uint32_t size) {
  if (!std::isfinite(c)) return 0.0;
  switch (wrap) {
    case Wrap::repeat:
      return (c - std::floor(c)) * size;
    case Wrap::mirror:
      return (c - 2.0 * std::floor(0.5 * c)) * size;
    default:
      return std::clamp(c, -1.0, 2.0) * size;
  }
}

// Filters fetch(x, y) at `uv`; texel centres are at half integers.
template <typename Fetch>
auto filter(const Texture& texture, const glm::vec2& uv, const Fetch& fetch) {
  const auto at = [&](int64_t x, int64_t y) {
    return fetch(wrapped(x, texture.width, texture.wrap_u), wrapped(y, texture.height, texture.wrap_v));
  };
  const double x = texels(uv.x, texture.wrap_u, texture.width);
  const double y = texels(uv.y, texture.wrap_v, texture.height);
  if (texture.nearest) return at(int64_t(std::floor(x)), int64_t(std::floor(y)));
  const double x0 = std::floor(x - 0.5), y0 = std::floor(y - 0.5);
  const auto fx = float(x - 0.5 - x0), fy = float(y - 0.5 - y0);
  const auto ix = int64_t(x0), iy = int64_t(y0);
  return (1 - fy) * ((1 - fx) * at(ix, iy) + fx * at(ix + 1, iy)) +
         fy * ((1 - fx) * at(ix, iy + 1) + fx * at(ix + 1, iy + 1));
}

glm::vec4 texture_color(const Texture& texture, const glm::vec2& uv) {
  return filter(texture, uv, [&](uint32_t x, uint32_t y) {
    const uint8_t* p = &texture.rgba[4 * (size_t{y} * texture.width + x)];
    return glm::vec4(srgb_decode(p[0]), srgb_decode(p[1]), srgb_decode(p[2]), p[3] / 255.0f);
  });
}

float texture_alpha(const Texture& texture, const glm::vec2& uv) {
  return filter(texture, uv, [&](uint32_t x, uint32_t y) {
    return texture.rgba[4 * (size_t{y} * texture.width + x) + 3] / 255.0f;
  });
}

}  // namespace

glm::vec4 base_color(const Scene& scene, const Mesh& mesh, uint32_t triangle, const Barycentric& weights) {
  const Material& material = scene.materials[mesh.material];
  glm::vec4 color = material.base_color;
  if (!mesh.colors.empty()) color *= interpolate(mesh.colors, mesh, triangle, weights);
  if (material.base_color_texture && !mesh.uvs.empty())
    color *= texture_color(scene.textures[*material.base_color_texture],
                           interpolate(mesh.uvs, mesh, triangle, weights));
  return color;
}

float base_alpha(const Scene& scene, const Mesh& mesh, uint32_t triangle, const Barycentric& weights) {
  const Material& material = scene.materials[mesh.material];
  float alpha = material.base_color.a;
  if (!mesh.colors.empty()) alpha *= interpolate(mesh.colors, mesh, triangle, weights).a;
  if (material.base_color_texture && !mesh.uvs.empty())
    alpha *= texture_alpha(scene.textures[*material.base_color_texture],
                           interpolate(mesh.uvs, mesh, triangle, weights));
  return alpha;
}

glm::vec3 interpolated_normal(const Mesh& mesh, uint32_t triangle, const Barycentric& weights,
                              const glm::dmat3& normal_matrix, const glm::dvec3& geometric) {
  if (mesh.normals.size() != mesh.positions.size()) return glm::vec3(geometric);
  const glm::dvec3 normal = normal_matrix * glm::dvec3(interpolate(mesh.normals, mesh, triangle, weights));
  const double length = glm::length(normal);
  return glm::vec3(length > 0 && std::isfinite(length) ? normal / length : geometric);
}

}  // namespace gnomon
