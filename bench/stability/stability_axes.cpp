// What the axes are.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "bench/stability/stability.h"
#include "engine/base/config.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

double number_of(const std::string& axis, const std::string& text, double min, double max) {
  const Value value = parse_value(text);
  double number = 0;
  if (const auto* integer = std::get_if<std::int64_t>(&value))
    number = static_cast<double>(*integer);
  else if (const auto* real = std::get_if<double>(&value))
    number = *real;
  else
    fail(fmt::format("'{}' is no number", text), {}, axis);
  if (!(number >= min && number <= max)) fail(fmt::format("{} must be in {}..{}", text, min, max), {}, axis);
  return number;
}

constexpr uint32_t kMostPixelsASide = 16384;

Extent extent_of(const std::string& axis, const std::string& text) {
  const size_t cross = text.find('x');
  if (cross == std::string::npos) fail(fmt::format("'{}' is not WIDTHxHEIGHT", text), {}, axis);
  const auto side = [&](const std::string& digits) {
    return static_cast<uint32_t>(number_of(axis, digits, 1, kMostPixelsASide));
  };
  return {side(text.substr(0, cross)), side(text.substr(cross + 1))};
}

// An axis of one number of the scene.
template <class T>
StabilityAxis scene_axis(std::string name, std::string unit, std::string help,
                         std::vector<std::string> values, std::vector<std::string> quick,
                         T StabilitySetup::*field, double min, double max) {
  const auto apply = [=](StabilitySetup& setup, Extent&, const std::string& text) {
    setup.*field = static_cast<T>(number_of(name, text, min, max));
  };
  return {name, std::move(unit), std::move(help), std::move(values), std::move(quick), {}, {}, apply};
}

StabilityAxis variable_axis(std::string name, std::string unit, std::string help,
                            std::vector<std::string> values, std::vector<std::string> quick,
                            std::vector<std::string> variables, Values with = {}) {
  return {std::move(name),  std::move(unit),      std::move(help), std::move(values),
          std::move(quick), std::move(variables), std::move(with), {}};
}

StabilityAxis size_axis() {
  return {"size",
          "pixels",
          "of the output, odd and prime sizes among them",
          {"128x128", "97x61", "31x17", "7x5", "96x1", "1x96", "2x2", "1x1", "1021x509", "1920x1080",
           "7680x4320"},
          {"31x17", "1x1"},
          {},
          {},
          [](StabilitySetup&, Extent& size, const std::string& text) { size = extent_of("size", text); }};
}

std::vector<StabilityAxis> make_axes() {
  using S = StabilitySetup;
  std::vector<StabilityAxis> axes;
  axes.push_back(scene_axis("depth_range", "1", "farthest / nearest depth of the light and of the camera",
                            {"1e1", "1e2", "1e3", "1e4", "1e5", "1e6", "1e7", "1e8"}, {"1e8"},
                            &S::depth_range, 2, 1e12));
  axes.push_back(scene_axis("offset", "world units", "distance of the scene from the world's origin",
                            {"1e2", "1e4", "1e6", "1e7", "1e8"}, {"1e6"}, &S::offset, 0, 1e15));
  axes.push_back(
      scene_axis("scale", "world units", "world units to a unit of the scene",
                 {"0.1", "10", "1e-2", "1e2", "1e-3", "1e3", "1e-4", "1e4", "1e-5", "1e5", "1e-6", "1e6"},
                 {"1e-6", "1e6"}, &S::scale, 1e-12, 1e12));
  axes.push_back(scene_axis("incidence", "degrees", "of the light on the floor, from its normal",
                            {"0", "45", "70", "80", "85", "89", "89.9", "89.99"}, {"89.9"}, &S::incidence, 0,
                            90));
  axes.push_back(scene_axis("light_size", "scene units", "side of the light; the floor is 12 wide",
                            {"0", "1e-3", "0.1", "4", "10", "100"}, {"0", "100"}, &S::light_size, 0, 1e6));
  axes.push_back(scene_axis("light_height", "scene units", "of a light that looks level above the floor",
                            {"0.5", "1e-1", "1e-2", "1e-4", "0"}, {"0"}, &S::light_height, 0, 1e3));
  axes.push_back(scene_axis("light_inside", "1", "1: the light is in the centre of a closed caster", {"1"},
                            {"1"}, &S::light_inside, 0, 1));
  axes.push_back(scene_axis("fov", "degrees", "vertical field of view of the camera",
                            {"10", "1", "90", "120", "150", "170"}, {"1", "170"}, &S::fov, 1e-3, 179.9));
  axes.push_back(variable_axis("shadow_map", "texels", "side of the shadow map",
                               {"4096", "128", "64", "32", "16", "8", "4", "3", "2", "1", "16384"},
                               {"1", "2"}, {}));
  axes.back().map_side = true;
  axes.push_back(size_axis());
  axes.push_back(variable_axis("kernel", "texels or pixels", "width of the filter",
                               {"1", "3", "31", "63", "127", "255"}, {"1", "127"}, {"kernel", "filter"}));
  axes.push_back(variable_axis("penumbra", "1", "penumbra's width / scene size",
                               {"0", "1e-4", "0.1", "1", "10"}, {"1"}, {"penumbra_relative"}));
  axes.push_back(
      scene_axis("layers", "1", "floors in one plane", {"2", "100", "2000"}, {"500"}, &S::layers, 1, 1e6));
  axes.push_back(scene_axis("slivers", "1", "length / width of thin triangles in the blocker",
                            {"1e2", "1e4", "1e5", "1e6"}, {"1e6"}, &S::sliver_aspect, 1, 1e12));
  axes.push_back(scene_axis("depth_complexity", "1", "casters over one another",
                            {"2", "30", "255", "256", "300"}, {"300"}, &S::depth_complexity, 1, 1e6));
  axes.push_back(variable_axis("exponent", "1", "of exponential filters, in single precision",
                               {"1", "5", "20", "42", "60", "88", "100", "200", "1000"}, {"200"},
                               {"exponent"}, {{"precision", std::string("single")}}));
  axes.push_back(variable_axis("exponent_half", "1", "of exponential filters, in half precision",
                               {"1", "5", "8", "11", "20", "42", "88"}, {"20"},
                               {"exponent", "negative_exponent"}, {{"precision", std::string("half")}}));
  axes.push_back(scene_axis("flat", "1",
                            "1: a floor alone below a directional light: one depth in all of the map", {"1"},
                            {"1"}, &S::flat, 0, 1));
  axes.push_back(scene_axis("triangles", "1", "0: none in view; 1: one alone; more: of the floor",
                            {"0", "1", "1e4", "1e7"}, {"0", "1"}, &S::triangles, 0, 1e8));
  axes.push_back(scene_axis("lights", "1", "spot, directional and point in turn; 0: a file without any",
                            {"0", "3", "32"}, {"0", "3"}, &S::lights, 0, 64));
  return axes;
}

}  // namespace

const std::vector<StabilityAxis>& stability_axes() {
  static const std::vector<StabilityAxis> axes = make_axes();
  return axes;
}

StabilityCase parse_stability_case(const std::string& text) {
  StabilityCase test;
  if (text == "base") return test;
  std::vector<std::string> names;
  for (const StabilityAxis& axis : stability_axes()) names.push_back(axis.name);
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    const size_t equals = part.find('=');
    if (equals == std::string::npos || equals + 1 == part.size())
      fail(fmt::format("'{}' is not AXIS=VALUE", part), {}, "--case", "--case offset=1e6,fov=170, or base");
    const std::string name = part.substr(0, equals), value = part.substr(equals + 1);
    const auto axis = std::find_if(stability_axes().begin(), stability_axes().end(),
                                   [&](const StabilityAxis& a) { return a.name == name; });
    if (axis == stability_axes().end())
      fail(fmt::format("no axis '{}'", name), {}, "--case", did_you_mean(name, names));
    const auto same = [&](const auto& other) { return other.first == name; };
    if (std::any_of(test.begin(), test.end(), same))
      fail(fmt::format("axis '{}' is given twice", name), {}, "--case");
    StabilitySetup setup;
    Extent size;
    if (axis->apply) axis->apply(setup, size, value);
    test.emplace_back(name, value);
    begin = end + 1;
  }
  return test;
}

std::string to_string(const StabilityCase& test) {
  std::string text;
  for (const auto& [axis, value] : test) text += fmt::format("{}{}={}", text.empty() ? "" : ",", axis, value);
  return text.empty() ? "base" : text;
}

}  // namespace gnomon
