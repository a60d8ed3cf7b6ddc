// Finds the scenes of a suite.
#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "bench/run/suite_parts.h"
#include "engine/base/resource_root.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kScenesVariable = "$GNOMON_SCENES";

bool is_scene(const fs::path& path) { return path.extension() == ".glb" || path.extension() == ".gltf"; }

std::vector<fs::path> scenes_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_scene(entry.path())) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<fs::path> matches(const fs::path& pattern) {
  glob_t found{};
  std::vector<fs::path> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (size_t i = 0; i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  globfree(&found);
  return paths;
}

fs::path real_scenes_folder() {
  const char* given = std::getenv("GNOMON_SCENES");
  return given != nullptr && *given != '\0' ? fs::path(given) : resource_root() / ".." / "shared" / "scenes";
}

void add_scene(Suite& suite, const fs::path& path) {
  const fs::path clean = fs::weakly_canonical(path);
  if (std::find(suite.scenes.begin(), suite.scenes.end(), clean) == suite.scenes.end())
    suite.scenes.push_back(clean);
}

void read_scene(SuiteReading& reading, const std::string& text, const std::string& place) {
  fs::path path;
  const bool real = text.starts_with(kScenesVariable);
  if (real) {
    const fs::path folder = real_scenes_folder();
    if (!fs::is_directory(folder)) {
      reading.suite.notices.push_back(
          fmt::format("no folder {}: '{}' is left out (set GNOMON_SCENES to the folder of scenes)",
                      folder.lexically_normal().string(), text));
      return;
    }
    path = folder / fs::path(text.substr(kScenesVariable.size())).relative_path();
  } else {
    path = fs::path(reading.file).parent_path() / text;
  }
  if (fs::is_directory(path)) {
    for (const fs::path& scene : scenes_in(path)) add_scene(reading.suite, scene);
  } else if (text.find_first_of("*?[") != std::string::npos) {
    const auto found = matches(path);
    if (found.empty())
      reading.suite.notices.push_back(fmt::format("no scene matches '{}'", path.lexically_normal().string()));
    for (const fs::path& scene : found) add_scene(reading.suite, scene);
  } else if (fs::is_regular_file(path)) {
    add_scene(reading.suite, path);
  } else if (real) {
    reading.suite.notices.push_back(fmt::format("no scene {}", path.lexically_normal().string()));
  } else {
    reading.problems.add(fmt::format("no such scene '{}'", path.lexically_normal().string()), reading.file,
                         place, "scenes are relative to the suite file");
  }
}

}  // namespace

void read_scenes(SuiteReading& reading, const json* scenes, const std::string& place) {
  if (scenes == nullptr || !scenes->is_array() || scenes->empty()) {
    reading.problems.add("'scenes' must be a list of files", reading.file, place,
                         "[\"../../assets/scenes/fence.glb\"]");
    return;
  }
  for (size_t i = 0; i < scenes->size(); ++i) {
    const std::string here = fmt::format("{}/{}", place, i);
    if ((*scenes)[i].is_string())
      read_scene(reading, (*scenes)[i].get<std::string>(), here);
    else
      reading.problems.add("a scene must be a string", reading.file, here);
  }
  if (reading.suite.scenes.empty() && reading.problems.empty())
    reading.problems.add("none of the scenes exists", reading.file, place);
}

}  // namespace gnomon
