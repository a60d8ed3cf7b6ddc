// gnomon edt: the distance transform of a mask.
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/run/row.h"
#include "bench/run/statistics.h"
#include "engine/base/error.h"
#include "tools/cli.h"
#include "tools/edt.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Options {
  fs::path mask, out, json_file;
  EdtSettings settings{.repeat = 5};
  DeviceFlags device;
};

void check_options(const Options& options) {
  if (options.out.extension() != ".exr")
    fail("distances are written as EXR only", options.out.string(), "OUT", "name it FILE.exr");
  if (options.settings.repeat < 1) fail("at least one run is measured", {}, "--repeat");
}

json describe(const Options& options, const Image& mask, const EdtRun& run, const Device& device) {
  const EdtSettings& settings = options.settings;
  uint64_t sites = 0;
  for (const float v : mask.data) sites += v != 0;
  json row = {{"mask", options.mask.string()},      {"algorithm", settings.algorithm},
              {"size", {mask.width, mask.height}},  {"sites", sites},
              {"device", device_info(device).name}, {"gpu_ms", to_json(summarise(run.gpu_ms))}};
  for (const auto& [step, ms] : run.step_ms) row["steps"][step]["gpu_ms"] = to_json(summarise(ms));
  if (settings.algorithm == "bounded_exact") row["radius"] = settings.radius;
  if (settings.algorithm == "jump_flooding") row["variant"] = settings.variant;
  return row;
}

void add_error(json& row, const EdtRun& run, const EdtRun& exact, uint32_t width) {
  const EdtError error = edt_error(run.nearest, exact.nearest, width);
  row["wrong_pixels"] = error.wrong;
  row["largest_error"] = std::isfinite(error.largest) ? json(error.largest) : json(nullptr);
}

void print_row(const json& row) {
  print("{}: {}x{} pixels, {} sites\n", row["algorithm"].get<std::string>(), row["size"][0].get<int>(),
        row["size"][1].get<int>(), row["sites"].get<uint64_t>());
  const json& ms = row["gpu_ms"];
  print("  {:.3f} ms (median of {}, MAD {:.3f})\n", ms["median"].get<double>(), ms["n"].get<int>(),
        ms["mad"].get<double>());
  for (const auto& [step, times] : row["steps"].items())
    print("  {:<8} {:.3f} ms\n", step, times["gpu_ms"]["median"].get<double>());
  if (row.contains("wrong_pixels"))
    print("  {} wrong pixels, largest error {} pixels\n", row["wrong_pixels"].get<uint64_t>(),
          row["largest_error"].dump());
}

int edt_command(const Options& options) {
  check_options(options);
  const auto mask = std::make_shared<const Image>(edt_mask(read_image(options.mask), options.mask.string()));
  const auto device = open_device(options.device);
  const EdtRun run = run_edt(device, mask, options.settings);
  json row = describe(options, *mask, run, *device);
  if (options.settings.algorithm == "jump_flooding") {
    EdtSettings exact = options.settings;
    exact.algorithm = "banded_exact", exact.warmup = 0, exact.repeat = 1;
    add_error(row, run, run_edt(device, mask, exact), mask->width);
  }
  write_exr(options.out, edt_distance(run.nearest, mask->width, mask->height));
  if (!options.json_file.empty()) write_text(options.json_file, row.dump(2) + "\n");
  print_row(row);
  return report_validation(*device);
}

}  // namespace

void add_edt(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("edt", "the Euclidean distance transform of a mask");
  EdtSettings& settings = options->settings;
  command
      ->add_option("MASK", options->mask,
                   "PNG or EXR; pixels that are not 0 in any channel but alpha are sites")
      ->required();
  command->add_option("OUT", options->out, "EXR for the distances in pixels; infinite where there is no site")
      ->required();
  command->add_option("--algorithm", settings.algorithm, "banded_exact, bounded_exact or jump_flooding")
      ->capture_default_str();
  command
      ->add_option("--variant", settings.variant,
                   "of jump_flooding: jfa, one_plus_jfa, jfa_plus_one or jfa_squared")
      ->capture_default_str();
  command->add_option("--radius", settings.radius, "pixels; bounded_exact finds no site beyond")
      ->capture_default_str();
  command->add_option("--repeat", settings.repeat, "runs that are measured")->capture_default_str();
  command->add_option("--json", options->json_file, "times, and the error of an approximate transform")
      ->type_name("FILE");
  add_device_options(*command, options->device);
  command->footer(
      R"(The time is the transform's alone: neither the image's way to the device nor that of the result back is in it.

Example:
  gnomon edt mask.png distance.exr --algorithm jump_flooding --variant jfa_squared --json figures.json)");
  command->callback([options, &status] {
    options->settings.memory = options->device.memory;
    status = edt_command(*options);
  });
}

}  // namespace gnomon
