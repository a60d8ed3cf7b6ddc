// A scene's reference at one size: traced or read from the cache, and the errors of images against it.
#include "bench/error/truth.h"

#include <algorithm>
#include <future>

#include "bench/error/error_interval.h"
#include "bench/error/measure.h"
#include "engine/base/error.h"
#include "engine/graph/graph.h"
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

Ambient ambient_of(const Graph& graph) {
  Ambient ambient;
  const auto color = graph.outputs.find("color");
  if (color == graph.outputs.end()) return ambient;
  const auto node = std::find_if(graph.nodes.begin(), graph.nodes.end(),
                                 [&](const GraphNode& n) { return n.id == color->second.node; });
  if (node == graph.nodes.end()) return ambient;
  const auto take = [&](const char* name, double& value) {
    const auto found = node->params.find(name);
    if (found == node->params.end()) return;
    if (const auto* number = std::get_if<double>(&found->second)) value = *number;
    if (const auto* whole = std::get_if<std::int64_t>(&found->second)) value = static_cast<double>(*whole);
  };
  take("ambient", ambient.share), take("ground", ambient.ground);
  take("sky_red", ambient.sky.r), take("sky_green", ambient.sky.g), take("sky_blue", ambient.sky.b);
  return ambient;
}

MeasuredError Truth::error(const Image& visibility, const Image* color, const Graph& graph) const {
  const EdgeSettings edges{&tracer_, camera_, map_side(graph).value_or(kUsualMapSide)};
  // FLIP takes about as long as all the rest together, and shares nothing with it.
  std::future<double> flipped;
  if (color != nullptr)
    flipped = std::async(std::launch::async,
                         [color, &truth = shaded(ambient_of(graph))] { return flip(rgb_of(*color), truth); });
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

const Image& Truth::shaded(const Ambient& ambient) const {
  if (shaded_.width == 0 || shaded_with_ != ambient)
    shaded_ = shade_reference(*scene_, camera_, reference_, ambient), shaded_with_ = ambient;
  return shaded_;
}

}  // namespace gnomon
