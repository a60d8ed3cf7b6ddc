// Reads a glTF file's container and document, and checks them before anything in it is used.
#include "engine/scene/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/error.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

constexpr uint32_t chunk_json = 0x4E4F534A, chunk_bin = 0x004E4942;
constexpr int max_depth = 64;  // of nested JSON values: tinygltf recurses over extras and extensions
constexpr uint64_t max_buffer = 0x7FFFFFFF;  // tinygltf counts bytes in int

Bytes read_bytes(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail("no such file", name);
  if (!std::filesystem::is_regular_file(path, error)) fail("not a file", name);
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error) fail("cannot be read: " + error.message(), name);
  if (size > max_buffer) fail("larger than 2 GiB", name, {}, "split the scene");
  Bytes bytes(size);
  std::ifstream in(path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)) && size > 0)
    fail("cannot be read", name);
  return bytes;
}

uint32_t word(const Bytes& bytes, size_t offset) {
  uint32_t value = 0;
  for (size_t i = 4; i-- > 0;) value = value << 8 | bytes[offset + i];
  return value;
}

bool is_binary(const Bytes& bytes) { return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0; }

// Checks a GLB's header and chunks; returns its JSON. tinygltf's own check of the second chunk's length
// leaves out the chunk's header and can read past the end.
std::string binary_document(const Bytes& bytes, const std::string& file) {
  if (bytes.size() < 20)
    fail("the GLB file ends inside its header", file, "byte " + std::to_string(bytes.size()));
  if (word(bytes, 4) != 2)
    fail("GLB version " + std::to_string(word(bytes, 4)) + " is not supported", file, "byte 4");
  if (word(bytes, 8) > bytes.size())
    fail("the GLB file is truncated: its header states " + std::to_string(word(bytes, 8)) +
             " bytes, it has " + std::to_string(bytes.size()),
         file, "byte 8");
  const uint64_t length = word(bytes, 8), json_size = word(bytes, 12);
  if (word(bytes, 16) != chunk_json) fail("the GLB file's first chunk is not JSON", file, "byte 16");
  const uint64_t json_end = 20 + json_size;
  if (json_end > length) fail("the GLB file's JSON chunk is longer than the file", file, "byte 12");
  if (json_end < length) {
    if (json_end + 8 > length)
      fail("the GLB file ends inside a chunk's header", file, "byte " + std::to_string(json_end));
    const uint64_t bin_size = word(bytes, json_end);
    if (word(bytes, json_end + 4) != chunk_bin)
      fail("the GLB file's second chunk is not binary data", file, "byte " + std::to_string(json_end + 4));
    if (json_end + 8 + bin_size > length)
      fail("the GLB file's binary chunk is longer than the file", file, "byte " + std::to_string(json_end));
  }
  return {bytes.begin() + 20, bytes.begin() + static_cast<std::ptrdiff_t>(json_end)};
}

Json parse_document(const std::string& text, const std::string& file) {
  const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > max_depth) fail("JSON values are nested deeper than " + std::to_string(max_depth), file);
    return true;
  };
  try {
    Json document = Json::parse(text, limit_depth);
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
  if (!found->is_number_unsigned() || found->get<uint64_t>() > max_buffer)
    fail("must be a whole number from 0 to 2147483647, got " + found->dump(), file, at(place, name));
  return found->get<uint64_t>();
}

uint64_t required(const Json& object, const char* name, const std::string& file, const std::string& place) {
  const auto value = whole(object, name, file, place);
  if (!value) fail("'" + std::string(name) + "' is missing", file, place);
  return *value;
}

void check_buffers(const Json& document, const std::string& file, SceneWarnings& warnings) {
  const Json& buffers = document.value("buffers", Json::array());
  for (size_t i = 0; i < buffers.size(); ++i) {
    const std::string place = at("/buffers", i);
    if (required(buffers[i], "byteLength", file, place) == 0)
      fail("a buffer of 0 bytes", file, at(place, "byteLength"));
    const auto uri = buffers[i].find("uri");
    if (uri == buffers[i].end()) continue;
    if (!uri->is_string()) fail("must be a string", file, at(place, "uri"));
    if (uri->get<std::string>().find("../") != std::string::npos)
      warnings.messages.push_back(file + ": " + place + ": the buffer is outside the scene's folder");
  }
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

void check_extensions(const Json& document, const std::string& file, SceneWarnings& warnings) {
  constexpr std::array supported = {"EXT_lights_area", "KHR_lights_punctual", "KHR_mesh_quantization"};
  constexpr std::array unreadable = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                     "KHR_texture_basisu", "EXT_texture_webp"};
  const Json& required_names = document.value("extensionsRequired", Json::array());
  for (size_t i = 0; i < required_names.size(); ++i) {
    const std::string name = required_names[i].is_string() ? required_names[i].get<std::string>() : "";
    const std::string place = at("/extensionsRequired", i);
    if (std::find(unreadable.begin(), unreadable.end(), name) != unreadable.end())
      fail("required extension '" + name + "' is not supported", file, place,
           "export the scene without compression");
    if (std::find(supported.begin(), supported.end(), name) == supported.end())
      warnings.messages.push_back(file + ": " + place + ": required extension '" + name + "' is ignored");
  }
}

// Keeps an image's bytes as they are: most images (normal maps, ...) are never needed.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (size > 0) image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

std::string first_line(std::string text) {
  text = text.substr(0, text.find('\n'));
  return text.empty() ? "unknown reason" : text;
}

}  // namespace

std::string at(const std::string& pointer, const std::string& member) { return pointer + "/" + member; }
std::string at(const std::string& pointer, size_t index) { return pointer + "/" + std::to_string(index); }

GltfFile read_gltf(const std::filesystem::path& path, SceneWarnings& warnings) {
  GltfFile result{path.string(), {}};
  const std::string& file = result.file;
  const Bytes bytes = read_bytes(path);
  if (bytes.empty()) fail("the file is empty", file);
  const bool binary = is_binary(bytes);
  const Json document =
      parse_document(binary ? binary_document(bytes, file) : std::string(bytes.begin(), bytes.end()), file);
  check_asset(document, file);
  check_shape(document, file);
  check_buffers(document, file, warnings);
  check_extensions(document, file, warnings);

  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_encoded, nullptr);
  std::string error, warning;
  const std::string folder = path.parent_path().string();
  const unsigned size = static_cast<unsigned>(bytes.size());
  bool good = false;
  try {
    good = binary ? loader.LoadBinaryFromMemory(&result.model, &error, &warning, bytes.data(), size, folder)
                  : loader.LoadASCIIFromString(&result.model, &error, &warning,
                                               reinterpret_cast<const char*>(bytes.data()), size, folder);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (!good) fail("not a readable glTF file: " + first_line(error), file);
  if (!warning.empty()) warnings.messages.push_back(file + ": " + first_line(warning));
  return result;
}

bool decode_image(const tinygltf::Image& encoded, uint32_t& width, uint32_t& height,
                  std::vector<uint8_t>& rgba) {
  if (encoded.image.empty()) return false;
  tinygltf::Image image;
  std::string error, warning;
  if (!tinygltf::LoadImageData(&image, 0, &error, &warning, 0, 0, encoded.image.data(),
                               static_cast<int>(encoded.image.size()), nullptr))
    return false;
  if (image.component != 4 || image.width < 1 || image.height < 1 || image.width > 16384 ||
      image.height > 16384)
    return false;
  width = static_cast<uint32_t>(image.width);
  height = static_cast<uint32_t>(image.height);
  const size_t count = size_t{4} * width * height;
  if (image.bits == 8) {
    rgba = std::move(image.image);
  } else {  // 16 bits: the high byte of each (little-endian) channel
    rgba.resize(count);
    for (size_t i = 0; i < count; ++i) rgba[i] = image.image[2 * i + 1];
  }
  return rgba.size() == count;
}

}  // namespace gnomon
