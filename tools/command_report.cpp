// gnomon report: results of one or several runs as a page, a table and JSON.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/report/report_data.h"
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "tools/cli.h"
#include "tools/output_folder.h"
#include "tools/report_page.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Options {
  std::vector<fs::path> places;
  fs::path out;
  uint64_t image_budget = uint64_t{48} << 20;
};

fs::path default_folder(const fs::path& place) {
  if (fs::is_directory(place)) return place;
  return place.has_parent_path() ? place.parent_path() : fs::path(".");
}

int report_command(const Options& options) {
  json report = report_data(merge_results(options.places));
  const std::string csv = report_csv(report);
  const std::string data = report.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
  embed_images(report, options.image_budget);
  const std::string page = report_page(report);
  const fs::path folder = options.out.empty() ? default_folder(options.places.front()) : options.out;
  OutputFolder output(folder);
  write_text(output.file("report.html"), page);
  write_text(output.file("report.csv"), csv);
  write_text(output.file("report.json"), data);
  output.keep();
  for (const char* name : {"report.html", "report.csv", "report.json"})
    print("{}\n", (folder / name).lexically_normal().string());
  if (report["images_left_out"] > 0)
    warn(fmt::format("{} images are over --image-budget and left out of the page",
                     report["images_left_out"].dump()));
  if (report["images_refused"] > 0)
    warn(fmt::format("{} images that rows name are no image files below their run's folder, and left out",
                     report["images_refused"].dump()));
  if (!report["failed"].empty())
    warn(fmt::format("{} rows failed; the report lists them", report["failed"].size()));
  return exit_done;
}

}  // namespace

void add_report(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("report", "error against run time: results as a page to read, CSV and JSON");
  command
      ->add_option("DIR", options->places,
                   "folders with a results.jsonl (or such files): shards and runs that belong together")
      ->required();
  command->add_option("--out,-o", options->out, "folder for the report (default: the first DIR)")
      ->type_name("DIR");
  command
      ->add_option("--image-budget", options->image_budget,
                   "limit of the images in the page, as 16MB; 0 leaves them out (default: 48MB)")
      ->transform(CLI::AsSizeValue(false))
      ->type_name("SIZE");
  command->footer(
      R"(Writes report.html (one file, no network: charts, images and data are in it), report.csv and report.json. Rows with
the same key are taken once, the latest with status ok. 'gnomon bench --images' adds the images that the page compares.

Examples:
  gnomon bench demo --images --out out/demo && gnomon report out/demo
  gnomon report out/shard-1 out/shard-2 out/shard-3 --out out/all)");
  command->callback([options, &status] { status = report_command(*options); });
}

}  // namespace gnomon
