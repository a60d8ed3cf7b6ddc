// One value a pixel from an image's channels.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/base/error.h"
#include "engine/image/image.h"

namespace gnomon {
namespace {

std::vector<float> copied(std::span<const float> plane) { return {plane.begin(), plane.end()}; }

// Of linear light (Rec. ITU-R BT.709).
std::vector<float> luminance(std::span<const float> r, std::span<const float> g, std::span<const float> b) {
  std::vector<float> values(r.size());
  for (size_t i = 0; i < values.size(); ++i) values[i] = 0.2126f * r[i] + 0.7152f * g[i] + 0.0722f * b[i];
  return values;
}

}  // namespace

std::vector<float> scalar_values(const Image& image, const std::string& name, const std::string& file) {
  if (image.has(name)) return copied(image.plane(name));
  const std::string layer = name == "luminance" ? "" : name + ".";
  if (!layer.empty() && image.has(layer + "Y")) return copied(image.plane(layer + "Y"));
  if (image.has(layer + "R") && image.has(layer + "G") && image.has(layer + "B"))
    return luminance(image.plane(layer + "R"), image.plane(layer + "G"), image.plane(layer + "B"));
  fail(fmt::format("no channel '{}'; it has: {}", name, fmt::join(image.channels, ", ")), file);
}

}  // namespace gnomon
