// What `gnomon render` is asked for, checked before anything is rendered.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/graph.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"
#include "engine/truth/reference.h"
#include "tools/cli.h"

namespace gnomon {

struct RenderOptions {
  std::string scene, graph, size = "1280x720", camera_z = "reversed", reference = "none";
  std::vector<std::string> set, capture;
  std::filesystem::path out, json_file, export_folder;
  DeviceFlags device;
  uint32_t camera = 0, repeat = 5, warmup = 2, frames = 0;
  double fps = 30, light_scale = 1;
  bool no_alias = false, keep_all = false, error = false, write_frames = false;
};

struct Capture {
  std::string port;
  std::filesystem::path file;
};

struct RenderJob {  // everything the options say, checked
  std::shared_ptr<const Scene> scene;
  Graph graph;
  RenderSettings settings;
  std::vector<Capture> captures;
  std::optional<uint32_t> samples;
  uint32_t frames = 0;  // of a sequence; 0: none
  bool write_frames = false;
};

// Loads scene and graph. Error: all that is wrong with the options.
RenderJob prepare(const RenderOptions& options);
// Of a job that has samples.
ReferenceSettings reference_settings(const RenderJob& job);

}  // namespace gnomon
