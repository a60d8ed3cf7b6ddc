// gnomon compare: the error of one visibility image against another.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/error/measure.h"
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "engine/truth/metrics.h"
#include "tools/cli.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Options {
  fs::path result, reference, json_file;
  std::string channel;  // empty: Y, light1.Y, ...
  bool json_output = false;
  double max_misclassified = -1, max_rmse = -1;  // negative: no bound
};

std::string channel_of(size_t light) { return light == 0 ? "Y" : fmt::format("light{}.Y", light); }
std::string domain_of(size_t light) { return light == 0 ? "domain" : fmt::format("light{}.domain", light); }

// 0 where the reference counts the pixel; every pixel when it has no domain.
std::vector<uint8_t> read_domain(const Image& reference, size_t light) {
  std::vector<uint8_t> domain(size_t(reference.width) * reference.height, 0);
  if (!reference.has(domain_of(light))) return domain;
  const auto values = reference.plane(domain_of(light));
  for (size_t i = 0; i < domain.size(); ++i) domain[i] = values[i] == 0 ? 0 : 1;
  return domain;
}

[[noreturn]] void fail_without(const fs::path& file, const Image& image, const std::string& channel) {
  fail(fmt::format("no channel '{}'; it has: {}", channel, fmt::join(image.channels, ", ")), file.string(),
       {}, "--channel names another one, --channel luminance compares that of R, G and B");
}

std::vector<ErrorMetrics> compare_images(const Options& options) {
  const Image result = read_exr(options.result), reference = read_exr(options.reference);
  if (result.width != reference.width || result.height != reference.height)
    fail(fmt::format("{}x{} pixels, but the reference has {}x{}", result.width, result.height,
                     reference.width, reference.height),
         options.result.string());
  std::vector<ErrorMetrics> lights;
  if (!options.channel.empty()) {
    const std::string& name = options.channel;
    const std::string truth = reference.has("Y") && !reference.has(name) ? "Y" : name;
    return {compare_visibility(scalar_values(result, name, options.result.string()),
                               scalar_values(reference, truth, options.reference.string()),
                               read_domain(reference, 0), result.width, result.height)};
  }
  for (size_t light = 0; light == 0 || reference.has(channel_of(light)); ++light) {
    const auto truth = [&] {
      if (!reference.has(channel_of(light))) fail_without(options.reference, reference, "Y");
      return reference.plane(channel_of(light));
    }();
    if (!result.has(channel_of(light))) fail_without(options.result, result, channel_of(light));
    lights.push_back(compare_visibility(result.plane(channel_of(light)), truth, read_domain(reference, light),
                                        result.width, result.height));
  }
  if (result.has(channel_of(lights.size())))
    fail(fmt::format("has more lights than the reference, which has {}", lights.size()),
         options.result.string());
  return lights;
}

json to_json_rows(const std::vector<ErrorMetrics>& lights) {
  json rows = json::array();
  for (const ErrorMetrics& metrics : lights) rows.push_back(to_json(metrics));
  return rows;
}

void print_metrics(const std::vector<ErrorMetrics>& lights) {
  for (size_t light = 0; light < lights.size(); ++light) {
    if (lights.size() > 1) fmt::print("light {}\n", light);
    const json metrics = to_json(lights[light]);
    for (const auto& [name, value] : metrics.items()) fmt::print("{:<18}{}\n", name, value.dump());
  }
}

// Whether a bound is exceeded or the result is not finite; says so.
bool failed(const Options& options, const std::vector<ErrorMetrics>& lights) {
  bool bad = false;
  const auto check = [&](const char* name, double value, double bound) {
    if (bound < 0 || value <= bound) return;
    fmt::print(stderr, "gnomon: {}: {} is {:g}, above {:g}\n", options.result.string(), name, value, bound);
    bad = true;
  };
  for (const ErrorMetrics& metrics : lights) {
    check("misclassified", metrics.misclassified, options.max_misclassified);
    check("rmse", metrics.rmse, options.max_rmse);
    check("the number of values that are not finite", double(metrics.nonfinite), 0);
  }
  return bad;
}

int compare_command(const Options& options) {
  const std::vector<ErrorMetrics> lights = compare_images(options);
  const json rows = to_json_rows(lights);
  const std::string text = (lights.size() == 1 ? rows[0] : rows).dump(2);
  if (!options.json_file.empty()) write_text(options.json_file, text + "\n");
  if (options.json_output && options.json_file.empty())
    fmt::print("{}\n", text);
  else
    print_metrics(lights);
  return failed(options, lights) ? exit_failed : exit_done;
}

}  // namespace

void add_compare(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("compare", "the error of a visibility image against a reference");
  command->add_option("RESULT", options->result, "visibility.exr of a run")->required();
  command
      ->add_option("REFERENCE", options->reference,
                   "an EXR that 'gnomon reference' wrote, or any with a channel Y")
      ->required();
  command
      ->add_option(
          "--channel", options->channel,
          "the result's channel instead of Y, or a layer; luminance: that of R, G and B. The reference's "
          "is Y where it lacks this one")
      ->type_name("NAME");
  command->add_option("--json", options->json_file, "print JSON, or with FILE write it there")
      ->type_name("[FILE]")
      ->expected(0, 1);
  command
      ->add_option("--max-misclassified", options->max_misclassified, "exit status 1 above this share (0..1)")
      ->type_name("X");
  command->add_option("--max-rmse", options->max_rmse, "exit status 1 above this RMSE")->type_name("X");
  command->footer(
      R"(Counted are the pixels whose domain in the reference is 0; without a channel 'domain' all of them. Values that
are not finite make the exit status 1. 'gnomon list metrics' says what each figure is.

Examples:
  gnomon reference fence --out fence.exr && gnomon render fence -g shadow_mapping --out out/fence
  gnomon compare out/fence/visibility.exr fence.exr --max-misclassified 0.01)");
  command->callback([options, command, &status] {
    options->json_output = command->count("--json") > 0;
    status = compare_command(*options);
  });
}

}  // namespace gnomon
