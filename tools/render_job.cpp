// Checks the options of `gnomon render` and loads what they name.
#include "tools/render_job.h"

#include <fmt/format.h>

#include "engine/base/config.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

std::vector<Capture> parse_captures(const std::vector<std::string>& texts) {
  std::vector<Capture> captures;
  Problems problems;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    const size_t dot = text.find('.');
    if (equals == std::string::npos || dot == std::string::npos || dot == 0 || dot + 1 >= equals ||
        fs::path(text.substr(equals + 1)).extension() != ".exr")
      problems.add(fmt::format("'{}' is not NODE.PORT=FILE.exr", text), {}, "--capture",
                   "--capture mean.result=mean.exr");
    else
      captures.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  problems.raise();
  return captures;
}

// Samples of the reference; empty: none wanted.
std::optional<uint32_t> reference_samples(const RenderOptions& options) {
  if (options.reference == "none") return options.error ? std::optional<uint32_t>(0) : std::nullopt;
  const Value value = parse_value(options.reference);
  const auto* samples = std::get_if<std::int64_t>(&value);
  if (samples == nullptr || *samples < 0 || *samples > (1 << 20))
    fail(fmt::format("reference '{}' is neither a number of samples nor none", options.reference), {},
         "--reference", "--reference 0 for hard shadows");
  return static_cast<uint32_t>(*samples);
}

RenderSettings settings_of(const RenderOptions& options) {
  RenderSettings settings;
  const Extent size = parse_size(options.size);
  settings.width = size.width;
  settings.height = size.height;
  settings.camera = options.camera;
  settings.reversed_z = parse_camera_z(options.camera_z);
  settings.alias = !options.no_alias;
  settings.keep_all = options.keep_all;
  settings.memory = options.device.memory;
  return settings;
}

}  // namespace

RenderJob prepare(const RenderOptions& options) {
  RenderJob job;
  job.settings = settings_of(options);
  job.captures = parse_captures(options.capture);
  for (const Capture& capture : job.captures) job.settings.captures.push_back(capture.port);
  job.samples = reference_samples(options);
  const Values set = parse_set(options.set);
  if (options.repeat < 1) fail("at least one frame is measured", {}, "--repeat");
  if (!(options.fps > 0 && options.fps <= 1e6))
    fail(fmt::format("{} frames a second: must be above 0 and at most 1e6", options.fps), {}, "--fps");
  if (options.write_frames && options.frames == 0)
    fail("there are no frames to write", {}, "--write-frames", "--frames N renders a sequence");
  job.settings.frame_seconds = 1.0 / options.fps;
  job.frames = options.frames;
  job.write_frames = options.write_frames;
  const fs::path file = find_scene(options.scene);
  job.graph = load_graph(find_graph(options.graph), set);
  job.scene = open_scene(file.string(), options.light_scale);
  camera_of(*job.scene, options.camera);
  return job;
}

ReferenceSettings reference_settings(const RenderJob& job) {
  ReferenceSettings settings;
  settings.width = job.settings.width;
  settings.height = job.settings.height;
  settings.samples = *job.samples;
  settings.camera = job.settings.camera;
  return settings;
}

}  // namespace gnomon
