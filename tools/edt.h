// Distance transforms of masks, apart from any scene: what `gnomon edt` does.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/vulkan/device_info.h"

namespace gnomon {

struct EdtSettings {
  std::string algorithm = "banded_exact", variant = "jfa";  // of the pass type distance_transform
  std::string sites = "nonzero";
  uint32_t radius = 32;                 // pixels; of bounded_exact
  uint32_t warmup = 2, repeat = 1;      // runs; only the latter are measured
  uint64_t memory = uint64_t{1} << 30;  // bytes: RenderSettings::memory
};

constexpr uint32_t kNoSite = 0xFFFFFFFF;  // shaders/glsl/lib/distance_transform.glsl

struct EdtRun {
  std::vector<uint32_t> nearest;  // a pixel: x | y << 16 of its nearest site, or kNoSite; row 0 at the top
  std::vector<double> gpu_ms;     // of the transform alone, a run
  std::map<std::string, std::vector<double>> step_ms;  // of its steps, a run
};

// Non-zero pixels of `mask`'s first channel are sites. Error: settings that the pass refuses, images that the
// device cannot hold.
EdtRun run_edt(const std::shared_ptr<Device>& device, const std::shared_ptr<const Image>& mask,
               const EdtSettings& settings);

// One channel, 1 where any channel but alpha ("A") is not 0. Error (file) for NaN.
Image edt_mask(const Image& image, const std::string& file_for_errors);

// Squared distance of pixel `index` of an image of that width to its nearest site, pixels^2; absent: it has
// none.
std::optional<int64_t> squared_distance(const std::vector<uint32_t>& nearest, size_t index, uint32_t width);

// Channel Y: the distance in pixels, infinite where there is no site.
Image edt_distance(const std::vector<uint32_t>& nearest, uint32_t width, uint32_t height);

struct EdtError {
  uint64_t wrong = 0;  // pixels whose distance is not the exact one
  double largest = 0;  // pixels; infinite when a pixel with a site near got none
};
EdtError edt_error(const std::vector<uint32_t>& nearest, const std::vector<uint32_t>& exact, uint32_t width);

}  // namespace gnomon
