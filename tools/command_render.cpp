// gnomon render: one technique on one scene: images, timings, and the error when asked for.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/error/truth.h"
#include "bench/run/progress.h"
#include "bench/run/rounds.h"
#include "bench/run/run_json.h"
#include "bench/run/sequence.h"
#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "engine/scene/animation.h"
#include "engine/vulkan/shader.h"
#include "tools/cli.h"
#include "tools/output_folder.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Options {
  std::string scene, graph, size = "1280x720", camera_z = "reversed", reference = "none";
  std::vector<std::string> set, capture;
  fs::path out, json_file;
  DeviceFlags device;
  uint32_t camera = 0, repeat = 5, warmup = 2, frames = 0;
  double fps = 30, light_scale = 1;
  bool no_alias = false, keep_all = false, error = false, write_frames = false;
};

struct Capture {
  std::string port;
  fs::path file;
};

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
std::optional<uint32_t> reference_samples(const Options& options) {
  if (options.reference == "none") return options.error ? std::optional<uint32_t>(0) : std::nullopt;
  const Value value = parse_value(options.reference);
  const auto* samples = std::get_if<std::int64_t>(&value);
  if (samples == nullptr || *samples < 0 || *samples > (1 << 20))
    fail(fmt::format("reference '{}' is neither a number of samples nor none", options.reference), {},
         "--reference", "--reference 0 for hard shadows");
  return static_cast<uint32_t>(*samples);
}

struct Job {  // everything the options say, checked
  std::shared_ptr<const Scene> scene;
  Graph graph;
  RenderSettings settings;
  std::vector<Capture> captures;
  std::optional<uint32_t> samples;
  uint32_t frames = 0;  // of a sequence; 0: none
  bool write_frames = false;
};

Job prepare(const Options& options) {
  Job job;
  const Extent size = parse_size(options.size);
  job.settings.width = size.width;
  job.settings.height = size.height;
  job.settings.camera = options.camera;
  job.settings.reversed_z = parse_camera_z(options.camera_z);
  job.settings.alias = !options.no_alias;
  job.settings.keep_all = options.keep_all;
  job.settings.memory = options.device.memory;
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

struct Images {
  std::optional<Image> color;
  Image visibility;
  std::vector<std::pair<fs::path, Image>> captured;
};

Images read_images(Renderer& renderer, const Job& job) {
  Images images;
  images.visibility = renderer.read("visibility");
  if (job.graph.outputs.count("color") != 0) images.color = renderer.read("color");
  for (const Capture& capture : job.captures)
    images.captured.emplace_back(capture.file, renderer.read(capture.port));
  return images;
}

void write_images(OutputFolder& folder, const Images& images) {
  if (images.color) {
    write_png_srgb(folder.file("color.png"), rgb_of(*images.color));
    write_exr(folder.file("color.exr"), *images.color);
  }
  write_exr(folder.file("visibility.exr"), images.visibility);
}

void print_passes(const json& run) {
  fmt::print("  {:<24}{:<24}{:>10}{:>10}{:>10}\n", "pass", "type", "gpu ms", "isolated", "cpu ms");
  const auto number = [](const json& value) {
    return value.is_object() ? fmt::format("{:.3f}", value["median"].get<double>()) : std::string("-");
  };
  for (const json& pass : run["passes"]) {
    std::string id = pass["id"].get<std::string>();
    if (pass["iteration"].get<int>() > 0) id += fmt::format(" #{}", pass["iteration"].get<int>());
    fmt::print("  {:<24}{:<24}{:>10}{:>10}{:>10.3f}\n", id, pass["type"].get<std::string>(),
               number(pass["gpu_ms"]["overlapped"]), number(pass["gpu_ms"]["isolated"]),
               pass["cpu_ms"].get<double>());
  }
}

// A pass, or a part of one that runs.
void print_left_out(const json& one) {
  const auto part = one["part"].get<std::string>();
  fmt::print("  left out: {}{}{}: {}\n", one["pass"].get<std::string>(), part.empty() ? "" : ", ", part,
             one["reason"].get<std::string>());
}

void print_error(const json& error) {
  if (!error.is_object()) return;
  const auto share = [&](const char* name) {
    return error.contains(name) && error[name].is_number()
               ? fmt::format("{:.4f} %", 100 * error[name].get<double>())
               : std::string("-");
  };
  fmt::print("  error: {} misclassified ({} wrongly lit, {} wrongly shadowed), acne {}, RMSE {:.4f}\n",
             share("misclassified"), share("wrongly_lit"), share("wrongly_shadowed"), share("acne"),
             error.value("rmse", 0.0));
}

void print_sequence(const json& sequence) {
  const auto spread = [&](const char* name) {
    const json& s = sequence[name];
    return s.is_object() && s["mean"].is_number()
               ? fmt::format("{:.4f} (largest {:.4f})", s["mean"].get<double>(), s["max"].get<double>())
               : std::string("-");
  };
  fmt::print("  {} frames: mean RMSE {}, mean flicker {}\n", sequence["frames"].get<size_t>(), spread("rmse"),
             spread("flicker"));
}

void print_run(const Job& job, const json& run) {
  const json& frame = run["frame_ms"];
  fmt::print("{} on {}, {}x{}, {}\n", job.graph.name, job.scene->name, job.settings.width,
             job.settings.height, run["device"].get<std::string>());
  fmt::print("  frame {:.3f} ms (median of {}, interval {:.3f}..{:.3f}), recorded in {:.3f} ms\n",
             frame["median"].get<double>(), frame["n"].get<size_t>(), frame["ci95"][0].get<double>(),
             frame["ci95"][1].get<double>(), run["record_ms"]["median"].get<double>());
  print_passes(run);
  for (const json& pass : run["left_out"]) print_left_out(pass);
  print_error(run["error"]);
  if (run.contains("sequence")) print_sequence(run["sequence"]);
}

ReferenceSettings reference_settings(const Job& job) {
  ReferenceSettings settings;
  settings.width = job.settings.width;
  settings.height = job.settings.height;
  settings.samples = *job.samples;
  settings.camera = job.settings.camera;
  return settings;
}

// `seconds`: of the scene's time that the images show.
std::string error_of(const Job& job, const Images& images, double seconds) {
  Progress progress("reference " + job.scene->name);
  ReferenceSettings settings = reference_settings(job);
  settings.progress = [&](double share) { progress.update(share); };
  const bool finite_color = images.color && count_nonfinite(*images.color) == 0;
  const auto scene =
      job.scene->animation ? std::make_shared<const Scene>(posed(*job.scene, seconds)) : job.scene;
  return Truth(scene, settings, cache_folder())
      .error_json(images.visibility, finite_color ? &*images.color : nullptr, job.graph);
}

// Reads, measures and writes the frames of a sequence as they are shown.
class FrameReader {
 public:
  FrameReader(const Job& job, Renderer& renderer, OutputFolder& folder)
      : job_(job), renderer_(renderer), folder_(folder), progress_("frames " + job.scene->name) {
    if (job.samples)
      truth_.emplace(job.scene, reference_settings(job), cache_folder(), job.settings.frame_seconds);
  }

  void read(uint32_t index, double frame_ms) {
    const bool last = index + 1 == job_.frames;
    images = last ? read_images(renderer_, job_) : frame_images();
    nonfinite += count_nonfinite(images.visibility) + (images.color ? count_nonfinite(*images.color) : 0);
    if (job_.write_frames) write(index);
    if (truth_)
      result.add(truth_->at(index), frame_ms, images.visibility);
    else
      result.add(renderer_.seconds(), frame_ms);
    progress_.update(double(index + 1) / job_.frames);
  }

  SequenceResult result;
  Images images;  // of the last frame
  uint64_t nonfinite = 0;

 private:
  Images frame_images() const {
    Images frame;
    frame.visibility = renderer_.read("visibility");
    if (job_.write_frames && job_.graph.outputs.count("color") != 0) frame.color = renderer_.read("color");
    return frame;
  }

  void write(uint32_t index) {
    const std::string name = fmt::format("frame_{:04}_", index);
    write_exr(folder_.file(name + "visibility.exr"), images.visibility);
    if (images.color) write_png_srgb(folder_.file(name + "color.png"), rgb_of(*images.color));
  }

  const Job& job_;
  Renderer& renderer_;
  OutputFolder& folder_;
  Progress progress_;
  std::optional<SequenceTruth> truth_;
};

// Runs the frames; what the last one that was measured without time stamps shows.
Images measure(const Job& job, const Options& options, Renderer& renderer, OutputFolder& folder, Row& row) {
  const auto subject = subject_of(renderer);
  RoundSettings rounds{options.warmup, options.repeat, options.repeat};
  rounds.sequence = job.frames > 0;
  std::optional<FrameReader> frames;
  FrameHook hook;
  if (rounds.sequence) {
    rounds.repeat = job.frames;
    frames.emplace(job, renderer, folder);
    hook = [&](size_t, TimingMode mode, uint32_t index, const FrameTiming& timing) {
      if (mode == TimingMode::none) frames->read(index, timing.frame_ms);
    };
  }
  row.samples = run_rounds({subject.get()}, rounds, {}, hook).front();
  if (!row.samples.error.empty()) fail(row.samples.error, options.graph);
  if (frames) {
    row.nonfinite = frames->nonfinite;
    row.sequence = std::move(frames->result);
    return std::move(frames->images);
  }
  Images images = read_images(renderer, job);
  row.nonfinite = count_nonfinite(images.visibility) + (images.color ? count_nonfinite(*images.color) : 0);
  return images;
}

int render_command(const Options& options) {
  const Job job = prepare(options);
  const auto device = open_device(options.device);
  Renderer renderer(device, job.scene, job.graph, job.settings);
  Row row;
  describe_graph(row, job.graph);
  row.scene = fs::weakly_canonical(job.scene->file);
  row.set = parse_set(options.set);
  row.size = {job.settings.width, job.settings.height};
  row.camera = options.camera;
  row.light_scale = options.light_scale;
  row.reversed_z = job.settings.reversed_z;
  row.alias = job.settings.alias;
  row.keep_all = job.settings.keep_all;
  row.memory_limit = job.settings.memory;
  row.device = device_info(*device);
  const fs::path out =
      options.out.empty() ? fs::path("out") / (job.scene->name + "-" + job.graph.name) : options.out;
  OutputFolder folder(out);
  const Images images = measure(job, options, renderer, folder, row);
  describe_renderer(row, renderer);
  for (const std::string& warning : row.warnings) warn(warning);
  if (job.samples) {
    row.reference_samples = *job.samples;
    row.error_json =
        error_of(job, images, job.frames > 0 ? (job.frames - 1) * job.settings.frame_seconds : 0.0);
  }
  if (row.nonfinite > 0)
    row.status = fmt::format("error: {} values of the output are not finite", row.nonfinite);
  const json run = to_json(row);

  write_images(folder, images);
  write_text(folder.file("run.json"), run.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  for (const auto& [file, image] : images.captured) write_exr(file, image);
  if (!options.json_file.empty())
    write_text(options.json_file, run.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  folder.keep();

  print_run(job, run);
  fmt::print("  {}\n", out.string());
  if (row.nonfinite > 0) {
    fmt::print(stderr, "gnomon: {}\n", row.status);
    return exit_failed;
  }
  return report_validation(*device);
}

void add_options(CLI::App& command, Options& o) {
  command.add_option("SCENE", o.scene, "a .glb or .gltf file, or the name of a scene in assets/scenes")
      ->required();
  command.add_option("--graph,-g", o.graph, "technique: a name of 'gnomon list graphs', or a graph file")
      ->required()
      ->type_name("NAME|FILE");
  command.add_option("--size", o.size, "pixels")->type_name("WxH")->capture_default_str();
  command.add_option("--set", o.set, "a variable of the graph; may be repeated")
      ->type_name("NAME=VALUE")
      ->take_all();
  command.add_option("--capture", o.capture, "also write this port as EXR; may be repeated")
      ->type_name("NODE.PORT=FILE.exr")
      ->take_all();
  command.add_option("--out,-o", o.out, "folder for the images and run.json (default: out/SCENE-GRAPH)")
      ->type_name("DIR");
  command.add_option("--json", o.json_file, "write run.json here as well")->type_name("FILE");
  command.add_option("--camera", o.camera, "index of the scene's camera")
      ->type_name("N")
      ->capture_default_str();
  add_light_scale(command, o.light_scale);
  command.add_option("--camera-z", o.camera_z, "camera depth: reversed (1 near, 0 far) or standard")
      ->type_name("reversed|standard")
      ->capture_default_str();
  command.add_option("--repeat", o.repeat, "measured frames")
      ->type_name("N")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_option("--warmup", o.warmup, "frames before anything counts")
      ->type_name("N")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command
      .add_option("--frames", o.frames,
                  "render N frames in order from the scene's time 0, each with its own error and flicker")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  command.add_option("--fps", o.fps, "frames of --frames to a second of the scene's time")
      ->type_name("F")
      ->capture_default_str();
  command.add_flag("--write-frames", o.write_frames,
                   "also write frame_0000_visibility.exr and frame_0000_color.png, ... to the folder");
  command.add_flag("--error", o.error, "measure the error against the ray-traced hard shadows");
  command
      .add_option(
          "--reference", o.reference,
          "measure the error against a reference with N samples on each area light (0: hard), or none")
      ->type_name("N|none")
      ->capture_default_str();
  command.add_flag("--no-alias", o.no_alias, "give every intermediate image memory of its own");
  command.add_flag("--keep-all", o.keep_all, "run the passes that this scene does not need, too");
  add_device_options(command, o.device);
}

}  // namespace

void add_render(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "render one technique on one scene, and time it");
  add_options(*command, *options);
  command->footer(
      R"(Writes color.png (sRGB), color.exr (linear), visibility.exr (channel Y: 0 umbra, 1 lit; light1.Y, ... for
further lights; row 0 at the top) and run.json (docs/reading-the-report.md). Times are milliseconds. Of a sequence
(--frames) the images and run.json's "error" are those of the last frame, "frames" holds each one's; the warm-up frames
stand at time 0 and are forgotten before the sequence begins.

Examples:
  gnomon render fence --graph shadow_mapping
  gnomon render pendulum --graph pcf --frames 60 --reference 0 --write-frames --out out/swing
  gnomon render robot.glb --graph rbsm_conservative --set shadow_map=512 --error --out out/robot
  gnomon render fence -g shadow_mapping --capture map.depth=map.exr --device lavapipe)");
  command->callback([options, &status] { status = render_command(*options); });
}

}  // namespace gnomon
