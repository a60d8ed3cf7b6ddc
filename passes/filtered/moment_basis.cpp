// What a pre-filtered shadow map holds: the basis that depth is transformed to.
#include "passes/filtered/moment_basis.h"
#include "engine/graph/pass.h"

#include <fmt/format.h>

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

double standard_exponent(const std::string& basis, bool half) {
  if (basis == "exponential") return half ? 10.0 : 80.0;
  return half ? 5.0 : 40.0;
}

double exponent_limit(const std::string& basis, bool half, bool log) {
  if (log) return kLogLimit;
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
  if (basis == "variance" || basis == "exponential_variance")
    return half ? VK_FORMAT_R16G16_SFLOAT : VK_FORMAT_R32G32_SFLOAT;
  if (basis == "four_moments" && half) return VK_FORMAT_R16G16B16A16_UNORM;
  return half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

}  // namespace

std::string declare_space(Declaration& d) {
  return d.choice("space", "linear", {"linear", "log"},
                  "what is averaged: the basis itself or, exponential only, "
                  "its logarithm's exponential, which no "
                  "exponent overflows (Lauritzen and McCool 2008, section 4)");
}

double declare_exponent(Declaration& d, double standard) {
  return d.number("exponent", standard, 1, kLogLimit, "per depth range",
                  "exponential bases: steepness of the warp; finite in 32-bit "
                  "floats up to 88.7 (second moments: 42), in "
                  "16-bit ones up to 11.08 (5.54)");
}

MomentLayout declare_basis(Declaration& d) {
  const std::string basis = d.choice("basis", "variance",
                                     {"variance", "exponential", "exponential_variance",
                                      "exponential_variance_4", "four_moments", "fourier"},
                                     "functions of depth that are averaged");
  const bool half = d.choice("precision", "single", {"single", "half"},
                             "of stored numbers: 32-bit floats, or 16 bits: "
                             "floats, for four_moments quantised") == "half";
  const bool log = declare_space(d) == "log";
  const double exponent = declare_exponent(d, standard_exponent(basis, half));
  const double limit = exponent_limit(basis, half, log);
  if (basis.starts_with("exponential")) refuse_beyond(d, "exponent", exponent, limit, half);
  if (log && basis != "exponential") d.refuse("space", "\"linear\" with this basis");
  const double negative = d.number("negative_exponent", half ? 5.0 : 20.0, 1, 42, "per depth range",
                                   "exponential_variance_4: steepness of the negative warp, "
                                   "limited as the exponent is");
  if (basis == "exponential_variance_4") refuse_beyond(d, "negative_exponent", negative, limit, half);
  const int64_t terms = d.integer("terms", 8, 1, 32, "terms", "fourier: of the series");
  const uint32_t layers = basis == "fourier" ? uint32_t((terms + 1) / 2) : 1;
  return {format_of(basis, half), layers};
}

Defines moment_defines(const ImageShape& image, uint32_t faces) {
  const Defines layers = {{"MOMENT_LAYERS", std::to_string(image.layers / faces)}};
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
