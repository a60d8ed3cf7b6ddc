// gnomon stability: every technique along the axes from an ordinary scene to extreme ones.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/run/progress.h"
#include "bench/stability/stability.h"
#include "bench/stability/stability_cases.h"
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "tools/cli.h"
#include "tools/output_folder.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> graphs, axes, skipped;
  std::optional<std::string> test;
  fs::path out, json_file;
  double timeout = StabilityPlace().timeout;  // seconds a case
  bool quick = false, resume = false, overwrite = false;
  DeviceFlags device;
};

StabilityOptions stability_options(const Options& options) {
  StabilityOptions result;
  result.quick = options.quick;
  result.memory = options.device.memory;
  for (const std::string& test : options.skipped) result.skipped.push_back(parse_stability_case(test));
  return result;
}

std::vector<fs::path> graphs_of(const Options& options) {
  std::vector<fs::path> files;
  for (const std::string& name : options.graphs) files.push_back(find_graph(name));
  if (options.graphs.empty()) files = all_graphs();
  for (const fs::path& file : files) load_graph(file);
  return files;
}

void print_row(const StabilityRow& row, const StabilityOptions& options) {
  std::map<StabilityVerdict, size_t> count;
  for (const StabilityFinding& f : row.findings) ++count[f.verdict];
  using enum StabilityVerdict;
  print("{:<24}{} cases: {} hold, {} warned of, {} refused, {} degrade, {} fail\n", row.name,
        row.findings.size(), count[holds], count[warned], count[refuses], count[degrades], count[fails]);
  for (const auto& [axis, sentence] : stated_domain(row)) print("  {:<18}{}\n", axis, sentence);
  for (const StabilityFinding& f : row.findings)
    if (f.verdict == StabilityVerdict::fails) {
      print("  first failure: {}\n    {}\n", f.reason, reproduce(row, f.test, options));
      break;
    }
  std::fflush(stdout);
}

bool any_broken(const StabilityRow& row) {
  return std::any_of(row.findings.begin(), row.findings.end(), [](const auto& f) { return f.broken; });
}

int report(const std::vector<StabilityRow>& rows, const Options& options) {
  const StabilityOptions walk = stability_options(options);
  const std::string json =
      to_json(rows, walk).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (!options.out.empty()) {
    OutputFolder folder(options.out);
    write_text(folder.file("stability.json"), json);
    write_text(folder.file("stability.md"), stability_report(rows, walk));
    folder.keep();
  }
  if (!options.json_file.empty()) write_text(options.json_file, json);
  return std::any_of(rows.begin(), rows.end(), any_broken) ? exit_failed : exit_done;
}

int walk(const Options& options, StabilityCases& cases) {
  const std::vector<fs::path> graphs = graphs_of(options);
  const auto run = [&](const fs::path& graph, const StabilityCase& test, bool area) {
    return cases.run(graph, test, area);
  };
  std::vector<StabilityRow> rows;
  Progress progress("stability");
  for (size_t i = 0; i < graphs.size(); ++i) {
    const auto tell = [&](double share, const std::string& test) {
      progress.update((double(i) + share) / double(graphs.size()), graphs[i].stem().string() + " " + test);
    };
    rows.push_back(walk_stability(graphs[i], cases.follows_light(graphs[i]), stability_options(options),
                                  options.axes, run, tell));
    print_row(rows.back(), stability_options(options));
  }
  progress.done();
  return report(rows, options);
}

void print_case(const StabilityFinding& finding, const StabilityRow& row) {
  print("{}, {}: {}{}{}\n", row.name, to_string(finding.test), to_string(finding.verdict),
        finding.reason.empty() ? "" : ": ", finding.reason);
  print_lines(stdout,
              to_json(finding.measured).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

int one_case(const Options& options, StabilityCases& cases) {
  const StabilityCase test = parse_stability_case(*options.test);
  std::vector<StabilityRow> rows;
  for (const fs::path& graph : graphs_of(options)) {
    StabilityRow row;
    row.graph = graph, row.name = graph.stem().string();
    row.area = cases.follows_light(graph);
    row.base = cases.run(graph, {}, row.area);
    const StabilityMeasurement measured = cases.run(graph, test, row.area);
    row.findings.push_back(judge_stability(test, measured, row.base));
    print_case(row.findings.back(), row);
    rows.push_back(std::move(row));
  }
  const int status = report(rows, options);
  const auto fails = [](const StabilityRow& row) {
    return row.findings.front().verdict == StabilityVerdict::fails;
  };
  return std::any_of(rows.begin(), rows.end(), fails) ? exit_failed : status;
}

void check_axes(const std::vector<std::string>& wanted) {
  std::vector<std::string> names;
  for (const StabilityAxis& axis : stability_axes()) names.push_back(axis.name);
  Problems problems;
  for (const std::string& name : wanted)
    if (std::find(names.begin(), names.end(), name) == names.end())
      problems.add(fmt::format("no axis '{}'", name), {}, "--axis", did_you_mean(name, names));
  problems.raise();
}

int stability_command(const Options& options) {
  check_axes(options.axes);
  StabilityPlace place;
  place.device = {options.device.part, options.device.validation};
  place.apart = !options.quick;
  place.timeout = options.timeout;
  place.out = options.out;
  place.resume = options.resume;
  place.overwrite = options.overwrite;
  const auto cases = stability_cases(stability_options(options), place);
  return options.test ? one_case(options, *cases) : walk(options, *cases);
}

std::string footer() {
  std::string text = "Axes:\n";
  for (const StabilityAxis& axis : stability_axes())
    text += fmt::format("  {:<18}{} ({})\n", axis.name, axis.help, axis.unit);
  return text +
         "\nExamples:\n  gnomon stability --quick\n  gnomon stability --graph evsm --axis exponent --axis "
         "offset\n"
         "  gnomon stability --graph evsm --case exponent=200,scale=1e-6";
}

}  // namespace

void add_stability(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("stability", "where techniques hold, degrade and fail on the way to extreme scenes");
  command
      ->add_option("--graph,-g", options->graphs,
                   "a technique, may be repeated (default: all of 'gnomon list graphs')")
      ->type_name("NAME|FILE")
      ->take_all();
  command->add_option("--axis", options->axes, "an axis, may be repeated (default: all)")
      ->type_name("NAME")
      ->take_all();
  command
      ->add_option("--case", options->test,
                   "this case alone, with its measurements; base for the ordinary scene")
      ->type_name("AXIS=VALUE,...");
  command->add_flag("--quick", options->quick,
                    "small images, one or two points on each axis, no pairs, all in this process");
  command->add_option("--timeout", options->timeout, "seconds for a case")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  command
      ->add_option("--skip", options->skipped,
                   "leave this point of an axis out, may be repeated: the largest take minutes on a CPU")
      ->type_name("AXIS=VALUE")
      ->take_all();
  CLI::Option* out = command->add_option("--out,-o", options->out,
                                         "folder for stability.json, stability.md and cases.jsonl");
  out->type_name("DIR");
  CLI::Option* resume =
      command->add_flag("--resume", options->resume, "go on: what --out's cases.jsonl holds is not run again")
          ->needs(out);
  command->add_flag("--overwrite", options->overwrite, "throw away what --out holds")
      ->needs(out)
      ->excludes(resume);
  command->add_option("--json", options->json_file, "write stability.json here as well")->type_name("FILE");
  add_device_options(*command, options->device);
  command->footer(footer());
  command->callback([options, &status] { status = stability_command(*options); });
}

}  // namespace gnomon
