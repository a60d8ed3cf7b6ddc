// Puts a glTF file together: its document through tinygltf, its buffers and images by their URIs.
#include "engine/scene/gltf_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/scene/gltf_compression.h"
#include "engine/scene/gltf_document.h"
#include "engine/scene/gltf_extensions.h"
#include "engine/scene/gltf_uri.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;

std::string text_of(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void warn_outside(const GltfFile& gltf, const std::string& uri, const std::string& place,
                  const std::string& what, SceneWarnings& warnings) {
  if (!uri.empty() && is_outside(gltf.folder, uri))
    warnings.messages.push_back(gltf.file + ": " + place + ": the " + what +
                                " is outside the scene's folder");
}

// A buffer without data, whose views are all compressed elsewhere.
bool is_placeholder(const tinygltf::Model& model, size_t index) {
  const auto packed = [&](const tinygltf::BufferView& view) {
    return view.extensions.count("EXT_meshopt_compression") +
               view.extensions.count("KHR_meshopt_compression") >
           0;
  };
  bool any = false;
  for (const tinygltf::BufferView& view : model.bufferViews) {
    if (view.buffer != static_cast<int>(index)) continue;
    if (!packed(view)) return false;
    any = true;
  }
  return any;
}

// The binary chunk is the first buffer, where that names no file (glTF 2.0, 4.4.3).
tinygltf::Buffer read_buffer(const GltfFile& gltf, const Json& source, size_t index, Bytes& binary) {
  const std::string place = at("/buffers", index);
  const uint64_t length = source["byteLength"].get<uint64_t>();
  tinygltf::Buffer buffer;
  buffer.uri = text_of(source, "uri");
  if (!source.contains("uri")) {
    if ((index != 0 || binary.empty()) && is_placeholder(gltf.model, index)) return buffer;
    if (index != 0 || binary.empty()) fail("'uri' is missing", gltf.file, place);
    buffer.data = std::move(binary);
  } else {
    try {
      buffer.data = read_uri(gltf.folder, buffer.uri, length);
    } catch (const Error& error) {
      const Problem& problem = error.problems().front();
      fail("cannot read '" + shown_uri(buffer.uri) + "': " + problem.what, gltf.file, at(place, "uri"),
           problem.hint);
    }
  }
  if (buffer.data.size() < length)
    fail("byteLength is " + std::to_string(length) + ", there are " + std::to_string(buffer.data.size()) +
             " bytes",
         gltf.file, place);
  buffer.data.resize(length);
  return buffer;
}

void read_buffers(GltfFile& gltf, GltfDocument& document, SceneWarnings& warnings) {
  const Json buffers = document.json.value("buffers", Json::array());
  for (size_t i = 0; i < buffers.size(); ++i) {
    warn_outside(gltf, text_of(buffers[i], "uri"), at("/buffers", i), "buffer", warnings);
    gltf.model.buffers.push_back(read_buffer(gltf, buffers[i], i, document.binary));
  }
}

void note_images(GltfFile& gltf, const Json& document, SceneWarnings& warnings) {
  const Json images = document.value("images", Json::array());
  for (size_t i = 0; i < images.size(); ++i) {
    tinygltf::Image image;
    image.name = text_of(images[i], "name");
    image.uri = text_of(images[i], "uri");
    image.mimeType = text_of(images[i], "mimeType");
    const auto view = images[i].find("bufferView");
    const bool in_view = view != images[i].end();
    if (in_view && !view->is_number_integer())
      fail("must be a whole number", gltf.file, at(at("/images", i), "bufferView"));
    image.bufferView = in_view ? view->get<int>() : -1;
    warn_outside(gltf, image.uri, at("/images", i), "image", warnings);
    gltf.model.images.push_back(std::move(image));
  }
}

std::string first_line(std::string text) {
  text = text.substr(0, text.find('\n'));
  return text.empty() ? "unknown reason" : text;
}

// The document alone: tinygltf's URIs are not those of RFC 3986, and it reads every image.
tinygltf::Model parse_model(Json& document, const std::string& file, SceneWarnings& warnings) {
  document.erase("buffers");
  document.erase("images");
  // tinygltf refuses indices without a buffer view (glTF 2.0, 3.6.2.3: zeros); they get one for the time
  // being.
  const size_t views = document.value("bufferViews", Json::array()).size();
  bool lent = false;
  if (document.contains("accessors"))
    for (Json& accessor : document["accessors"])
      if (!accessor.contains("bufferView")) accessor["bufferView"] = views, lent = true;
  if (lent) document["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});

  // Channels of KHR_animation_pointer have no node, which tinygltf leaves out.
  if (document.contains("animations"))
    for (Json& animation : document["animations"])
      if (animation.contains("channels") && animation["channels"].is_array())
        for (Json& channel : animation["channels"])
          if (channel.is_object() && channel.contains("target") && channel["target"].is_object() &&
              !channel["target"].contains("node"))
            channel["target"]["node"] = -1;

  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning;
  bool good = false;
  try {
    const std::string text = document.dump();
    good = loader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                      static_cast<unsigned>(text.size()), "");
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (!good) fail("not a readable glTF file: " + first_line(error), file);
  if (!warning.empty()) warnings.messages.push_back(file + ": " + first_line(warning));
  if (!lent) return model;
  model.bufferViews.resize(views);
  for (tinygltf::Accessor& accessor : model.accessors)
    if (accessor.bufferView == static_cast<int>(views)) accessor.bufferView = -1;
  return model;
}

}  // namespace

std::string at(const std::string& pointer, const std::string& member) { return pointer + "/" + member; }
std::string at(const std::string& pointer, size_t index) { return pointer + "/" + std::to_string(index); }

GltfFile read_gltf(const std::filesystem::path& path, SceneWarnings& warnings) {
  GltfFile result{path.string(), path.parent_path(), {}};
  Bytes bytes;
  try {
    bytes = read_bytes(path);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    fail(problem.what, result.file, {}, problem.hint);
  }
  GltfDocument document = parse_gltf(std::move(bytes), result.file);
  check_extensions(document.json, result.file, warnings);
  Json json = std::move(document.json);
  document.json = {{"buffers", json.value("buffers", Json::array())}};
  const Json images = {{"images", json.value("images", Json::array())}};
  result.model = parse_model(json, result.file, warnings);
  read_buffers(result, document, warnings);
  note_images(result, images, warnings);
  unpack_meshopt(result, warnings);
  unpack_draco(result, warnings);
  return result;
}

}  // namespace gnomon
