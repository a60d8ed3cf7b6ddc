// gnomon render: one technique on one scene: images, timings, and the error when asked for.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/error/truth.h"
#include "bench/run/rounds.h"
#include "bench/run/row.h"
#include "engine/base/error.h"
#include "engine/scene/animation.h"
#include "engine/vulkan/shader.h"
#include "tools/cli.h"
#include "tools/print_run.h"
#include "tools/render_export.h"
#include "tools/render_frames.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// `seconds`: of the scene's time that the images show.
MeasuredError error_of(const RenderJob& job, const RenderedImages& images, double seconds) {
  Progress progress("reference " + job.scene->name);
  ReferenceSettings settings = reference_settings(job);
  settings.progress = [&](double share) { progress.update(share); };
  const bool finite_color = images.color && count_nonfinite(*images.color) == 0;
  const auto scene =
      job.scene->animation ? std::make_shared<const Scene>(posed(*job.scene, seconds)) : job.scene;
  return Truth(scene, settings, cache_folder())
      .error(images.visibility, finite_color ? &*images.color : nullptr, job.graph);
}

// Runs the frames; what the last one that was measured without time stamps shows.
RenderedImages measure(const RenderJob& job, const RenderOptions& options, Renderer& renderer,
                       OutputFolder& folder, Row& row) {
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
  const Samples samples = run_rounds({subject.get()}, rounds, {}, hook).front();
  if (!samples.error.empty()) fail(samples.error, options.graph);
  describe_samples(row, samples);
  if (frames) {
    row.nonfinite = frames->nonfinite;
    describe_sequence(row, frames->result);
    return std::move(frames->images);
  }
  RenderedImages images = read_images(renderer, job);
  row.nonfinite = count_nonfinite(images);
  return images;
}

Row asked_row(const RenderOptions& options, const RenderJob& job, const Device& device) {
  Row row;
  describe_graph(row, job.graph);
  set_scene(row, fs::weakly_canonical(job.scene->file));
  row.set = parse_set(options.set);
  row.size = {job.settings.width, job.settings.height};
  row.camera = options.camera;
  row.light_scale = options.light_scale;
  row.reversed_z = job.settings.reversed_z;
  row.alias = job.settings.alias;
  row.keep_all = job.settings.keep_all;
  row.memory.limit_bytes = job.settings.memory;
  row.device = device_info(device);
  return row;
}

int render_command(const RenderOptions& options) {
  RenderJob job = prepare(options);
  std::vector<std::string> maps;
  if (!options.export_folder.empty()) {
    check_export_folder(options.export_folder);
    maps = shadow_map_ports(job);
    auto& captures = job.settings.captures;
    for (const std::string& port : maps)
      if (std::find(captures.begin(), captures.end(), port) == captures.end()) captures.push_back(port);
  }
  const auto device = open_device(options.device);
  Renderer renderer(device, job.scene, job.graph, job.settings);
  Row row = asked_row(options, job, *device);
  const fs::path out = options.out.empty()
                           ? fs::path("out") / as_file_name(job.scene->name + "-" + job.graph.name)
                           : options.out;
  OutputFolder folder(out);
  const RenderedImages images = measure(job, options, renderer, folder, row);
  describe_renderer(row, renderer);
  for (const std::string& warning : row.warnings) warn(warning);
  const double seconds = job.frames > 0 ? (job.frames - 1) * job.settings.frame_seconds : 0.0;
  if (job.samples) {
    row.reference = RowReference{*job.samples};
    row.error = error_of(job, images, seconds);
  }
  std::optional<OutputFolder> exported;
  if (!options.export_folder.empty()) {
    exported.emplace(options.export_folder);
    write_export(*exported, job, renderer, images.visibility, maps, seconds);
  }
  if (row.nonfinite > 0)
    row.status = fmt::format("error: {} values of the output are not finite", row.nonfinite);

  const std::string run = to_json(row).dump(2, ' ', false, json::error_handler_t::replace) + "\n";
  write_images(folder, images);
  write_text(folder.file("run.json"), run);
  for (const auto& [file, image] : images.captured) write_exr(file, image);
  if (!options.json_file.empty()) write_text(options.json_file, run);
  folder.keep();
  if (exported) exported->keep();

  print_run(row);
  print("  {}\n", out.string());
  if (row.nonfinite > 0) {
    print(stderr, "gnomon: {}\n", row.status);
    return exit_failed;
  }
  return report_validation(*device);
}

void add_options(CLI::App& command, RenderOptions& o) {
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
  command
      .add_option(
          "--export", o.export_folder,
          "write depth, normal, albedo, position, shadow maps with their views, and the visibility of "
          "technique and reference to this new folder")
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
  auto options = std::make_shared<RenderOptions>();
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
  gnomon render fence -g shadow_mapping --export out/frame --reference 256
  gnomon render fence -g shadow_mapping --capture map.depth=map.exr --device lavapipe)");
  command->callback([options, &status] { status = render_command(*options); });
}

}  // namespace gnomon
