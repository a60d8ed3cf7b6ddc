// Reads the values of glTF accessors, with every byte range checked first.
#include "engine/scene/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "engine/base/error.h"

namespace gnomon {
namespace {

struct Strided {  // `count` elements of `size` bytes, all inside their buffer
  const unsigned char* data = nullptr;
  size_t count = 0, stride = 0;
};

size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

const tinygltf::Accessor& find_accessor(const GltfFile& gltf, int index, const std::string& place) {
  if (index < 0 || static_cast<size_t>(index) >= gltf.model.accessors.size())
    fail(
        "no accessor " + std::to_string(index) + "; there are " + std::to_string(gltf.model.accessors.size()),
        gltf.file, place);
  return gltf.model.accessors[static_cast<size_t>(index)];
}

// Checked without overflow: all sizes are below 2^32 and are compared by division.
Strided view_elements(const GltfFile& gltf, int view_index, size_t offset, size_t count, size_t element,
                      const std::string& place) {
  const auto& views = gltf.model.bufferViews;
  if (view_index < 0 || static_cast<size_t>(view_index) >= views.size())
    fail("no buffer view " + std::to_string(view_index) + "; there are " + std::to_string(views.size()),
         gltf.file, place);
  const tinygltf::BufferView& view = views[static_cast<size_t>(view_index)];
  if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= gltf.model.buffers.size())
    fail("no buffer " + std::to_string(view.buffer), gltf.file, place);
  const auto& data = gltf.model.buffers[static_cast<size_t>(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
    fail("its buffer view reaches past the end of its buffer", gltf.file, place);
  const size_t stride = view.byteStride == 0 ? element : view.byteStride;
  if (stride < element) fail("the stride is smaller than an element", gltf.file, place);
  const size_t room = offset <= view.byteLength ? view.byteLength - offset : 0;
  if (count > 0 && (room < element || (count - 1) > (room - element) / stride))
    fail(std::to_string(count) + " elements of " + std::to_string(element) +
             " bytes do not fit into its buffer view of " + std::to_string(view.byteLength) + " bytes",
         gltf.file, place);
  return {data.data() + view.byteOffset + (count > 0 ? offset : 0), count, stride};
}

template <typename T>
T load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <typename T>
float scaled(const unsigned char* bytes, bool normalized) {
  const float value = static_cast<float>(load<T>(bytes));
  return normalized ? std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f) : value;
}

float component(const unsigned char* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled<int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled<uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled<int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled<uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return scaled<uint32_t>(bytes, normalized);
    default:
      return load<float>(bytes);
  }
}

uint32_t unsigned_component(const unsigned char* bytes, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<uint16_t>(bytes);
    default:
      return load<uint32_t>(bytes);
  }
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

int component_count(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      return 0;
  }
}

struct Layout {
  int components = 0, type = 0;
  bool normalized = false;
  size_t element() const { return static_cast<size_t>(components) * component_size(type); }
};

glm::vec4 element_at(const unsigned char* bytes, const Layout& layout, glm::vec4 value) {
  for (int c = 0; c < layout.components; ++c)
    value[c] = component(bytes + static_cast<size_t>(c) * component_size(layout.type), layout.type,
                         layout.normalized);
  return value;
}

constexpr size_t kMaxElements = size_t{1} << 24;  // that an accessor without a buffer view may claim

// glTF 2.0, 5.1.1: without a buffer view all elements are zeros, sparse ones apart.
void check_claim(const GltfFile& gltf, int index, size_t count, const std::string& place) {
  if (count > kMaxElements)
    fail("accessor " + std::to_string(index) + " has no buffer view and claims " + std::to_string(count) +
             " elements; at most " + std::to_string(kMaxElements) + " are read",
         gltf.file, place);
}

// Calls set(index, value's bytes) for the sparse elements of an accessor with `count` elements.
template <typename Set>
void read_sparse(const GltfFile& gltf, const tinygltf::Accessor& accessor, size_t count, size_t element,
                 const std::string& place, const Set& set) {
  const auto& sparse = accessor.sparse;
  if (!sparse.isSparse) return;
  // Signed or not, as the version of tinygltf has it.
  if (sparse.count < 0 || static_cast<size_t>(sparse.count) > count ||
      !is_index_type(sparse.indices.componentType) || std::cmp_less(sparse.indices.byteOffset, 0) ||
      std::cmp_less(sparse.values.byteOffset, 0))
    fail("the sparse part of its accessor is broken", gltf.file, place);
  const size_t changed = static_cast<size_t>(sparse.count);
  const Strided where =
      view_elements(gltf, sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset), changed,
                    component_size(sparse.indices.componentType), place);
  const Strided what = view_elements(gltf, sparse.values.bufferView,
                                     static_cast<size_t>(sparse.values.byteOffset), changed, element, place);
  for (size_t i = 0; i < changed; ++i) {
    const uint32_t index = unsigned_component(where.data + i * where.stride, sparse.indices.componentType);
    if (index >= count) fail("sparse index " + std::to_string(index) + " is out of range", gltf.file, place);
    set(index, what.data + i * what.stride);
  }
}

}  // namespace

std::vector<glm::vec4> read_vectors(const GltfFile& gltf, int index, const std::string& place,
                                    const std::vector<int>& components, const glm::vec4& fill) {
  const tinygltf::Accessor& accessor = find_accessor(gltf, index, place);
  const Layout layout{component_count(accessor.type), accessor.componentType, accessor.normalized};
  if (std::find(components.begin(), components.end(), layout.components) == components.end())
    fail("accessor " + std::to_string(index) + " has the wrong number of components", gltf.file, place);
  if (component_size(layout.type) == 0)
    fail("component type " + std::to_string(layout.type) + " is not supported", gltf.file, place);
  std::vector<glm::vec4> values;
  if (accessor.bufferView >= 0) {
    const Strided from = view_elements(gltf, accessor.bufferView, accessor.byteOffset, accessor.count,
                                       layout.element(), place);
    values.resize(from.count);
    for (size_t i = 0; i < from.count; ++i) values[i] = element_at(from.data + i * from.stride, layout, fill);
  } else {
    check_claim(gltf, index, accessor.count, place);
    glm::vec4 zero = fill;
    for (int c = 0; c < layout.components; ++c) zero[c] = 0.0f;
    values.assign(accessor.count, zero);
  }
  read_sparse(gltf, accessor, values.size(), layout.element(), place,
              [&](uint32_t i, const unsigned char* bytes) { values[i] = element_at(bytes, layout, fill); });
  return values;
}

std::vector<glm::dmat4> read_matrices(const GltfFile& gltf, int index, const std::string& place) {
  const tinygltf::Accessor& accessor = find_accessor(gltf, index, place);
  if (accessor.type != TINYGLTF_TYPE_MAT4 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    fail("accessor " + std::to_string(index) + " must hold 4 x 4 matrices of floats", gltf.file, place);
  const Strided from = view_elements(gltf, accessor.bufferView, accessor.byteOffset, accessor.count,
                                     16 * sizeof(float), place);
  std::vector<glm::dmat4> matrices(from.count);
  for (size_t i = 0; i < from.count; ++i)
    for (int k = 0; k < 16; ++k) {
      const float value = load<float>(from.data + i * from.stride + sizeof(float) * static_cast<size_t>(k));
      if (!std::isfinite(value)) fail("matrix " + std::to_string(i) + " is not finite", gltf.file, place);
      matrices[i][k / 4][k % 4] = value;
    }
  return matrices;
}

std::vector<uint32_t> read_indices(const GltfFile& gltf, int index, const std::string& place,
                                   size_t vertices) {
  const tinygltf::Accessor& accessor = find_accessor(gltf, index, place);
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType))
    fail("indices must be unsigned scalars", gltf.file, place);
  const size_t size = component_size(accessor.componentType);
  std::vector<uint32_t> values;
  if (accessor.bufferView >= 0) {
    const Strided from =
        view_elements(gltf, accessor.bufferView, accessor.byteOffset, accessor.count, size, place);
    values.resize(from.count);
    for (size_t i = 0; i < from.count; ++i)
      values[i] = unsigned_component(from.data + i * from.stride, accessor.componentType);
  } else {
    check_claim(gltf, index, accessor.count, place);
    values.assign(accessor.count, 0);
  }
  read_sparse(gltf, accessor, values.size(), size, place, [&](uint32_t i, const unsigned char* bytes) {
    values[i] = unsigned_component(bytes, accessor.componentType);
  });
  for (size_t i = 0; i < values.size(); ++i)
    if (values[i] >= vertices)
      fail("index " + std::to_string(values[i]) + " at " + std::to_string(i) +
               " is out of range; there are " + std::to_string(vertices) + " vertices",
           gltf.file, place);
  return values;
}

}  // namespace gnomon
