// What a summed-area table says of itself, and how its readers take it.
#include "passes/filtered/summed_area.h"

#include <fmt/format.h>

#include <utility>

#include "passes/map/map_traits.h"

namespace gnomon {
namespace {

// What the values of a source can be, by its basis (shaders/glsl/lib/moment_warp.glsl).
std::pair<double, double> standard_range(const Declaration& d, const std::string& source) {
  const std::string basis = text_trait(d, source, map_trait::kBasis, "");
  if (basis == "variance") return {-0.5, 0.5};
  const bool half = text_trait(d, source, map_trait::kPrecision, "single") == "half";
  if (basis.starts_with("fourier") || (basis == "four_moments" && !half)) return {-1, 1};
  return {0, 1};
}

constexpr int64_t kStandardKernel = 128, kMostKernel = 4096;  // texels
constexpr double kMostValue = 1e6;

ParamSpec number_spec(const char* name, double standard, const char* help) {
  return {name, ParamType::number, standard, -kMostValue, kMostValue, {}, "1", help};
}
ParamSpec kernel_spec(int64_t standard) {
  return {map_trait::kLargestKernel,
          ParamType::integer,
          standard,
          2,
          double(kMostKernel),
          {},
          "texels",
          "integer: side of the largest square that is read; the smaller, the finer the steps"};
}
constexpr const char *kNumbers = "numbers", *kPair = "integer_pair";  // a trait, too
ParamSpec numbers_spec(const std::string& standard) {
  return {
      kNumbers,
      ParamType::choice,
      standard,
      0,
      0,
      {"integer", kPair, "float"},
      {},
      "integer: 32 bits that wrap, whose error depends on the kernel and not on the map; integer_pair: twice "
      "as many, for values of many magnitudes; float: loses digits with every texel from the corner on"};
}
constexpr const char* kLeastHelp = "integer: values below become this one";
constexpr const char* kGreatestHelp = "integer: values above become this one";

}  // namespace

TableNumbers declare_table(Declaration& d, const std::string& source) {
  const ParamSpec numbers = numbers_spec("integer");
  const std::string chosen = d.choice(numbers.name, "integer", numbers.choices, numbers.help);
  const ParamSpec kernel = kernel_spec(kStandardKernel);
  d.integer(kernel.name, kStandardKernel, int64_t(kernel.min), kMostKernel, kernel.unit, kernel.help);
  const auto [low, high] = standard_range(d, source);
  const double least = d.number(map_trait::kLeast, low, -kMostValue, kMostValue, "1",
                                std::string(kLeastHelp) + "; the basis' own");
  const double greatest = d.number(map_trait::kGreatest, high, -kMostValue, kMostValue, "1",
                                   std::string(kGreatestHelp) + "; the basis' own");
  if (greatest <= least) d.refuse(map_trait::kGreatest, "above 'least'");
  if (chosen == "float") return TableNumbers::floating;
  return chosen == kPair ? TableNumbers::integer_pair : TableNumbers::integer;
}

void set_table(Declaration& d, const std::string& output) {
  const Params params = d.params();
  for (const char* key : {kNumbers, map_trait::kLargestKernel, map_trait::kLeast, map_trait::kGreatest})
    d.set_trait(output, key, params.values().find(key)->second);
}

void read_table(Declaration& d, const std::string& input, bool wanted) {
  const bool table = d.trait(input, map_trait::kLargestKernel) != nullptr;
  if (d.is_connected(input) && wanted && !table)
    d.refuse_source(input, "is no summed-area table, which a width for each pixel needs");
  if (table && !wanted)
    d.refuse_source(input, "is a summed-area table, which cannot be read without a width for each pixel");
  d.derived(input, numbers_spec(text_trait(d, input, kNumbers, "integer")));
  d.derived(input, kernel_spec(integer_trait(d, input, map_trait::kLargestKernel, kStandardKernel)));
  d.derived(input, number_spec(map_trait::kLeast, number_trait(d, input, map_trait::kLeast, 0), kLeastHelp));
  d.derived(input, number_spec(map_trait::kGreatest, number_trait(d, input, map_trait::kGreatest, 1),
                               kGreatestHelp));
}

uint32_t table_steps(const Params& params) {
  const auto side = uint64_t(params.integer(map_trait::kLargestKernel));
  return uint32_t(uint64_t{0xFFFFFFFF} / (side * side));
}

Defines table_defines(const ImageShape& table, const Params& params) {
  const bool integers = table.format == VK_FORMAT_R32_UINT || table.format == VK_FORMAT_R32G32_UINT ||
                        table.format == VK_FORMAT_R32G32B32A32_UINT;
  return {{"TABLE_STEPS", fmt::format("{}.0", table_steps(params))}, {"TABLE_INTEGER", integers ? "1" : "0"}};
}

}  // namespace gnomon
