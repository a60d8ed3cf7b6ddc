// Primitives packed by Draco.
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <cstring>
#include <memory>

#include "engine/base/error.h"
#include "engine/scene/gltf_compression.h"

namespace gnomon {
namespace {

constexpr const char* kName = "KHR_draco_mesh_compression";

using Decoded = std::unique_ptr<draco::Mesh>;

// Nothing, and `problem` says why.
Decoded decode(const GltfFile& gltf, const tinygltf::Value& extension, std::string& problem) {
  const tinygltf::Value view_index =
      extension.Has("bufferView") ? extension.Get("bufferView") : tinygltf::Value();
  const auto& views = gltf.model.bufferViews;
  const int index = view_index.IsInt() ? view_index.GetNumberAsInt() : -1;
  if (index < 0 || static_cast<size_t>(index) >= views.size())
    return problem = "no buffer view " + std::to_string(index), nullptr;
  const tinygltf::BufferView& view = views[static_cast<size_t>(index)];
  const auto& data = gltf.model.buffers.at(static_cast<size_t>(view.buffer)).data;
  if (view.byteOffset + view.byteLength > data.size())
    return problem = "its buffer view has no data", nullptr;
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(data.data() + view.byteOffset), view.byteLength);
  try {
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (decoded.ok()) return std::move(decoded).value();
    problem = decoded.status().error_msg_string();
  } catch (const std::exception&) {  // counts of a broken stream that no memory can hold
    problem = "the stream is broken";
  }
  return nullptr;
}

template <typename T>
bool write_values(const draco::PointAttribute& attribute, size_t points, std::vector<unsigned char>& out) {
  const auto components = static_cast<size_t>(attribute.num_components());
  std::vector<T> value(components);
  out.resize(points * components * sizeof(T));
  for (size_t i = 0; i < points; ++i) {
    const auto index = attribute.mapped_index(draco::PointIndex(static_cast<uint32_t>(i)));
    if (!attribute.ConvertValue<T>(index, static_cast<int8_t>(components), value.data())) return false;
    std::memcpy(&out[i * components * sizeof(T)], value.data(), components * sizeof(T));
  }
  return true;
}

bool write_values(const draco::PointAttribute& attribute, int type, size_t points,
                  std::vector<unsigned char>& out) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return write_values<int8_t>(attribute, points, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return write_values<uint8_t>(attribute, points, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return write_values<int16_t>(attribute, points, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return write_values<uint16_t>(attribute, points, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return write_values<uint32_t>(attribute, points, out);
    default:
      return write_values<float>(attribute, points, out);
  }
}

int add_accessor(tinygltf::Model& model, tinygltf::Accessor accessor, size_t count,
                 std::vector<unsigned char> bytes) {
  accessor.bufferView = add_view(model, std::move(bytes));
  accessor.byteOffset = 0;
  accessor.count = count;
  accessor.sparse = {};
  accessor.sparse.isSparse = false;
  model.accessors.push_back(std::move(accessor));
  return static_cast<int>(model.accessors.size() - 1);
}

int component_count(int type) { return tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)); }

// An attribute of the primitive, in the component type that its accessor states.
int unpack_attribute(GltfFile& gltf, const draco::Mesh& mesh, int accessor, int id, std::string& problem) {
  const draco::PointAttribute* attribute =
      id >= 0 ? mesh.GetAttributeByUniqueId(static_cast<uint32_t>(id)) : nullptr;
  auto& accessors = gltf.model.accessors;
  if (attribute == nullptr) return problem = "it has no attribute " + std::to_string(id), accessor;
  if (accessor < 0 || static_cast<size_t>(accessor) >= accessors.size())
    return problem = "no accessor " + std::to_string(accessor), accessor;
  const tinygltf::Accessor source = accessors[static_cast<size_t>(accessor)];
  if (component_count(source.type) != attribute->num_components())
    return problem =
               "attribute " + std::to_string(id) + " has another number of components than its accessor",
           accessor;
  std::vector<unsigned char> bytes;
  if (!write_values(*attribute, source.componentType, mesh.num_points(), bytes))
    return problem = "attribute " + std::to_string(id) + " does not fit its accessor", accessor;
  return add_accessor(gltf.model, source, mesh.num_points(), std::move(bytes));
}

int unpack_indices(GltfFile& gltf, const draco::Mesh& mesh) {
  std::vector<uint32_t> indices;
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (size_t k = 0; k < 3; ++k) indices.push_back(mesh.face(f)[k].value());
  std::vector<unsigned char> bytes(indices.size() * sizeof(uint32_t));
  std::memcpy(bytes.data(), indices.data(), bytes.size());
  tinygltf::Accessor accessor;
  accessor.type = TINYGLTF_TYPE_SCALAR;
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  return add_accessor(gltf.model, accessor, indices.size(), std::move(bytes));
}

bool has_fallback(const GltfFile& gltf, const tinygltf::Primitive& primitive) {
  const auto found = primitive.attributes.find("POSITION");
  if (found == primitive.attributes.end() || found->second < 0 ||
      static_cast<size_t>(found->second) >= gltf.model.accessors.size())
    return false;
  return gltf.model.accessors[static_cast<size_t>(found->second)].bufferView >= 0;
}

// The primitive as it would be without compression; unchanged when `problem` says why not.
tinygltf::Primitive unpacked(GltfFile& gltf, const tinygltf::Primitive& primitive,
                             const tinygltf::Value& extension, std::string& problem) {
  tinygltf::Primitive result = primitive;
  const Decoded mesh = decode(gltf, extension, problem);
  if (!mesh) return primitive;
  const tinygltf::Value attributes =
      extension.Has("attributes") ? extension.Get("attributes") : tinygltf::Value();
  if (!attributes.IsObject()) return problem = "it names no attributes", primitive;
  for (const std::string& name : attributes.Keys()) {
    const auto found = result.attributes.find(name);
    if (found == result.attributes.end() || !problem.empty()) continue;
    const tinygltf::Value& id = attributes.Get(name);
    found->second =
        unpack_attribute(gltf, *mesh, found->second, id.IsInt() ? id.GetNumberAsInt() : -1, problem);
  }
  if (!problem.empty()) return primitive;
  result.indices = unpack_indices(gltf, *mesh);
  result.mode = TINYGLTF_MODE_TRIANGLES;
  return result;
}

void unpack_primitive(GltfFile& gltf, tinygltf::Primitive& primitive, const std::string& place,
                      SceneWarnings& warnings) {
  const auto found = primitive.extensions.find(kName);
  if (found == primitive.extensions.end() || !found->second.IsObject()) return;
  const tinygltf::Value extension = found->second;
  std::string problem;
  primitive = unpacked(gltf, primitive, extension, problem);
  if (problem.empty()) return;
  if (!has_fallback(gltf, primitive))
    fail(std::string(kName) + ": " + problem, gltf.file, place, "export the scene without compression");
  warnings.messages.push_back(gltf.file + ": " + place + ": " + kName + ": " + problem +
                              "; the uncompressed fallback is read");
}

}  // namespace

void unpack_draco(GltfFile& gltf, SceneWarnings& warnings) {
  for (size_t m = 0; m < gltf.model.meshes.size(); ++m)
    for (size_t p = 0; p < gltf.model.meshes[m].primitives.size(); ++p)
      unpack_primitive(gltf, gltf.model.meshes[m].primitives[p], at(at(at("/meshes", m), "primitives"), p),
                       warnings);
}

}  // namespace gnomon
