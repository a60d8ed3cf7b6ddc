// One glTF primitive as a mesh: attributes, triangles, and the coordinates of its texture.
#include "engine/scene/scene_primitive.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/gltf_accessor.h"
#include "engine/scene/mesh_clean.h"

namespace gnomon {
namespace {

std::string place_of(size_t mesh, size_t primitive) {
  return at(at(at("/meshes", mesh), "primitives"), primitive);
}

// Triangle list of a primitive's vertices (glTF 2.0, 3.7.2.1), turning every other triangle of a strip.
std::vector<uint32_t> triangle_list(std::vector<uint32_t> v, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES || mode == -1) {
    v.resize(v.size() / 3 * 3);
    return v;
  }
  std::vector<uint32_t> list;
  for (size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
      list.insert(list.end(), {v[i + 1], v[i + 2], v[0]});
    else
      list.insert(list.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
  }
  return list;
}

const int* attribute(const tinygltf::Primitive& primitive, const char* name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? nullptr : &found->second;
}

std::vector<glm::vec4> read_attribute(const GltfFile& gltf, const tinygltf::Primitive& primitive,
                                      const char* name, const std::string& place,
                                      const std::vector<int>& components, size_t vertices) {
  const int* accessor = attribute(primitive, name);
  if (accessor == nullptr) return {};
  const std::string here = at(at(place, "attributes"), name);
  std::vector<glm::vec4> values = read_vectors(gltf, *accessor, here, components, glm::vec4(0, 0, 0, 1));
  if (values.size() != vertices)
    fail(std::to_string(values.size()) + " values for " + std::to_string(vertices) + " vertices", gltf.file,
         here);
  return values;
}

// The set that the material's texture asks for, with its transform applied.
void read_coordinates(const GltfFile& gltf, const tinygltf::Primitive& primitive, const std::string& place,
                      Mesh& mesh, SceneWarnings& warnings) {
  const size_t count = mesh.positions.size();
  const TextureCoordinates wanted = texture_coordinates(gltf, primitive.material);
  const std::string name = "TEXCOORD_" + std::to_string(wanted.used ? wanted.set : 0);
  for (const glm::vec4& t : read_attribute(gltf, primitive, name.c_str(), place, {2}, count)) {
    glm::vec2 uv(t);
    if (wanted.transform) uv = glm::vec2(*wanted.transform * glm::dvec3(t.x, t.y, 1.0));
    const bool finite = std::isfinite(uv.x) && std::isfinite(uv.y);
    mesh.uvs.push_back(finite ? uv : glm::vec2(0.0f));
  }
  if (wanted.used && mesh.uvs.empty())
    warnings.messages.push_back(gltf.file + ": " + place + ": its material's texture needs " + name +
                                ", which is not there; (0, 0) is used");
  mesh.uvs.resize(count, glm::vec2(0.0f));
}

void read_vertices(const GltfFile& gltf, const tinygltf::Primitive& primitive, const std::string& place,
                   Mesh& mesh, SceneWarnings& warnings) {
  const std::string here = at(at(place, "attributes"), "POSITION");
  for (const glm::vec4& p : read_vectors(gltf, *attribute(primitive, "POSITION"), here, {3}))
    mesh.positions.emplace_back(p);
  const size_t count = mesh.positions.size();
  for (const glm::vec4& n : read_attribute(gltf, primitive, "NORMAL", place, {3}, count))
    mesh.normals.emplace_back(n);
  read_coordinates(gltf, primitive, place, mesh, warnings);
  mesh.colors = read_attribute(gltf, primitive, "COLOR_0", place, {3, 4}, count);
  for (glm::vec4& c : mesh.colors)
    for (int i = 0; i < 4; ++i) c[i] = std::isfinite(c[i]) ? std::clamp(c[i], 0.0f, 1.0f) : 1.0f;
}

void read_triangles(const GltfFile& gltf, const tinygltf::Primitive& primitive, const std::string& place,
                    Mesh& mesh, SceneWarnings& warnings) {
  std::vector<uint32_t> vertices;
  if (primitive.indices >= 0) {
    vertices = read_indices(gltf, primitive.indices, at(place, "indices"), mesh.positions.size());
  } else {
    for (uint32_t i = 0; i < mesh.positions.size(); ++i) vertices.push_back(i);
  }
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == -1;
  if (list && vertices.size() % 3 != 0)
    warnings.messages.push_back(gltf.file + ": " + place + ": " + std::to_string(vertices.size()) +
                                " vertices are not whole triangles; the rest is left out");
  mesh.indices = triangle_list(std::move(vertices), primitive.mode);
}

// Coordinates so far from the origin that float rounding shows in the shape.
void warn_far_origin(const GltfFile& gltf, const std::string& place, const Mesh& mesh,
                     SceneWarnings& warnings) {
  const glm::dvec3 farthest = glm::max(glm::abs(mesh.bounds.min), glm::abs(mesh.bounds.max));
  const double step = std::max({farthest.x, farthest.y, farthest.z}) * 1.2e-7;
  if (step > 1e-4 * 2.0 * mesh.bounds.radius())
    warnings.messages.push_back(
        gltf.file + ": " + place +
        ": vertices are far from the mesh's origin, float rounding deforms them (put the offset "
        "into the node's translation)");
}

bool skip_primitive(const GltfFile& gltf, const tinygltf::Primitive& primitive, const std::string& place,
                    SceneWarnings& warnings) {
  const auto warn = [&](const std::string& what) {
    warnings.messages.push_back(gltf.file + ": " + place + ": " + what);
  };
  const int mode = primitive.mode;
  if (mode > TINYGLTF_MODE_TRIANGLE_FAN || mode < -1)
    fail("mode " + std::to_string(mode) + " is unknown", gltf.file, at(place, "mode"));
  if (mode == TINYGLTF_MODE_POINTS) return warn("points are left out: they have no area"), true;
  if (mode >= 0 && mode < TINYGLTF_MODE_TRIANGLES) return warn("lines are left out: they have no area"), true;
  if (attribute(primitive, "POSITION") == nullptr) return warn("no POSITION, left out"), true;
  return false;
}

}  // namespace

std::optional<Mesh> read_raw_primitive(const GltfFile& gltf, size_t mesh_index, size_t primitive_index,
                                       SceneWarnings& warnings) {
  const tinygltf::Mesh& source = gltf.model.meshes[mesh_index];
  const tinygltf::Primitive& primitive = source.primitives[primitive_index];
  const std::string place = place_of(mesh_index, primitive_index);
  if (skip_primitive(gltf, primitive, place, warnings)) return {};

  Mesh mesh;
  mesh.name = source.name.empty() ? "mesh" + std::to_string(mesh_index) : source.name;
  if (source.primitives.size() > 1) mesh.name += "." + std::to_string(primitive_index);
  read_vertices(gltf, primitive, place, mesh, warnings);
  read_triangles(gltf, primitive, place, mesh, warnings);
  const size_t materials = gltf.model.materials.size();
  if (primitive.material >= 0 && static_cast<size_t>(primitive.material) >= materials)
    fail("no material " + std::to_string(primitive.material) + "; there are " + std::to_string(materials),
         gltf.file, at(place, "material"));
  mesh.material =
      primitive.material < 0 ? static_cast<uint32_t>(materials) : static_cast<uint32_t>(primitive.material);
  return mesh;
}

bool clean_primitive(const GltfFile& gltf, size_t mesh_index, size_t primitive_index, Mesh& mesh,
                     std::vector<uint32_t>* origins, SceneWarnings& warnings) {
  const tinygltf::Primitive& primitive = gltf.model.meshes[mesh_index].primitives[primitive_index];
  const std::string place = place_of(mesh_index, primitive_index);
  const DroppedTriangles dropped =
      origins != nullptr ? drop_bad_triangles(mesh, *origins) : drop_bad_triangles(mesh);
  warnings.degenerate_triangles += dropped.degenerate;
  warnings.nonfinite_triangles += dropped.nonfinite;
  if (dropped.degenerate > 0)
    warnings.messages.push_back(gltf.file + ": " + place + ": dropped " + std::to_string(dropped.degenerate) +
                                " triangles without area");
  if (dropped.nonfinite > 0)
    warnings.messages.push_back(gltf.file + ": " + place + ": dropped " + std::to_string(dropped.nonfinite) +
                                " triangles with NaN or infinite vertices");
  if (mesh.indices.empty()) return false;
  if (!mesh.normals.empty())
    repair_normals(mesh);
  else if (origins != nullptr)
    make_flat_normals(mesh, *origins);
  else
    make_flat_normals(mesh);
  finish_mesh(mesh);
  if (primitive.indices >= 0 && attribute(primitive, "NORMAL") != nullptr)
    warnings.duplicate_vertices += count_duplicate_vertices(mesh);
  warn_far_origin(gltf, place, mesh, warnings);
  return true;
}

std::optional<Mesh> read_primitive(const GltfFile& gltf, size_t mesh, size_t primitive,
                                   SceneWarnings& warnings) {
  std::optional<Mesh> shape = read_raw_primitive(gltf, mesh, primitive, warnings);
  if (shape && !clean_primitive(gltf, mesh, primitive, *shape, nullptr, warnings)) shape.reset();
  return shape;
}

}  // namespace gnomon
