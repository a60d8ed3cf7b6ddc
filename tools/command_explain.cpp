// gnomon explain: what of a technique runs on this scene, and why.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <optional>

#include "bench/run/rounds.h"
#include "bench/run/statistics.h"
#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"
#include "engine/scene/wide_spot.h"
#include "tools/cli.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

struct Options {
  std::string scene, graph, size = "1280x720";
  std::vector<std::string> set;
  DeviceFlags device;
  uint32_t camera = 0, repeat = 5;
  double light_scale = 1;
  bool plan = false;
};

// Without a device.
Plan plan_of(const Scene& scene, const Graph& graph, const Options& options) {
  const Extent size = parse_size(options.size);
  const Camera& camera = camera_of(scene, options.camera);
  Declaration::Setting setting;
  setting.viewport = size;
  setting.lights = static_cast<uint32_t>(scene.lights.size());
  setting.memory = options.device.memory;
  for (const Light& light : scene.lights) setting.light_types.push_back(view_type(light));
  setting.scene = scene_sizes(scene);
  return compile(graph, setting, scene_facts(scene, camera, double(size.width) / size.height, size.height));
}

// A frame as it is, and one with everything kept.
struct Measured {
  std::unique_ptr<Renderer> lean;
  std::string device;
  double lean_ms = 0, full_ms = 0;                     // of a frame
  std::map<std::string, double> lean_pass, full_pass;  // GPU ms of each pass, all of its iterations and parts
  MemoryUse lean_memory, full_memory;
};

// "refine.maps" is a part of the pass "refine".
std::map<std::string, double> pass_times(const Samples& samples) {
  std::map<std::string, std::vector<double>> frames;
  for (const FrameTiming& frame : samples.isolated) {
    std::map<std::string, double> sums;
    for (const PassTiming& pass : frame.passes) sums[pass.id.substr(0, pass.id.find('.'))] += pass.gpu_ms;
    for (const auto& [id, ms] : sums) frames[id].push_back(ms);
  }
  std::map<std::string, double> medians;
  for (const auto& [id, all] : frames) medians[id] = median(all);
  return medians;
}

// Frames in turn with a run that keeps all.
Measured measure(const std::shared_ptr<const Scene>& scene, const Graph& graph, const Options& options,
                 std::vector<LeftOutPass>& left_out) {
  const auto device = open_device(options.device);
  RenderSettings settings;
  const Extent size = parse_size(options.size);
  settings.width = size.width;
  settings.height = size.height;
  settings.camera = options.camera;
  settings.memory = options.device.memory;
  auto lean = std::make_unique<Renderer>(device, scene, graph, settings);
  settings.keep_all = true;
  Renderer full(device, scene, graph, settings);
  const auto lean_subject = subject_of(*lean), full_subject = subject_of(full);
  const std::vector<Samples> samples =
      run_rounds({lean_subject.get(), full_subject.get()}, {2, options.repeat, options.repeat});
  for (const Samples& one : samples)
    if (!one.error.empty()) fail(one.error);
  left_out = lean->left_out();
  const MemoryUse lean_memory = lean->memory();
  return {std::move(lean),
          device_info(*device).name,
          median(samples[0].frame_ms()),
          median(samples[1].frame_ms()),
          pass_times(samples[0]),
          pass_times(samples[1]),
          lean_memory,
          full.memory()};
}

std::string ms_or_nothing(const std::map<std::string, double>& times, const std::string& pass) {
  const auto found = times.find(pass);
  return found == times.end() ? "" : fmt::format("{:.3f}", found->second);
}

void print_pass(const std::string& id, const std::string& type, const std::string& state,
                const std::string& why, const Measured* measured) {
  std::string line = fmt::format("  {:<9} {:<12} {:<20}", state, id, type);
  if (measured != nullptr)
    line += fmt::format(" {:>10} {:>10}", ms_or_nothing(measured->lean_pass, id),
                        ms_or_nothing(measured->full_pass, id));
  print("{}{}{}\n", line, why.empty() ? "" : "  ", why);
}

void print_passes(const Plan& plan, const std::vector<LeftOutPass>& left_out, const Measured* measured) {
  if (measured != nullptr) print("  {:<43} {:>10} {:>10}\n", "", "ms", "keeping all");
  for (const PlanNode& node : plan.nodes) {
    std::string folded;
    for (const auto& [port, constant] : node.constant_inputs)
      if (constant) folded += (folded.empty() ? "constant: " : ", ") + port;
    print_pass(node.id, node.type, "kept", folded, measured);
    for (const LeftOutPass& part : left_out)
      if (part.pass == node.id && !part.part.empty())
        print("            without {}: {}\n", part.part, part.reason);
  }
  for (const LeftOut& pass : plan.left_out) print_pass(pass.id, pass.type, "left out", pass.reason, measured);
}

void print_saved(const Measured& m) {
  constexpr double kMebibyte = 1024.0 * 1024.0;
  print("\na frame on {}: {:.3f} ms, keeping all {:.3f} ms: {:.3f} ms saved\n", m.device, m.lean_ms,
        m.full_ms, m.full_ms - m.lean_ms);
  const double lean = double(m.lean_memory.transient_bytes) / kMebibyte;
  const double full = double(m.full_memory.transient_bytes) / kMebibyte;
  print("memory of its images and buffers: {:.2f} MiB, keeping all {:.2f} MiB: {:.2f} MiB saved\n", lean,
        full, full - lean);
}

void explain_command(const Options& options) {
  const Values set = parse_set(options.set);
  parse_size(options.size);
  const Graph graph = load_graph(find_graph(options.graph), set);
  const auto scene = open_scene(options.scene, options.light_scale);
  print("{} on {}, {}\n", graph.name, scene->name, options.size);
  std::vector<LeftOutPass> left_out;
  std::optional<Measured> measured;
  if (options.repeat > 0) measured = measure(scene, graph, options, left_out);
  Plan without_device;
  if (!measured) without_device = plan_of(*scene, graph, options);
  const Plan& plan = measured ? measured->lean->plan() : without_device;
  print_passes(plan, left_out, measured ? &*measured : nullptr);
  if (options.plan) print_lines(stdout, "\n" + to_text(plan));
  if (measured)
    print_saved(*measured);
  else if (plan.left_out.empty())
    print("no pass is left out\n");
}

}  // namespace

void add_explain(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "explain", "which passes run on a scene, which are left out, why, and what that saves");
  command
      ->add_option("SCENE", options->scene, "a .glb or .gltf file, or the name of a scene in assets/scenes")
      ->required();
  command
      ->add_option("--graph,-g", options->graph, "technique: a name of 'gnomon list graphs', or a graph file")
      ->required()
      ->type_name("NAME|FILE");
  command->add_option("--size", options->size, "pixels")->type_name("WxH")->capture_default_str();
  command->add_option("--set", options->set, "a variable of the graph; may be repeated")
      ->type_name("NAME=VALUE")
      ->take_all();
  command->add_option("--camera", options->camera, "index of the scene's camera")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option(
          "--repeat", options->repeat,
          "frames measured, in turn with a run that keeps all; 0: none, and only whole passes are reported")
      ->type_name("N")
      ->capture_default_str();
  add_light_scale(*command, options->light_scale);
  command->add_flag("--plan", options->plan,
                    "print the compiled plan, too: resources, memory, barriers, segments");
  add_device_options(*command, options->device);
  command->footer("Example:\n  gnomon explain hills --graph rbsm_conservative --plan");
  command->callback([options, &status] {
    explain_command(*options);
    status = exit_done;
  });
}

}  // namespace gnomon
