// Buffer views packed by meshoptimizer.
#include <meshoptimizer.h>

#include <array>
#include <span>

#include "engine/base/error.h"
#include "engine/scene/gltf_compression.h"
#include "engine/scene/meshopt_stream.h"

namespace gnomon {
namespace {

constexpr std::array kNames = {"KHR_meshopt_compression", "EXT_meshopt_compression"};
// Bytes that one byte of a stream becomes at most: a version 1 block without deltas has 256 elements of four
// bytes for each byte of control.
constexpr uint64_t kMostExpansion = 1024;

struct Packed {
  std::span<const unsigned char> bytes;
  size_t stride = 0, count = 0;
  std::string mode, filter;
};

uint64_t number(const tinygltf::Value& object, const char* name) {
  const tinygltf::Value value = object.Has(name) ? object.Get(name) : tinygltf::Value();
  return value.IsInt() && value.GetNumberAsInt() >= 0 ? static_cast<uint64_t>(value.GetNumberAsInt()) : 0;
}

std::string word(const tinygltf::Value& object, const char* name, const char* standard) {
  return object.Has(name) && object.Get(name).IsString() ? object.Get(name).Get<std::string>() : standard;
}

// What the extension says of a view, checked; otherwise `problem` says what does not hold.
Packed packed_of(const GltfFile& gltf, const tinygltf::BufferView& view, const tinygltf::Value& extension,
                 std::string& problem) {
  const uint64_t buffer = number(extension, "buffer"), offset = number(extension, "byteOffset"),
                 length = number(extension, "byteLength");
  Packed packed;
  packed.stride = number(extension, "byteStride"), packed.count = number(extension, "count");
  packed.mode = word(extension, "mode", ""), packed.filter = word(extension, "filter", "NONE");
  const auto& buffers = gltf.model.buffers;
  if (buffer >= buffers.size() || offset + length > buffers[buffer].data.size())
    problem = "its bytes are not inside buffer " + std::to_string(buffer);
  else if (packed.stride == 0 || packed.stride > 256 || packed.count * packed.stride != view.byteLength)
    problem = "count times byteStride is not the view's byteLength";
  else if (view.byteLength > kMostExpansion * (length + 1))
    problem = "the stream is too short for the view";
  else
    packed.bytes = std::span(buffers[buffer].data).subspan(offset, length);
  return packed;
}

bool decode_attributes(const Packed& packed, std::vector<unsigned char>& out) {
  if (packed.stride % 4 != 0) return false;
  if (!packed.bytes.empty() && packed.bytes[0] == 0xA1)
    return decode_attributes_v1(out, packed.count, packed.stride, packed.bytes);
  return meshopt_decodeVertexBuffer(out.data(), packed.count, packed.stride, packed.bytes.data(),
                                    packed.bytes.size()) == 0;
}

bool apply_filter(const Packed& packed, std::vector<unsigned char>& out) {
  const bool four_or_eight = packed.stride == 4 || packed.stride == 8;
  if (packed.filter == "NONE") return true;
  if (packed.filter == "OCTAHEDRAL" && four_or_eight)
    return meshopt_decodeFilterOct(out.data(), packed.count, packed.stride), true;
  if (packed.filter == "QUATERNION" && packed.stride == 8)
    return meshopt_decodeFilterQuat(out.data(), packed.count, packed.stride), true;
  if (packed.filter == "EXPONENTIAL" && packed.stride % 4 == 0)
    return meshopt_decodeFilterExp(out.data(), packed.count, packed.stride), true;
  if (packed.filter == "COLOR" && four_or_eight) return decode_color_filter(out, packed.stride), true;
  return false;
}

// The view's bytes; otherwise `problem` says why not.
std::vector<unsigned char> unpack(const Packed& packed, std::string& problem) {
  // The library's filters and codecs work on four elements at once.
  std::vector<unsigned char> out(packed.count * packed.stride);
  const bool index = packed.stride == 2 || packed.stride == 4;
  bool good = false;
  if (packed.mode == "ATTRIBUTES")
    good = decode_attributes(packed, out);
  else if (packed.mode == "TRIANGLES" && index && packed.count % 3 == 0)
    good = meshopt_decodeIndexBuffer(out.data(), packed.count, packed.stride, packed.bytes.data(),
                                     packed.bytes.size()) == 0;
  else if (packed.mode == "INDICES" && index)
    good = meshopt_decodeIndexSequence(out.data(), packed.count, packed.stride, packed.bytes.data(),
                                       packed.bytes.size()) == 0;
  else
    problem =
        "mode '" + packed.mode + "' with elements of " + std::to_string(packed.stride) + " bytes is unknown";
  if (problem.empty() && !good) problem = "the stream is broken";
  if (good && packed.mode == "ATTRIBUTES" && !apply_filter(packed, out))
    problem = "filter '" + packed.filter + "' with elements of " + std::to_string(packed.stride) +
              " bytes is unknown";
  return out;
}

void unpack_view(GltfFile& gltf, size_t index, const char* name, const tinygltf::Value& extension,
                 SceneWarnings& warnings) {
  std::string problem;
  const Packed packed = packed_of(gltf, gltf.model.bufferViews[index], extension, problem);
  std::vector<unsigned char> bytes;
  if (problem.empty()) bytes = unpack(packed, problem);
  tinygltf::BufferView& view = gltf.model.bufferViews[index];
  const std::string place = at("/bufferViews", index);
  if (problem.empty()) {
    tinygltf::Buffer buffer;
    buffer.data = std::move(bytes);
    view.buffer = static_cast<int>(gltf.model.buffers.size());
    view.byteOffset = 0;
    gltf.model.buffers.push_back(std::move(buffer));
  } else if (gltf.model.buffers[static_cast<size_t>(view.buffer)].data.empty()) {
    fail(std::string(name) + ": " + problem, gltf.file, place, "export the scene without compression");
  } else {
    warnings.messages.push_back(gltf.file + ": " + place + ": " + name + ": " + problem +
                                "; the uncompressed fallback is read");
  }
}

}  // namespace

void unpack_meshopt(GltfFile& gltf, SceneWarnings& warnings) {
  const size_t views = gltf.model.bufferViews.size();
  for (size_t i = 0; i < views; ++i) {
    for (const char* name : kNames) {
      const auto& extensions = gltf.model.bufferViews[i].extensions;
      const auto found = extensions.find(name);
      if (found == extensions.end() || !found->second.IsObject()) continue;
      const tinygltf::Value extension = found->second;
      unpack_view(gltf, i, name, extension, warnings);
      break;
    }
  }
}

int add_view(tinygltf::Model& model, std::vector<unsigned char> bytes) {
  tinygltf::BufferView view;
  view.buffer = static_cast<int>(model.buffers.size());
  view.byteLength = bytes.size();
  tinygltf::Buffer buffer;
  buffer.data = std::move(bytes);
  model.buffers.push_back(std::move(buffer));
  model.bufferViews.push_back(view);
  return static_cast<int>(model.bufferViews.size() - 1);
}

}  // namespace gnomon
