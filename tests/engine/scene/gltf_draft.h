// glTF files made in memory, to be loaded whole or spoiled in one place.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/scene/scene.h"

namespace gnomon::test {

class Folder {  // a fresh one, removed at the end
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() / ("gnomon_scene_test_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

template <typename T>
std::string raw(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string glb(const nlohmann::json& document, const std::string& data) {
  std::string text = document.dump(), binary = data;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto word = [](size_t v) {
    const uint32_t value = static_cast<uint32_t>(v);
    return std::string(reinterpret_cast<const char*>(&value), 4);
  };
  return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
         word(binary.size()) + std::string("BIN\0", 4) + binary;
}

// A unit square in the plane z = 0: 4 positions (48 bytes), then 6 indices of 2 bytes.
inline const std::vector<float> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
inline const std::vector<uint16_t> square_indices = {0, 1, 2, 0, 2, 3};

struct Draft {
  nlohmann::json document = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
        {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}}}},
      {"buffers", {{{"byteLength", 60}}}}};
  std::string data = raw(square) + raw(square_indices);
  std::string bytes() const { return glb(document, data); }

  // A view of more bytes; its index.
  size_t add_view(const std::string& more) {
    data.resize((data.size() + 3) / 4 * 4, '\0');
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", more.size()}});
    data += more;
    document["buffers"][0]["byteLength"] = data.size();
    return document["bufferViews"].size() - 1;
  }

  // An accessor to floats of its own; its index.
  size_t add_floats(const std::vector<float>& values, const std::string& type, size_t components) {
    const size_t view = add_view(raw(values));
    document["accessors"].push_back({{"bufferView", view},
                                     {"componentType", 5126},
                                     {"count", values.size() / components},
                                     {"type", type}});
    return document["accessors"].size() - 1;
  }
  nlohmann::json& primitive() { return document["meshes"][0]["primitives"][0]; }
};

inline Scene load(const Draft& draft) {
  const Folder folder;
  return load_scene(folder.write("draft.glb", draft.bytes()));
}

inline bool warns(const Scene& scene, const std::string& part) {
  for (const std::string& message : scene.warnings.messages)
    if (message.find(part) != std::string::npos) return true;
  return false;
}

inline std::string error_of(const std::string& name, const std::string& bytes) {
  const Folder folder;
  try {
    load_scene(folder.write(name, bytes));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace gnomon::test
