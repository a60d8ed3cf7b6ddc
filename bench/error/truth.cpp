// A scene's reference at one size: traced or read from the cache, and the errors of images against it.
#include "bench/error/truth.h"

#include <algorithm>
#include <future>

#include "bench/error/error_interval.h"
#include "bench/error/measure.h"
#include "engine/base/error.h"
#include "engine/truth/metrics.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kUsualMapSide = 1024;  // texels: of techniques without a map

}  // namespace

Image rgb_of(const Image& color) {
  Image rgb(color.width, color.height, {"R", "G", "B"});
  for (size_t c = 0; c < 3; ++c) {
    const auto from = color.plane(rgb.channels[c]);
    std::copy(from.begin(), from.end(), rgb.plane(c).begin());
  }
  return rgb;
}

Truth::Truth(std::shared_ptr<const Scene> scene, const ReferenceSettings& settings, const fs::path& cache)
    : scene_(std::move(scene)),
      camera_(scene_->cameras.at(settings.camera)),
      reference_(cached_reference(*scene_, settings, cache)),
      tracer_(*scene_) {}

const std::vector<std::vector<uint32_t>>& Truth::deep_umbra_of(const EdgeSettings& edges) const {
  auto [found, is_new] = deep_umbra_.try_emplace(edges.map_size);
  if (is_new)
    for (uint32_t i = 0; i < reference_.lights; ++i)
      found->second.push_back(deep_umbra(reference_, i, edges));
  return found->second;
}

MeasuredError Truth::error(const Image& visibility, const Image* color, const Graph& graph) const {
  const EdgeSettings edges{&tracer_, camera_, map_side(graph).value_or(kUsualMapSide)};
  // FLIP takes about as long as all the rest together, and shares nothing with it.
  std::future<double> flipped;
  if (color != nullptr)
    flipped =
        std::async(std::launch::async, [color, &truth = shaded()] { return flip(rgb_of(*color), truth); });
  MeasuredError error = measure_visibility(visibility, reference_, edges, deep_umbra_of(edges));
  if (color != nullptr) error.all.flip = flipped.get();
  std::vector<ComparedPlane> planes;
  for (uint32_t i = 0; i < reference_.lights; ++i)
    planes.push_back(
        {visibility.plane(visibility_channel(i)), reference_.visibility[i], reference_.domain[i]});
  error.intervals = error_intervals(planes, reference_.width, reference_.height);
  if (reference_.noise_floor > 0) error.reference_noise = reference_.noise_floor;
  return error;
}

const Image& Truth::shaded() const {
  if (shaded_.width == 0) shaded_ = shade_reference(*scene_, camera_, reference_);
  return shaded_;
}

}  // namespace gnomon
