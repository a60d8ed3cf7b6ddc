// gnomon explain: what of a technique runs on this scene, and why.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "bench/rounds.h"
#include "bench/statistics.h"
#include "engine/compile.h"
#include "engine/config.h"
#include "engine/error.h"
#include "tools/cli.h"

namespace gnomon {
namespace {

struct Options {
  std::string scene, graph, size = "1280x720";
  std::vector<std::string> set;
  DeviceFlags device;
  uint32_t camera = 0, repeat = 5;
  bool plan = false;
};

Plan plan_of(const Scene& scene, const Graph& graph, const Options& options) {
  const Extent size = parse_size(options.size);
  const Camera& camera = camera_of(scene, options.camera);
  Declaration::Setting setting;
  setting.viewport = size;
  setting.lights = static_cast<uint32_t>(scene.lights.size());
  setting.map_faces = 0;
  for (const Light& light : scene.lights) setting.map_faces += light.type == LightType::point ? 6 : 1;
  return compile(graph, setting, scene_facts(scene, camera, camera.aspect.value_or(double(size.width) / size.height), size.height));
}

void print_passes(const Plan& plan) {
  for (const PlanNode& node : plan.nodes) {
    std::string folded;
    for (const auto& [port, constant] : node.constant_inputs)
      if (constant) folded += (folded.empty() ? "  constant: " : ", ") + port;
    fmt::print("  kept      {:<20}{:<24}{}\n", node.id, node.type, folded);
  }
  for (const LeftOut& pass : plan.left_out)
    fmt::print("  left out  {:<20}{:<24}{}\n", pass.id, pass.type, pass.reason);
}

// Frames in turn with a run that keeps all; ms of a frame.
void print_time_saved(const std::shared_ptr<const Scene>& scene, const Graph& graph, const Options& options) {
  const auto device = open_device(options.device);
  RenderSettings settings;
  const Extent size = parse_size(options.size);
  settings.width = size.width;
  settings.height = size.height;
  settings.camera = options.camera;
  Renderer lean(device, scene, graph, settings);
  settings.keep_all = true;
  Renderer full(device, scene, graph, settings);
  const auto lean_subject = subject_of(lean), full_subject = subject_of(full);
  const std::vector<Samples> samples =
      run_rounds({lean_subject.get(), full_subject.get()}, {2, options.repeat, options.repeat});
  for (const Samples& one : samples)
    if (!one.error.empty()) fail(one.error);
  const double lean_ms = median(samples[0].frame_ms()), full_ms = median(samples[1].frame_ms());
  fmt::print("\ntime on {}: {:.3f} ms a frame, {:.3f} ms when nothing is left out: {:.3f} ms saved\n",
             device_info(*device).name, lean_ms, full_ms, full_ms - lean_ms);
  std::map<std::string, std::vector<double>> by_pass;
  for (const FrameTiming& frame : samples[1].isolated)
    for (const PassTiming& pass : frame.passes) by_pass[pass.id].push_back(pass.gpu_ms);
  for (const LeftOutPass& pass : lean.left_out())
    if (by_pass.count(pass.pass) != 0)
      fmt::print("  {:<20}{:.3f} ms\n", pass.pass, median(by_pass[pass.pass]));
}

void explain_command(const Options& options) {
  const Values set = parse_set(options.set);
  parse_size(options.size);
  const Graph graph = load_graph(find_graph(options.graph), set);
  const auto scene = open_scene(options.scene);
  const Plan plan = plan_of(*scene, graph, options);
  fmt::print("{} on {}, {}\n", graph.name, scene->name, options.size);
  print_passes(plan);
  if (options.plan) fmt::print("\n{}", to_text(plan));
  if (plan.left_out.empty())
    fmt::print("nothing is left out\n");
  else if (options.repeat > 0)
    print_time_saved(scene, graph, options);
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
  command->add_option("--repeat", options->repeat, "frames measured for the time saved; 0: do not measure")
      ->type_name("N")
      ->capture_default_str();
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
