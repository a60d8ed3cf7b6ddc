// What passes say of shadow maps and of maps made of them: the keys of traits, and how a reader takes them.
#pragma once

#include <string>

#include "engine/graph/pass.h"

namespace gnomon {

// Keys. A reader's shaders see them as parameters of the same names.
namespace map_trait {
inline constexpr const char* kEncoding = "encoding";           // how depth is stored; of maps of depth
inline constexpr const char* kBias = "bias";                   // how self-shadowing is avoided
inline constexpr const char* kBiasConstant = "bias_constant";  // texels, as the two below
inline constexpr const char* kBiasSlope = "bias_slope";
inline constexpr const char* kBiasNormal = "bias_normal";
inline constexpr const char* kBasis = "basis";  // what depth was transformed to; absent: it is depth
inline constexpr const char* kSpace = "space";
inline constexpr const char* kPrecision = "precision";
inline constexpr const char* kExponent = "exponent";
inline constexpr const char* kNegativeExponent = "negative_exponent";
inline constexpr const char* kTerms = "terms";
inline constexpr const char* kKernel =
    "kernel";  // texels: width of the filter that was applied; absent: none
inline constexpr const char* kLargestKernel = "largest_kernel";  // texels; of summed-area tables alone
inline constexpr const char* kLeast = "least";  // values that the ends of a table's steps stand for
inline constexpr const char* kGreatest = "greatest";
inline constexpr const char* kPyramid = "pyramid";  // true: least and greatest depths of a map's blocks
}  // namespace map_trait

// Steepest slope that a receiver's plane is followed along, as a tangent: beyond, the plane is nearly edge-on
// to the light and one texel covers more depth than any bias could (87 degrees). Shaders of passes that
// declare or read a map of depth know it as MAX_SLOPE.
inline constexpr double kSteepestSlope = 20;

// How a map of depth was made and is to be compared with.
struct DepthMapTraits {
  std::string encoding = "perspective", bias = "receiver_plane";
  double bias_constant = 0, bias_slope = 0, bias_normal = 0;  // texels
};

// Of a pass that makes such a map: parameters `encoding`, `bias`, `bias_constant`, `bias_slope`,
// `bias_normal`, whose defaults depend on the method.
DepthMapTraits declare_depth_map(Declaration& d);
void set_depth_map(Declaration& d, const std::string& output, const DepthMapTraits& traits);

// Of a reader: the same as derived values. What is connected must be depth from the light, unfiltered.
DepthMapTraits read_depth_map(Declaration& d, const std::string& input);
// Of a reader of a pyramid of such a map: anything else is refused.
void read_pyramid(Declaration& d, const std::string& input);
// `encoding` alone.
void read_encoding(Declaration& d, const std::string& input);

// The text of a trait of an input's source, or `standard` where it has none (listing).
std::string text_trait(const Declaration& d, const std::string& input, const char* key, std::string standard);
double number_trait(const Declaration& d, const std::string& input, const char* key, double standard);
int64_t integer_trait(const Declaration& d, const std::string& input, const char* key, int64_t standard);

}  // namespace gnomon
