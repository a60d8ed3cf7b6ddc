// What passes say of maps of depth: encoding and bias.
#include "passes/map/map_traits.h"

#include <array>

namespace gnomon {
namespace {

using Choices = std::vector<std::string>;

const Choices& encodings() {
  static const Choices names{"perspective", "linear"};
  return names;
}

const Choices& bias_methods() {
  static const Choices names{"none",          "constant",  "slope_scaled", "receiver_plane",
                             "normal_offset", "back_face", "midpoint"};
  return names;
}

constexpr const char* kEncodingHelp = "depth in the shadow map (Rzeczkowski 2024, eq. 3.6 or 3.7)";
constexpr const char* kBiasHelp = "how self-shadowing is avoided";

// In texels.
struct Shift {
  const char* name;
  double DepthMapTraits::*value;
  const char* help;
};
constexpr double kMostShift = 1000;  // texels
constexpr std::array<Shift, 3> kShifts = {{
    {map_trait::kBiasConstant, &DepthMapTraits::bias_constant, "shift of the receiver towards the light"},
    {map_trait::kBiasSlope, &DepthMapTraits::bias_slope, "further shift, times the receiver's slope"},
    {map_trait::kBiasNormal, &DepthMapTraits::bias_normal,
     "shift along the geometric normal, times the sine of the light's angle to it (normal_offset)"},
}};

// Chosen by measurement (bench/suites/bias.json) as the least bias that leaves no acne.
void set_bias_defaults(DepthMapTraits& t) {
  const auto set = [&](double constant, double slope, double normal) {
    t.bias_constant = constant, t.bias_slope = slope, t.bias_normal = normal;
  };
  if (t.bias == "constant") set(8.0, 0.0, 0.0);
  if (t.bias == "slope_scaled") set(1.0, 1.5, 0.0);
  if (t.bias == "receiver_plane") set(0.5, 0.2, 0.0);
  if (t.bias == "normal_offset") set(1.0, 0.0, 2.0);
  if (t.bias == "back_face") set(1.0, 1.5, 0.0);
  if (t.bias == "midpoint") set(1.0, 1.5, 0.0);
}

ParamSpec choice(const char* name, const std::string& value, const Choices& choices, const char* help) {
  return {name, ParamType::choice, value, 0, 0, choices, {}, help};
}

void refuse_what_is_no_depth(Declaration& d, const std::string& input) {
  if (!d.is_connected(input)) return;
  if (d.trait(input, map_trait::kBasis))
    d.refuse_source(input, "holds a transform of depth to be filtered, not depth");
  else if (!d.trait(input, map_trait::kEncoding))
    d.refuse_source(input, "is no map of depth from the light");
  else if (d.trait(input, map_trait::kKernel))
    d.refuse_source(input, "holds filtered depth, which no test can be made of");
}

}  // namespace

DepthMapTraits declare_depth_map(Declaration& d) {
  DepthMapTraits t;
  d.constant("MAX_SLOPE", kSteepestSlope);
  t.encoding = d.choice(map_trait::kEncoding, t.encoding, encodings(), kEncodingHelp);
  t.bias = d.choice(map_trait::kBias, t.bias, bias_methods(), kBiasHelp);
  set_bias_defaults(t);
  for (const Shift& shift : kShifts)
    t.*shift.value = d.number(shift.name, t.*shift.value, 0, kMostShift, "texels", shift.help);
  return t;
}

void set_depth_map(Declaration& d, const std::string& output, const DepthMapTraits& traits) {
  d.set_trait(output, map_trait::kEncoding, traits.encoding);
  d.set_trait(output, map_trait::kBias, traits.bias);
  for (const Shift& shift : kShifts) d.set_trait(output, shift.name, traits.*shift.value);
}

void read_encoding(Declaration& d, const std::string& input) {
  d.constant("MAX_SLOPE", kSteepestSlope);
  refuse_what_is_no_depth(d, input);
  const std::string encoding = text_trait(d, input, map_trait::kEncoding, encodings().front());
  d.derived(input, choice(map_trait::kEncoding, encoding, encodings(), kEncodingHelp));
}

DepthMapTraits read_depth_map(Declaration& d, const std::string& input) {
  DepthMapTraits t;
  d.constant("MAX_SLOPE", kSteepestSlope);
  refuse_what_is_no_depth(d, input);
  t.encoding = text_trait(d, input, map_trait::kEncoding, t.encoding);
  t.bias = text_trait(d, input, map_trait::kBias, t.bias);
  set_bias_defaults(t);
  d.derived(input, choice(map_trait::kEncoding, t.encoding, encodings(), kEncodingHelp));
  d.derived(input, choice(map_trait::kBias, t.bias, bias_methods(), kBiasHelp));
  for (const Shift& shift : kShifts) {
    t.*shift.value = number_trait(d, input, shift.name, t.*shift.value);
    d.derived(input,
              {shift.name, ParamType::number, t.*shift.value, 0, kMostShift, {}, "texels", shift.help});
  }
  return t;
}

void read_pyramid(Declaration& d, const std::string& input) {
  if (d.is_connected(input) && !d.trait(input, map_trait::kPyramid))
    d.refuse_source(input, "is no pyramid of least and greatest depths");
}

std::string text_trait(const Declaration& d, const std::string& input, const char* key,
                       std::string standard) {
  const Value* value = d.trait(input, key);
  return value ? std::get<std::string>(*value) : std::move(standard);
}

double number_trait(const Declaration& d, const std::string& input, const char* key, double standard) {
  const Value* value = d.trait(input, key);
  return value ? std::get<double>(*value) : standard;
}

int64_t integer_trait(const Declaration& d, const std::string& input, const char* key, int64_t standard) {
  const Value* value = d.trait(input, key);
  return value ? std::get<int64_t>(*value) : standard;
}

}  // namespace gnomon
