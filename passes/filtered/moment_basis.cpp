// What a pre-filtered shadow map holds: the basis that depth is transformed to.
#include "passes/filtered/moment_basis.h"
#include "engine/graph/pass.h"

#include <fmt/format.h>

#include <array>

#include "passes/map/map_traits.h"

namespace gnomon {
namespace {

// Largest exponents whose powers are finite: ln of the largest float (3.4e38)
// and half float (65504), and for second moments half of that, rounded down to
// leave the filter's rounding room.
struct ExponentLimits {
  double first, second;
};
constexpr ExponentLimits kFloat{88.7, 42.0}, kHalf{11.08, 5.54};
// In log space nothing overflows; beyond this, single-precision depth itself is
// too coarse.
constexpr double kLogLimit = 10000.0;

// Of powers that are at most 1. A table of pairs tells them apart over 24 of their logarithm.
constexpr double kDepthExponentLimit = 40.0, kDepthExponent = 24.0;

double standard_exponent(const std::string& basis, bool half) {
  if (basis == "exponential_depth") return kDepthExponent;
  if (basis == "exponential") return half ? 10.0 : 80.0;
  return half ? 5.0 : 40.0;
}

double exponent_limit(const std::string& basis, bool half, bool log) {
  if (log) return kLogLimit;
  if (basis == "exponential_depth") return kDepthExponentLimit;
  const ExponentLimits& limits = half ? kHalf : kFloat;
  return basis == "exponential" ? limits.first : limits.second;
}

void refuse_beyond(Declaration& d, const std::string& name, double value, double limit, bool half) {
  if (value > limit)
    d.refuse(name, fmt::format("at most {} with this basis and {}-bit floats, "
                               "which overflow beyond",
                               limit, half ? 16 : 32));
}

VkFormat format_of(const std::string& basis, bool half) {
  if (basis == "exponential") return half ? VK_FORMAT_R16_SFLOAT : VK_FORMAT_R32_SFLOAT;
  if (basis == "variance" || basis == "exponential_variance" || basis == "exponential_depth")
    return half ? VK_FORMAT_R16G16_SFLOAT : VK_FORMAT_R32G32_SFLOAT;
  if (basis == "four_moments" && half) return VK_FORMAT_R16G16B16A16_UNORM;
  return half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

using Choices = std::vector<std::string>;

constexpr std::array<const char*, 6> kBasisKeys = {map_trait::kBasis,
                                                   map_trait::kSpace,
                                                   map_trait::kPrecision,
                                                   map_trait::kExponent,
                                                   map_trait::kNegativeExponent,
                                                   map_trait::kTerms};

ParamSpec choice(const char* name, const Choices& choices, const char* help) {
  return {name, ParamType::choice, choices.front(), 0, 0, choices, {}, help};
}

ParamSpec basis_spec() {
  return choice(
      map_trait::kBasis,
      {"variance", "exponential", "exponential_variance", "exponential_variance_4", "four_moments", "fourier",
       "exponential_depth", "fourier_depth"},
      "functions of depth that are averaged; the last two also times depth, which tells how far what "
      "hides the light is");
}

ParamSpec precision_spec() {
  return choice(map_trait::kPrecision, {"single", "half"},
                "of stored numbers: 32-bit floats, or 16 bits: floats, for four_moments quantised");
}

ParamSpec space_spec() {
  return choice(map_trait::kSpace, {"linear", "log"},
                "what is averaged: the basis itself or, exponential only, its logarithm's exponential, which "
                "no exponent overflows (Lauritzen and McCool 2008, section 4)");
}

ParamSpec exponent_spec(const std::string& basis, bool half) {
  return {
      map_trait::kExponent,
      ParamType::number,
      standard_exponent(basis, half),
      1,
      kLogLimit,
      {},
      "per depth range",
      "exponential bases: steepness of the warp; finite in 32-bit floats up to 88.7 (second moments: 42), "
      "in 16-bit ones up to 11.08 (5.54)"};
}

ParamSpec negative_exponent_spec(bool half) {
  return {map_trait::kNegativeExponent,
          ParamType::number,
          half ? 5.0 : 20.0,
          1,
          kFloat.second,
          {},
          "per depth range",
          "exponential_variance_4: steepness of the negative warp, limited as the exponent is"};
}

ParamSpec terms_spec() {
  return {map_trait::kTerms, ParamType::integer, int64_t{8}, 1, 32, {}, "terms", "fourier: of the series"};
}

ParamSpec kernel_spec() {
  return {map_trait::kKernel,
          ParamType::integer,
          int64_t{1},
          1,
          63,
          {},
          "texels",
          "width of the filter that was applied"};
}

// What the source says; the spec's own value where it says nothing.
void derive(Declaration& d, const std::string& input, ParamSpec spec) {
  if (const Value* said = d.trait(input, spec.name)) spec.default_value = *said;
  d.derived(input, std::move(spec));
}

}  // namespace

MomentLayout declare_basis(Declaration& d) {
  const auto choose = [&](const ParamSpec& s) {
    return d.choice(s.name, std::get<std::string>(s.default_value), s.choices, s.help);
  };
  const auto number = [&](const ParamSpec& s) {
    return d.number(s.name, std::get<double>(s.default_value), s.min, s.max, s.unit, s.help);
  };
  const std::string basis = choose(basis_spec());
  const bool half = choose(precision_spec()) == "half";
  const bool log = choose(space_spec()) == "log";
  const double exponent = number(exponent_spec(basis, half));
  const double limit = exponent_limit(basis, half, log);
  if (basis.starts_with("exponential")) refuse_beyond(d, map_trait::kExponent, exponent, limit, half);
  if (log && basis != "exponential") d.refuse(map_trait::kSpace, "\"linear\" with this basis");
  const double negative = number(negative_exponent_spec(half));
  if (basis == "exponential_variance_4")
    refuse_beyond(d, map_trait::kNegativeExponent, negative, limit, half);
  const ParamSpec series = terms_spec();
  const int64_t terms = d.integer(series.name, std::get<int64_t>(series.default_value), int64_t(series.min),
                                  int64_t(series.max), series.unit, series.help);
  const auto pairs = uint32_t((terms + 1) / 2);
  const uint32_t layers = basis == "fourier"             ? pairs
                          : basis == "fourier_depth"     ? 2 * pairs
                          : basis == "exponential_depth" ? 2
                                                         : 1;
  return {format_of(basis, half), layers};
}

void set_basis(Declaration& d, const std::string& output) {
  const Params params = d.params();
  for (const char* key : kBasisKeys) d.set_trait(output, key, params.values().find(key)->second);
}

bool read_space(Declaration& d, const std::string& input) {
  if (d.trait(input, map_trait::kEncoding) && !d.trait(input, map_trait::kBasis))
    d.refuse_source(input, "holds depth, whose average is no depth");
  const std::string basis = text_trait(d, input, map_trait::kBasis, "variance");
  derive(d, input, space_spec());
  derive(d, input, exponent_spec(basis, false));
  return text_trait(d, input, map_trait::kSpace, "linear") == "log";
}

void read_basis(Declaration& d, const std::string& input) {
  if (d.is_connected(input) && !d.trait(input, map_trait::kBasis))
    d.refuse_source(input, d.trait(input, map_trait::kEncoding) ? "holds depth, and not a transform of it"
                                                                : "is no map of a light's depth");
  const std::string basis = text_trait(d, input, map_trait::kBasis, "variance");
  const bool half = text_trait(d, input, map_trait::kPrecision, "single") == "half";
  for (ParamSpec spec : {basis_spec(), space_spec(), precision_spec(), exponent_spec(basis, half),
                         negative_exponent_spec(half), terms_spec()})
    derive(d, input, std::move(spec));
}

void read_kernel(Declaration& d, const std::string& input) { derive(d, input, kernel_spec()); }

Defines moment_defines(const ImageShape& image, uint32_t views) {
  const Defines layers = {{"MOMENT_LAYERS", std::to_string(image.layers / views)}};
  const auto with = [&](const char* type, const char* swizzle) {
    Defines all = layers;
    all.emplace_back("MOMENTS", type);
    all.emplace_back("MOMENT_SWIZZLE", swizzle);
    return all;
  };
  switch (image.format) {
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R32_SFLOAT:
      return with("float", "x");
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
      return with("vec2", "xy");
    default:
      return with("vec4", "xyzw");
  }
}

}  // namespace gnomon
