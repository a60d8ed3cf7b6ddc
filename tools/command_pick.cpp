// gnomon pick: the technique and setting that give the most for a scene and a budget.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/report/pareto.h"
#include "bench/report/pick.h"
#include "bench/report/report_rows.h"
#include "bench/run/harness.h"
#include "bench/run/progress.h"
#include "bench/run/results.h"
#include "bench/run/stage.h"
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "engine/vulkan/shader.h"
#include "tools/cli.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Options {
  std::string scene, suite, size;
  std::vector<std::string> graphs;
  double max_ms = 0, max_error = 0;
  bool bound_ms = false, bound_error = false;
  std::string metric = "rmse";
  uint32_t repeat = 0, samples = 0, camera = 0;
  fs::path out, results, json_file;
  DeviceFlags device;
};

// A folder of rows that is thrown away, or the one that --results names and keeps.
class RowFolder {
 public:
  explicit RowFolder(const fs::path& kept)
      : path_(kept.empty() ? fs::temp_directory_path() / fmt::format("gnomon-pick-{}", getpid()) : kept),
        temporary_(kept.empty()) {}
  ~RowFolder() {
    std::error_code ignored;
    if (temporary_) fs::remove_all(path_, ignored);
  }
  RowFolder(const RowFolder&) = delete;
  RowFolder& operator=(const RowFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  bool temporary_;
};

// Keeps the configurations of the named graphs, and the baseline's, which their ratios need.
void keep_graphs(Suite& suite, const std::vector<std::string>& names) {
  if (names.empty()) return;
  std::vector<std::string> there;
  for (const SuiteConfig& config : suite.configs) there.push_back(config.graph.name);
  for (const std::string& name : names)
    if (std::find(there.begin(), there.end(), name) == there.end())
      fail(fmt::format("the suite has no settings for '{}'", name), suite.file.string(), "--graph",
           did_you_mean(name, there));
  std::vector<SuiteConfig> kept;
  std::vector<size_t> moved(suite.configs.size(), 0);
  const auto wanted = [&](size_t i) {
    const bool named = std::find(names.begin(), names.end(), there[i]) != names.end();
    return named || std::any_of(suite.configs.begin(), suite.configs.end(), [&](const SuiteConfig& config) {
             return config.baseline == i &&
                    std::find(names.begin(), names.end(), config.graph.name) != names.end();
           });
  };
  for (size_t i = 0; i < suite.configs.size(); ++i) {
    if (!wanted(i)) continue;
    moved[i] = kept.size();
    kept.push_back(suite.configs[i]);
  }
  for (SuiteConfig& config : kept)
    config.baseline =
        moved[config.baseline];  // of a baseline that nobody asked for: any; its ratio is not shown
  suite.configs = std::move(kept);
}

Suite suite_of(const Options& options) {
  const char* const standard = options.samples > 0 ? "pick_area" : "pick";
  Suite suite = load_suite(find_suite(options.suite.empty() ? standard : options.suite));
  suite.scenes = {fs::weakly_canonical(find_scene(options.scene))};
  if (!options.size.empty()) {
    suite.sizes = {parse_size(options.size)};
    for (SuiteConfig& config : suite.configs) config.sizes = suite.sizes;
  }
  if (options.samples > 0) suite.samples = options.samples;
  if (options.repeat > 0) suite.repeat = options.repeat;
  suite.camera = options.camera;
  suite.memory = options.device.memory;
  suite.instrumented = 0;
  keep_graphs(suite, options.graphs);
  return suite;
}

std::vector<Row> measure(const Options& options, const Suite& suite, const fs::path& folder) {
  BenchOptions bench;
  bench.out = folder;
  const auto device = open_device(options.device);
  bench.device = device_info(*device);
  print(stderr, "{} settings on {}\n", suite.configs.size(), bench.device.name);
  Progress progress("pick", 10);
  double share = 0;
  bench.progress = [&](double now, const std::string& note) { progress.update(share = now, note); };
  const auto tracing = [&](double, const std::string& note) { progress.update(share, note); };
  const BenchResult result = run_suite(suite, bench, device_stages(device, cache_folder(), tracing));
  progress.done();
  if (!result.stopped.empty()) fail(result.stopped);
  return read_results(result.results);
}

std::string line_of(const Row& row, const std::string& metric) {
  return fmt::format("{:>10.4g} ms {:>12.5g} {}  {}", frame_ms_of(row).value_or(0),
                     error_of(row, metric).value_or(ErrorFigure{}).value, metric, label_of(row));
}

// The choices that are not beaten in both figures, quickest first.
void print_front(const std::vector<Row>& rows, const std::string& metric) {
  std::vector<TimeAndError> candidates;
  std::vector<const Row*> of;
  for (const Row& row : rows) {
    const auto ms = frame_ms_of(row);
    const auto error = error_of(row, metric);
    if (!row.ok() || !ms || !error) continue;
    candidates.push_back({*ms, error->value});
    of.push_back(&row);
  }
  print("Worth considering (no other is quicker and more exact):\n");
  for (const size_t i : pareto_front(candidates)) print("{}\n", line_of(*of[i], metric));
}

// The configuration that `row` measured.
const SuiteConfig& config_of(const Suite& suite, const Row& row) {
  for (const SuiteConfig& config : suite.configs)
    if (config.graph.name == row.graph && config.graph.vars == row.vars) return config;
  fail("the row of '" + label_of(row) + "' is none of the suite");
}

int pick_command(const Options& options) {
  if (!options.bound_ms && !options.bound_error)
    fail("there is no bound", {}, {}, "give --max-ms X or --max-error E");
  const auto& metrics = error_metrics();
  if (std::find(metrics.begin(), metrics.end(), options.metric) == metrics.end())
    fail(fmt::format("metric '{}' is not known", options.metric), {}, "--metric",
         did_you_mean(options.metric, metrics));
  const Suite suite = suite_of(options);
  const RowFolder folder(options.results);
  std::vector<Row> rows = measure(options, suite, folder.path());
  if (!options.graphs.empty())  // the baseline was there for the ratios only
    std::erase_if(rows, [&](const Row& row) {
      return std::find(options.graphs.begin(), options.graphs.end(), row.graph) == options.graphs.end();
    });
  if (!options.json_file.empty()) write_rows(options.json_file, rows);
  for (const Row& row : rows)
    if (!row.ok()) warn(fmt::format("{}: {}", label_of(row), row.status));
  print_front(rows, options.metric);
  PickRule rule;
  if (options.bound_ms) rule.max_ms = options.max_ms;
  if (options.bound_error) rule.max_error = options.max_error;
  rule.metric = options.metric;
  const auto best = pick_row(rows, rule);
  if (!best) {
    print(stderr, "gnomon: no setting keeps the bound\n");
    return exit_failed;
  }
  const SuiteConfig& winner = config_of(suite, rows[*best]);
  const fs::path file = options.out.empty() ? fs::path(winner.graph.name + "-picked.json") : options.out;
  write_text(file, to_json(winner.graph).dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  print("Winner:\n{}\n{}\n", line_of(rows[*best], options.metric), file.string());
  return exit_done;
}

}  // namespace

void add_pick(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("pick", "the technique and setting with the least error, or time, within a bound");
  command->add_option("SCENE", options->scene, "a glTF file, or the name of a scene in assets/scenes")
      ->required();
  command
      ->add_option("--max-ms", options->max_ms,
                   "least error within this frame time (upper end of the 95 % interval of the median)")
      ->type_name("X")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-error", options->max_error, "least time with at most this error")
      ->type_name("E")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--metric", options->metric, "error metric, see 'gnomon list metrics'")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--graph,-g", options->graphs, "only these techniques")->type_name("NAME");
  command->add_option("--size", options->size, "pixels (default: the suite's)")->type_name("WxH");
  command->add_option("--camera", options->camera, "index of the scene's camera")->type_name("I");
  command
      ->add_option("--samples", options->samples,
                   "rays to each area light for the reference: soft shadows (default: hard shadows)")
      ->type_name("N")
      ->check(CLI::Range(1, 1 << 20));
  command->add_option("--repeat", options->repeat, "timed rounds, instead of the suite's")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  command
      ->add_option("--suite", options->suite,
                   "settings to try (default: bench/suites/pick.json, with --samples pick_area.json)")
      ->type_name("SUITE");
  command->add_option("--out,-o", options->out, "graph file to write (default: TECHNIQUE-picked.json)")
      ->type_name("FILE");
  command->add_option("--results", options->results, "keep the rows in this folder, for 'gnomon report'")
      ->type_name("DIR");
  command->add_option("--json", options->json_file, "write all rows as one JSON array")->type_name("FILE");
  add_device_options(*command, options->device);
  command->footer(
      R"(Measures the settings in turn, prints those that no other beats, names the winner and writes its graph file, which
'gnomon render SCENE --graph FILE' takes. Exit status 1: no setting keeps the bound.

Examples:
  gnomon pick fence --max-ms 60 --out fence.json
  gnomon pick my_scene.glb --max-error 0.05 --metric flip --size 1920x1080
  gnomon pick area_shapes --samples 256 --max-ms 400)");
  command->callback([options, command, &status] {
    options->bound_ms = command->count("--max-ms") > 0;
    options->bound_error = command->count("--max-error") > 0;
    status = pick_command(*options);
  });
}

}  // namespace gnomon
