// Takes a glTF file's container and JSON apart, and checks what everything else relies on.
#include "engine/scene/gltf_document.h"

#include <cstring>
#include <optional>

#include "engine/base/error.h"
#include "engine/scene/gltf_file.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;

constexpr uint32_t kChunkJson = 0x4E4F534A, kChunkBin = 0x004E4942;
constexpr int kMaxDepth = 64;  // of nested JSON values: tinygltf recurses over extras and extensions

uint32_t word(const Bytes& bytes, size_t offset) {
  uint32_t value = 0;
  for (size_t i = 4; i-- > 0;) value = value << 8 | bytes[offset + i];
  return value;
}

struct Chunks {
  std::string json;
  Bytes binary;
};

// Checks a GLB's header and chunks.
Chunks split_binary(const Bytes& bytes, const std::string& file) {
  if (bytes.size() < 20)
    fail("the GLB file ends inside its header", file, "byte " + std::to_string(bytes.size()));
  if (word(bytes, 4) != 2)
    fail("GLB version " + std::to_string(word(bytes, 4)) + " is not supported", file, "byte 4");
  if (word(bytes, 8) > bytes.size())
    fail("the GLB file is truncated: its header states " + std::to_string(word(bytes, 8)) +
             " bytes, it has " + std::to_string(bytes.size()),
         file, "byte 8");
  const uint64_t length = word(bytes, 8), json_size = word(bytes, 12);
  if (word(bytes, 16) != kChunkJson) fail("the GLB file's first chunk is not JSON", file, "byte 16");
  const uint64_t json_end = 20 + json_size;
  if (json_end > length) fail("the GLB file's JSON chunk is longer than the file", file, "byte 12");
  Chunks chunks{{bytes.begin() + 20, bytes.begin() + static_cast<std::ptrdiff_t>(json_end)}, {}};
  if (json_end < length) {
    if (json_end + 8 > length)
      fail("the GLB file ends inside a chunk's header", file, "byte " + std::to_string(json_end));
    const uint64_t bin_size = word(bytes, json_end);
    if (word(bytes, json_end + 4) != kChunkBin)
      fail("the GLB file's second chunk is not binary data", file, "byte " + std::to_string(json_end + 4));
    if (json_end + 8 + bin_size > length)
      fail("the GLB file's binary chunk is longer than the file", file, "byte " + std::to_string(json_end));
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(json_end + 8);
    chunks.binary.assign(begin, begin + static_cast<std::ptrdiff_t>(bin_size));
  }
  return chunks;
}

// Before the parser: what it builds is destroyed recursively, too.
void check_depth(const std::string& text, const std::string& file) {
  int depth = 0;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == '[' || c == '{')) {
      if (++depth > kMaxDepth)
        fail("JSON values are nested deeper than " + std::to_string(kMaxDepth), file,
             "byte " + std::to_string(i));
    } else if (!quoted && (c == ']' || c == '}')) {
      --depth;
    }
  }
}

Json parse_document(const std::string& text, const std::string& file) {
  check_depth(text, file);
  try {
    Json document = Json::parse(text);
    if (!document.is_object()) fail("not a glTF file: its JSON is not an object", file);
    return document;
  } catch (const Json::exception& error) {
    fail(std::string("not a glTF file: its JSON cannot be read: ") + error.what(), file);
  }
}

void check_asset(const Json& document, const std::string& file) {
  const auto asset = document.find("asset");
  if (asset == document.end() || !asset->is_object() || !asset->contains("version"))
    fail("not a glTF file: asset.version is missing", file, "/asset/version");
  const Json& version = (*asset)["version"];
  if (!version.is_string() || version.get<std::string>().rfind("2.", 0) != 0)
    fail("glTF version " + version.dump() + " is not supported", file, "/asset/version",
         "convert it to glTF 2.0");
  const auto least = asset->find("minVersion");
  if (least != asset->end() && *least != "2.0")
    fail("the file needs glTF " + least->dump() + ", 2.0 is read", file, "/asset/minVersion",
         "convert it to glTF 2.0");
}

// Every top-level collection that is read must be an array of objects.
void check_shape(const Json& document, const std::string& file) {
  for (const char* name : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images",
                           "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
    const auto found = document.find(name);
    if (found == document.end()) continue;
    const std::string place = at("", name);
    if (!found->is_array()) fail("must be an array", file, place);
    for (size_t i = 0; i < found->size(); ++i)
      if (!(*found)[i].is_object()) fail("must be an object", file, at(place, i));
  }
}

std::optional<uint64_t> whole(const Json& object, const char* name, const std::string& file,
                              const std::string& place) {
  const auto found = object.find(name);
  if (found == object.end()) return {};
  if (!found->is_number_unsigned() || found->get<uint64_t>() > kMaxFileSize)
    fail("must be a whole number from 0 to 2147483647, got " + found->dump(), file, at(place, name));
  return found->get<uint64_t>();
}

uint64_t required(const Json& object, const char* name, const std::string& file, const std::string& place) {
  const auto value = whole(object, name, file, place);
  if (!value) fail("'" + std::string(name) + "' is missing", file, place);
  return *value;
}

void check_buffers(const Json& document, const std::string& file) {
  const Json& buffers = document.value("buffers", Json::array());
  for (size_t i = 0; i < buffers.size(); ++i) {
    const std::string place = at("/buffers", i);
    if (required(buffers[i], "byteLength", file, place) == 0)
      fail("a buffer of 0 bytes", file, at(place, "byteLength"));
    const auto uri = buffers[i].find("uri");
    if (uri != buffers[i].end() && !uri->is_string()) fail("must be a string", file, at(place, "uri"));
  }
}

void check_views(const Json& document, const std::string& file) {
  const Json& buffers = document.value("buffers", Json::array());
  const Json& views = document.value("bufferViews", Json::array());
  for (size_t i = 0; i < views.size(); ++i) {
    const std::string place = at("/bufferViews", i);
    const uint64_t buffer = required(views[i], "buffer", file, place);
    if (buffer >= buffers.size())
      fail("no buffer " + std::to_string(buffer) + "; there are " + std::to_string(buffers.size()), file,
           at(place, "buffer"));
    const uint64_t offset = whole(views[i], "byteOffset", file, place).value_or(0);
    const uint64_t length = required(views[i], "byteLength", file, place);
    const uint64_t size = buffers[buffer]["byteLength"].get<uint64_t>();
    if (length == 0 || offset + length > size)
      fail("bytes " + std::to_string(offset) + " to " + std::to_string(offset + length) +
               " are not inside buffer " + std::to_string(buffer) + " of " + std::to_string(size) + " bytes",
           file, place);
  }
}

}  // namespace

GltfDocument parse_gltf(Bytes bytes, const std::string& file) {
  if (bytes.empty()) fail("the file is empty", file);
  const bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
  Chunks chunks = binary ? split_binary(bytes, file) : Chunks{{bytes.begin(), bytes.end()}, {}};
  bytes = {};
  GltfDocument result{parse_document(chunks.json, file), std::move(chunks.binary)};
  check_asset(result.json, file);
  check_shape(result.json, file);
  check_buffers(result.json, file);
  check_views(result.json, file);
  return result;
}

}  // namespace gnomon
