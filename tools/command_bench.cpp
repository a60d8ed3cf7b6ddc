// gnomon bench: a suite, measured technique by technique in turn.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <ctime>
#include <memory>
#include <tuple>

#include "bench/report/compare.h"
#include "bench/report/table.h"
#include "bench/run/harness.h"
#include "bench/run/progress.h"
#include "bench/run/results.h"
#include "bench/run/stage.h"
#include "engine/base/error.h"
#include "engine/base/interrupt.h"
#include "engine/vulkan/shader.h"
#include "tools/cli.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string suite, shard = "1/1";
  std::vector<std::string> scenes;
  fs::path out, json_file, compare;
  double tolerance = 0.05;
  DeviceFlags device;
  bool resume = false, overwrite = false, images = false;
  uint32_t repeat = 0;
};

// "2/4" -> 2, 4.
std::pair<uint32_t, uint32_t> parse_shard(const std::string& text) {
  const char* const end = text.data() + text.size();
  std::pair<uint32_t, uint32_t> shard{0, 0};
  const auto first = std::from_chars(text.data(), end, shard.first);
  bool good = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  if (good) {
    const auto second = std::from_chars(first.ptr + 1, end, shard.second);
    good = second.ec == std::errc() && second.ptr == end;
  }
  if (!good || shard.first < 1 || shard.first > shard.second)
    fail(fmt::format("shard '{}' is not I/N with I in 1..N", text), {}, "--shard", "--shard 1/4");
  return shard;
}

std::string time_stamp() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &local);
  return text;
}

// Whether something became worse.
bool print_comparison(const Options& options, const std::vector<Row>& before, const std::vector<Row>& now) {
  const Comparison comparison = compare_results(before, now, options.tolerance);
  print("\nAgainst {}:\n", options.compare.string());
  print_lines(stdout, to_table(comparison));
  if (comparison.compared == 0) warn("no row of " + options.compare.string() + " is one of these");
  return comparison.regressed();
}

// Ended by a signal: says what is kept.
BenchResult run_until_interrupted(const Suite& suite, const BenchOptions& bench, const StageMaker& stages) {
  try {
    return run_suite(suite, bench, stages);
  } catch (const Interrupted&) {
    print(stderr, "\ngnomon: finished rows are in {}; the same command with --out {} --resume goes on\n",
          (bench.out / "results.jsonl").string(), bench.out.string());
    throw;
  }
}

Suite suite_of(const Options& options) {
  Suite suite = load_suite(find_suite(options.suite));
  if (!options.scenes.empty()) {
    suite.scenes.clear();
    suite.notices.clear();
    for (const std::string& scene : options.scenes)
      suite.scenes.push_back(fs::weakly_canonical(find_scene(scene)));
  }
  if (options.repeat > 0) suite.repeat = options.repeat;
  suite.memory = options.device.memory;
  suite.images = suite.images || options.images;
  for (const std::string& notice : suite.notices) print(stderr, "gnomon: note: {}\n", notice);
  return suite;
}

BenchResult measure(const Suite& suite, BenchOptions bench, const std::shared_ptr<Device>& device) {
  print(stderr, "{}: {} scenes, {} sizes, {} techniques on {}\n", suite.name, suite.scenes.size(),
        all_sizes(suite).size(), suite.configs.size(), bench.device.name);
  Progress progress("bench " + suite.name, 10);
  double share = 0;
  bench.progress = [&](double now, const std::string& note) { progress.update(share = now, note); };
  const auto tracing = [&](double, const std::string& note) { progress.update(share, note); };
  BenchResult result =
      run_until_interrupted(suite, bench, device_stages(device, cache_folder(), tracing, bench.out));
  progress.done();
  return result;
}

// Prints the rows that are there, and what became of the rest; the exit status.
int tell(const Options& options, const std::vector<Row>& old_rows, const BenchResult& result) {
  const std::vector<Row> rows = read_results(result.results);
  print_lines(stdout, "\n" + to_table(rows));
  if (result.resumed > 0) print("{} rows were there already\n", result.resumed);
  print("{}\n", result.results.string());
  if (!result.stopped.empty()) {
    print(stderr, "gnomon: {}\ngnomon: {} rows are kept in {}; --resume goes on there\n", result.stopped,
          rows.size(), result.results.string());
    return exit_failed;
  }
  if (!options.json_file.empty()) write_rows(options.json_file, rows);
  if (result.failed > 0)
    print(stderr, "gnomon: {} of {} rows failed; their status says why\n", result.failed, result.measured);
  const bool regressed = !options.compare.empty() && print_comparison(options, old_rows, rows);
  return result.failed > 0 || regressed ? exit_failed : exit_done;
}

int bench_command(const Options& options) {
  BenchOptions bench;
  std::tie(bench.shard, bench.shards) = parse_shard(options.shard);
  std::vector<Row> old_rows;
  if (!options.compare.empty()) old_rows = read_results(options.compare);
  const Suite suite = suite_of(options);
  bench.out = options.out.empty() ? fs::path("out") / (suite.name + "-" + time_stamp()) : options.out;
  bench.resume = options.resume;
  bench.overwrite = options.overwrite;
  const auto device = open_device(options.device);
  bench.device = device_info(*device);
  const BenchResult result = measure(suite, bench, device);
  int status = exit_failed;
  try {
    status = tell(options, old_rows, result);
  } catch (const Error& error) {  // of a further output: the rows are there all the same
    print_problems(error.problems());
    print(stderr, "gnomon: the rows are kept in {}\n", result.results.string());
  }
  return std::max<int>(status, report_validation(*device));
}

}  // namespace

void add_bench(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("bench", "measure a suite of techniques and scenes; ends with a table");
  command
      ->add_option("SUITE", options->suite,
                   "a suite file, or the name of one in bench/suites (demo, full, hard, ...)")
      ->required();
  command
      ->add_option(
          "--scene", options->scenes,
          "a glTF file, or the name of a scene in assets/scenes, instead of the suite's; may be repeated")
      ->type_name("SCENE")
      ->allow_extra_args(false);
  command
      ->add_option("--out,-o", options->out,
                   "folder for results.jsonl and suite.json (default: out/SUITE-TIME)")
      ->type_name("DIR");
  command->add_option("--json", options->json_file, "write all rows as one JSON array")->type_name("FILE");
  CLI::Option* resume =
      command->add_flag("--resume", options->resume,
                        "go on in --out: rows that are there with status ok are not measured again");
  command->add_flag("--overwrite", options->overwrite, "throw away the results in --out")->excludes(resume);
  command->add_option("--shard", options->shard, "measure the I-th of N equal parts of the rows (I from 1)")
      ->type_name("I/N")
      ->capture_default_str();
  command->add_option("--repeat", options->repeat, "timed rounds, instead of the suite's")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  command
      ->add_option("--compare", options->compare,
                   "rows of an earlier run: what changed, and exit status 1 when time or error became worse")
      ->type_name("OLD.jsonl");
  command
      ->add_option("--compare-tolerance", options->tolerance,
                   "share by which a ratio must differ, besides its interval, to count as a change")
      ->type_name("X")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_flag("--images", options->images,
                    "write each row's images into DIR/images, for 'gnomon report' to compare");
  add_device_options(*command, options->device);
  command->footer(
      R"(The techniques run in turn (A B C A B C ...), so that a slow spell of the machine hits all of them; 'ratio' is the
median of the ratios to the baseline in the same round. A technique that fails gives a row with its reason, the suite
goes on, and the exit status is 1; so it is when the disk is full: the rows so far are kept. Suites name scenes through $GNOMON_SCENES, too (see docs/reading-the-report.md).
--compare also tells how many 95 % intervals of the ratios overlap with the earlier run's.

Examples:
  gnomon bench demo
  gnomon bench demo --scene my_scene.glb --images --out out/mine && gnomon report out/mine
  gnomon bench hard --out out/hard
  gnomon bench hard --out out/hard --resume        after an interruption
  gnomon bench hard --out out/hard-2 --shard 2/4
  gnomon bench hard --compare out/hard/results.jsonl
tools/cluster drives shards over machines.)");
  command->callback([options, &status] { status = bench_command(*options); });
}

}  // namespace gnomon
