// Repairs triangle meshes: drops bad triangles and unused vertices, mends normals.
#include "engine/scene/mesh_clean.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace gnomon {
namespace {

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Twice the area, along the face's normal.
glm::dvec3 face_vector(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
}

bool has_area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 ab = glm::dvec3(b) - glm::dvec3(a), bc = glm::dvec3(c) - glm::dvec3(b),
                   ca = glm::dvec3(a) - glm::dvec3(c);
  const double longest = std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
  // Scaled before the cross product, so that no size under- or overflows.
  if (!(longest > 0)) return false;
  const double scale = 1.0 / std::sqrt(longest);
  return glm::length(glm::cross(ab * scale, ca * scale)) > 1e-10;
}

template <typename T>
void keep(std::vector<T>& values, const std::vector<uint32_t>& kept) {
  if (values.empty()) return;
  for (size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
  values.resize(kept.size());
}

// `origins`: may be null.
void drop_unused_vertices(Mesh& mesh, std::vector<uint32_t>* origins) {
  std::vector<uint32_t> place(mesh.positions.size(), 0), kept;
  for (const uint32_t i : mesh.indices) place[i] = 1;
  for (uint32_t i = 0; i < place.size(); ++i) {
    if (place[i] == 0) continue;
    place[i] = static_cast<uint32_t>(kept.size());
    kept.push_back(i);
  }
  if (kept.size() == mesh.positions.size()) return;
  for (uint32_t& i : mesh.indices) i = place[i];
  keep(mesh.positions, kept);
  keep(mesh.normals, kept);
  keep(mesh.uvs, kept);
  keep(mesh.colors, kept);
  if (origins != nullptr) keep(*origins, kept);
}

auto key(const glm::vec3& p) { return std::make_tuple(p.x, p.y, p.z); }

// For each vertex the number of its position; equal positions share one.
std::vector<uint32_t> weld(const std::vector<glm::vec3>& positions) {
  std::vector<uint32_t> order(positions.size()), id(positions.size(), 0);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return key(positions[a]) < key(positions[b]); });
  uint32_t next = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && positions[order[i]] != positions[order[i - 1]]) ++next;
    id[order[i]] = next;
  }
  return id;
}

// Moeller and Trumbore 1997, one-sided in t; the ray's direction is fixed and matches no axis.
bool crosses(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a, const glm::dvec3& b,
             const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0.0) return false;
  const glm::dvec3 s = origin - a, q = glm::cross(s, ab);
  const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && glm::dot(ac, q) / determinant > 0;
}

template <typename T>
std::vector<T> split(const std::vector<T>& values, const std::vector<uint32_t>& indices) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(indices.size());
  for (const uint32_t i : indices) result.push_back(values[i]);
  return result;
}

DroppedTriangles drop_triangles(Mesh& mesh, std::vector<uint32_t>* origins) {
  DroppedTriangles dropped;
  size_t out = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const glm::vec3 &pa = mesh.positions[a], &pb = mesh.positions[b], &pc = mesh.positions[c];
    if (!is_finite(pa) || !is_finite(pb) || !is_finite(pc)) {
      ++dropped.nonfinite;
    } else if (origins != nullptr ? a == b || b == c || c == a : !has_area(pa, pb, pc)) {
      ++dropped.degenerate;
    } else {
      mesh.indices[out] = a, mesh.indices[out + 1] = b, mesh.indices[out + 2] = c;
      out += 3;
    }
  }
  mesh.indices.resize(out);
  drop_unused_vertices(mesh, origins);
  return dropped;
}

}  // namespace

DroppedTriangles drop_bad_triangles(Mesh& mesh) { return drop_triangles(mesh, nullptr); }

DroppedTriangles drop_bad_triangles(Mesh& mesh, std::vector<uint32_t>& origins) {
  origins.resize(mesh.positions.size());
  std::iota(origins.begin(), origins.end(), 0u);
  return drop_triangles(mesh, &origins);
}

void make_flat_normals(Mesh& mesh) {
  mesh.positions = split(mesh.positions, mesh.indices);
  mesh.uvs = split(mesh.uvs, mesh.indices);
  mesh.colors = split(mesh.colors, mesh.indices);
  std::iota(mesh.indices.begin(), mesh.indices.end(), 0u);
  mesh.normals.resize(mesh.positions.size());
  for (size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
    const glm::dvec3 n = face_vector(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]);
    const bool area = glm::dot(n, n) > 0;  // always, but for a shape that changes
    std::fill_n(mesh.normals.begin() + static_cast<std::ptrdiff_t>(i), 3,
                area ? glm::vec3(glm::normalize(n)) : glm::vec3(0, 1, 0));
  }
}

void make_flat_normals(Mesh& mesh, std::vector<uint32_t>& origins) {
  origins = split(origins, mesh.indices);
  make_flat_normals(mesh);
}

void repair_normals(Mesh& mesh) {
  const auto bad = [](const glm::vec3& n) {
    return !is_finite(n) || !(glm::dot(glm::dvec3(n), glm::dvec3(n)) > 1e-30);
  };
  if (std::any_of(mesh.normals.begin(), mesh.normals.end(), bad)) {
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const uint32_t* v = &mesh.indices[i];
      const glm::dvec3 n = face_vector(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]);
      for (int k = 0; k < 3; ++k) sums[v[k]] += n;
    }
    for (size_t i = 0; i < sums.size(); ++i) {
      if (!bad(mesh.normals[i])) continue;
      const double length = glm::length(sums[i]);
      mesh.normals[i] =
          length > 0 && std::isfinite(length) ? glm::vec3(sums[i] / length) : glm::vec3(0, 1, 0);
    }
  }
  for (glm::vec3& n : mesh.normals) n = glm::vec3(glm::normalize(glm::dvec3(n)));
}

void finish_mesh(Mesh& mesh) {
  mesh.bounds = {};
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(glm::dvec3(p));
  mesh.watertight = is_watertight(mesh.positions, mesh.indices);
}

bool is_watertight(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
  if (indices.empty()) return false;
  const std::vector<uint32_t> id = weld(positions);
  struct HalfEdge {
    uint64_t edge;
    bool forward;
    bool operator<(const HalfEdge& other) const {
      return std::tie(edge, forward) < std::tie(other.edge, other.forward);
    }
  };
  std::vector<HalfEdge> edges;
  edges.reserve(indices.size());
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t a = id[indices[i + k]], b = id[indices[i + (k + 1) % 3]];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  if (edges.size() % 2 != 0) return false;
  for (size_t i = 0; i < edges.size(); i += 2) {
    const bool pair = edges[i].edge == edges[i + 1].edge && edges[i].forward != edges[i + 1].forward;
    const bool more = i + 2 < edges.size() && edges[i + 2].edge == edges[i].edge;
    if (!pair || more) return false;
  }
  return true;
}

uint64_t count_duplicate_vertices(const Mesh& mesh) {
  const auto whole = [&](uint32_t i) {
    const glm::vec3 &p = mesh.positions[i], &n = mesh.normals[i];
    const glm::vec2& t = mesh.uvs[i];
    const glm::vec4 c = mesh.colors.empty() ? glm::vec4(0.0f) : mesh.colors[i];
    return std::make_tuple(p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y, c.x, c.y, c.z, c.w);
  };
  const std::vector<uint32_t> id = weld(mesh.positions);
  std::vector<uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return id[a] != id[b] ? id[a] < id[b] : whole(a) < whole(b); });
  uint64_t count = 0;
  for (size_t i = 1; i < order.size(); ++i)
    count += id[order[i]] == id[order[i - 1]] && whole(order[i]) == whole(order[i - 1]);
  return count;
}

bool is_planar(const Mesh& mesh, glm::dvec3& point, glm::dvec3& normal) {
  if (mesh.indices.size() < 3) return false;
  glm::dvec3 best(0.0);  // the largest face gives the steadiest plane
  for (size_t i = 0; i + 2 < mesh.indices.size() && i < 300; i += 3) {
    const glm::dvec3 n = face_vector(mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                                     mesh.positions[mesh.indices[i + 2]]);
    if (glm::dot(n, n) > glm::dot(best, best)) best = n, point = glm::dvec3(mesh.positions[mesh.indices[i]]);
  }
  if (!(glm::length(best) > 0)) return false;
  normal = glm::normalize(best);
  const double limit = 1e-6 * 2.0 * mesh.bounds.radius();
  for (const glm::vec3& p : mesh.positions)
    if (std::abs(glm::dot(glm::dvec3(p) - point, normal)) > limit) return false;
  return true;
}

bool is_inside(const Mesh& mesh, const glm::dvec3& point) {
  if (glm::any(glm::lessThan(point, mesh.bounds.min)) || glm::any(glm::greaterThan(point, mesh.bounds.max)))
    return false;
  const glm::dvec3 direction(0.5377, 0.7713, 0.3401);
  size_t crossings = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    crossings += crosses(point, direction, glm::dvec3(mesh.positions[mesh.indices[i]]),
                         glm::dvec3(mesh.positions[mesh.indices[i + 1]]),
                         glm::dvec3(mesh.positions[mesh.indices[i + 2]]));
  return crossings % 2 == 1;
}

Mesh mirrored(const Mesh& mesh) {
  Mesh result = mesh;
  for (glm::vec3& p : result.positions) p.x = -p.x;
  for (glm::vec3& n : result.normals) n.x = -n.x;
  for (size_t i = 0; i + 2 < result.indices.size(); i += 3)
    std::swap(result.indices[i + 1], result.indices[i + 2]);
  result.bounds = {};
  for (const glm::vec3& p : result.positions) result.bounds.add(glm::dvec3(p));
  return result;
}

}  // namespace gnomon
