// Writes the PNGs that a report shows of a measured row.
#include "bench/report/report_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/config.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

Image finite(Image image) {
  for (float& value : image.data)
    if (!std::isfinite(value)) value = 0;
  return image;
}

template <typename Value>
Image gray(const Reference& reference, const std::vector<Value>& values) {
  Image image(reference.width, reference.height, {"Y"});
  std::copy(values.begin(), values.end(), image.data.begin());
  return image;
}

Image domain_image(const Reference& reference) {
  std::vector<float> counted(reference.domain[0].size());
  std::transform(reference.domain[0].begin(), reference.domain[0].end(), counted.begin(),
                 [](uint8_t domain) { return domain == Reference::counted ? 1.0f : 0.0f; });
  return gray(reference, counted);
}

Image first_light(const Image& visibility) {
  Image image(visibility.width, visibility.height, {"Y"});
  const auto from = visibility.plane(visibility_channel(0));
  std::copy(from.begin(), from.end(), image.data.begin());
  return image;
}

// Of everything that the reference depends on as far as rows of one folder differ in it.
std::string reference_name(const Row& row) {
  const nlohmann::json identity = {
      row.scene_file.string(), row.size.width,         row.size.height,         row.camera,
      row.light_scale,         row.reference->samples, row.sequence.has_value()};
  return row.scene + "-" + canonical_hash(identity);
}

class ImageFolder {
 public:
  explicit ImageFolder(const fs::path& folder) : folder_(folder) {
    std::error_code error;
    fs::create_directories(folder / "images", error);
    if (error) fail("cannot make the folder: " + error.message(), (folder / "images").string());
  }
  fs::path add(const std::string& what, const std::string& name) {
    images_[what] = fmt::format("images/{}-{}.png", name, what);
    return folder_ / images_[what];
  }
  std::map<std::string, std::string> images() { return std::move(images_); }

 private:
  fs::path folder_;
  std::map<std::string, std::string> images_;
};

}  // namespace

std::map<std::string, std::string> write_row_images(const fs::path& folder, const Row& row,
                                                    const Truth& truth, const Image& visibility,
                                                    const Image* color) {
  const Reference& reference = truth.reference();
  if (reference.lights == 0) return {};
  ImageFolder out(folder);
  write_png_gray(out.add("visibility", row.key), finite(first_light(visibility)));
  if (color != nullptr) write_png_srgb(out.add("color", row.key), finite(rgb_of(*color)));
  const std::string shared = reference_name(row);
  const fs::path truth_file = out.add("reference", shared), domain_file = out.add("domain", shared),
                 shaded_file = out.add("reference_color", shared);
  if (!fs::exists(truth_file)) write_png_gray(truth_file, gray(reference, reference.visibility[0]));
  if (!fs::exists(domain_file)) write_png_gray(domain_file, domain_image(reference));
  if (!fs::exists(shaded_file)) write_png_srgb(shaded_file, truth.shaded());
  return out.images();
}

}  // namespace gnomon
