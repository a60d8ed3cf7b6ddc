// Finds the flat receivers of a scene: its largest groups of coplanar triangles.
#include "passes/volume/receiver_planes.h"
#include "engine/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace gnomon {
namespace {

struct Face {
  glm::dvec3 a, b, c;  // relative to the scene's centre
  glm::dvec3 normal;   // unit
  double area;
};

std::vector<Face> world_faces(const Scene& scene) {
  const glm::dvec3 centre = scene.bounds.centre();
  std::vector<Face> faces;
  for (const Instance& instance : scene.instances) {
    if (instance.moving) continue;  // planes are found once
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto corner = [&](size_t i) {
      return glm::dvec3(instance.world_from_object * glm::dvec4(mesh.positions[mesh.indices[i]], 1.0)) -
             centre;
    };
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Face f{corner(i), corner(i + 1), corner(i + 2), {}, 0};
      const glm::dvec3 n = glm::cross(f.b - f.a, f.c - f.a);
      f.area = 0.5 * glm::length(n);
      if (!(f.area > 0.0) || !std::isfinite(f.area)) continue;  // an instance may be scaled flat
      f.normal = n / (2.0 * f.area);
      faces.push_back(f);
    }
  }
  return faces;
}

// One of a plane's two normals, whichever way its triangles are wound.
glm::dvec3 unsigned_normal(const glm::dvec3& n) {
  const glm::dvec3 a = glm::abs(n);
  const double largest = a.x >= a.y && a.x >= a.z ? n.x : a.y >= a.z ? n.y : n.z;
  return largest < 0.0 ? -n : n;
}

// Faces of roughly one plane share a key; a plane may be spread over several.
using Key = std::array<int64_t, 4>;
Key key_of(const Face& f, double radius) {
  constexpr double kNormalSteps = 512, kOffsetSteps = 1024;
  const glm::dvec3 n = unsigned_normal(f.normal);
  return {std::llround(n.x * kNormalSteps), std::llround(n.y * kNormalSteps),
          std::llround(n.z * kNormalSteps), std::llround(glm::dot(n, f.a) / radius * kOffsetSteps)};
}

struct Candidate {
  double area = 0;
  const Face* largest = nullptr;
};

std::vector<Candidate> candidates(const std::vector<Face>& faces, double radius, size_t most) {
  std::map<Key, Candidate> groups;
  for (const Face& f : faces) {
    Candidate& group = groups[key_of(f, radius)];
    group.area += f.area;
    if (!group.largest || f.area > group.largest->area) group.largest = &f;
  }
  std::vector<Candidate> result;
  for (const auto& [key, group] : groups) result.push_back(group);
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.area > b.area; });
  result.resize(std::min(result.size(), most));
  return result;
}

bool on_plane(const Face& f, const Face& plane, double tolerance) {
  const auto near = [&](const glm::dvec3& p) {
    return std::abs(glm::dot(plane.normal, p - plane.a)) <= tolerance;
  };
  return near(f.a) && near(f.b) && near(f.c);
}

}  // namespace

std::vector<ReceiverPlane> receiver_planes(const Scene& scene, size_t most) {
  const std::vector<Face> faces = world_faces(scene);
  const double radius = std::max(scene.bounds.radius(), 1e-300), tolerance = kCoplanarPart * radius;
  constexpr size_t kCandidatesEach =
      4;  // the rough groups may split a plane, or join faces that are not quite coplanar
  std::vector<Candidate> found = candidates(faces, radius, kCandidatesEach * most);
  for (Candidate& c : found) {
    c.area = 0;
    for (const Face& f : faces)
      if (on_plane(f, *c.largest, tolerance)) c.area += f.area;
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.area > b.area; });
  std::vector<const Face*> chosen;
  std::vector<ReceiverPlane> planes;
  for (const Candidate& c : found) {
    const auto same = [&](const Face* other) { return on_plane(*c.largest, *other, 2.0 * tolerance); };
    if (planes.size() == most || std::any_of(chosen.begin(), chosen.end(), same)) continue;
    chosen.push_back(c.largest);
    const glm::dvec3 n = c.largest->normal;
    planes.push_back({glm::dvec4(n, -glm::dot(n, c.largest->a + scene.bounds.centre())), c.area});
  }
  return planes;
}

}  // namespace gnomon
