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
#include "engine/truth/reference.h"
#include "tools/cli.h"
#include "tools/terminal.h"

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

std::string domain_of(uint32_t light) { return light == 0 ? "domain" : fmt::format("light{}.domain", light); }

// Reference::domain; every pixel counts when the reference says nothing of it.
std::vector<uint8_t> read_domain(const Image& reference, uint32_t light) {
  std::vector<uint8_t> domain(size_t(reference.width) * reference.height, Reference::counted);
  if (!reference.has(domain_of(light))) return domain;
  const auto values = reference.plane(domain_of(light));
  for (size_t i = 0; i < domain.size(); ++i) {
    const bool known = values[i] >= 0 && values[i] <= UINT8_MAX;
    domain[i] = known ? static_cast<uint8_t>(std::ceil(values[i])) : uint8_t{UINT8_MAX};
  }
  return domain;
}

[[noreturn]] void fail_without(const fs::path& file, const Image& image, const std::string& channel) {
  fail(fmt::format("no channel '{}'; it has: {}", channel, fmt::join(image.channels, ", ")), file.string(),
       {}, "--channel names another one, --channel luminance compares that of R, G and B");
}

// One channel of each, whatever they are called.
MeasuredError compare_channel(const Options& options, const Image& result, const Image& reference) {
  const std::string& name = options.channel;
  const std::string truth = reference.has("Y") && !reference.has(name) ? "Y" : name;
  const std::vector<uint8_t> domain = read_domain(reference, 0);
  MeasuredError error;
  error.lights.push_back({compare_visibility(scalar_values(result, name, options.result.string()),
                                             scalar_values(reference, truth, options.reference.string()),
                                             domain, result.width, result.height),
                          why_none_counts(domain)});
  error.all = over_lights(error.lights);
  return error;
}

MeasuredError compare_images(const Options& options) {
  const Image result = read_exr(options.result), reference = read_exr(options.reference);
  if (result.width != reference.width || result.height != reference.height)
    fail(fmt::format("{}x{} pixels, but the reference has {}x{}", result.width, result.height,
                     reference.width, reference.height),
         options.result.string());
  if (!options.channel.empty()) return compare_channel(options, result, reference);
  if (!reference.has(visibility_channel(0))) fail_without(options.reference, reference, "Y");
  MeasuredError error;
  for (uint32_t light = 0; reference.has(visibility_channel(light)); ++light) {
    const std::string channel = visibility_channel(light);
    if (!result.has(channel)) fail_without(options.result, result, channel);
    const std::vector<uint8_t> domain = read_domain(reference, light);
    error.lights.push_back({compare_visibility(result.plane(channel), reference.plane(channel), domain,
                                               result.width, result.height),
                            why_none_counts(domain)});
  }
  if (result.has(visibility_channel(uint32_t(error.lights.size()))))
    fail(fmt::format("has more lights than the reference, which has {}", error.lights.size()),
         options.result.string());
  error.all = over_lights(error.lights);
  return error;
}

void print_metrics(const json& lights) {
  for (size_t light = 0; light < lights.size(); ++light) {
    if (lights.size() > 1) print("light {}\n", light);
    for (const auto& [name, value] : lights[light].items())
      print("{:<18}{}\n", name,
            value.is_null()     ? std::string("-")
            : value.is_string() ? value.get<std::string>()
                                : value.dump());
  }
}

// Whether a bound is exceeded or the result is not finite; says so. Where no pixel counts there is no figure
// that could exceed one.
bool failed(const Options& options, const MeasuredError& error) {
  bool bad = false;
  const auto check = [&](const char* name, double value, double bound) {
    if (bound < 0 || value <= bound) return;
    print(stderr, "gnomon: {}: {} is {:g}, above {:g}\n", options.result.string(), name, value, bound);
    bad = true;
  };
  for (const LightError& light : error.lights) {
    check("the number of values that are not finite", double(light.nonfinite), 0);
    if (light.pixels == 0 && light.nonfinite == 0) continue;
    check("misclassified", light.misclassified, options.max_misclassified);
    check("rmse", light.rmse, options.max_rmse);
  }
  return bad;
}

int compare_command(const Options& options) {
  const MeasuredError error = compare_images(options);
  const json object = to_json(error);
  const std::string text = object.dump(2);
  if (!options.json_file.empty()) write_text(options.json_file, text + "\n");
  if (options.json_output && options.json_file.empty())
    print_lines(stdout, text + "\n");
  else
    print_metrics(object["lights"]);
  return failed(options, error) ? exit_failed : exit_done;
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
are not finite make the exit status 1. 'gnomon list metrics' says what each figure is. JSON is an object as "error" in
run.json: the means over the lights, and "lights", a list with each one's figures. Where no pixel of a light counts its
figures are empty (null, printed as -) and "reason" says why.

Examples:
  gnomon reference fence --out fence.exr && gnomon render fence -g shadow_mapping --out out/fence
  gnomon compare out/fence/visibility.exr fence.exr --max-misclassified 0.01)");
  command->callback([options, command, &status] {
    options->json_output = command->count("--json") > 0;
    status = compare_command(*options);
  });
}

}  // namespace gnomon
