// Measures a sequence of frames: each frame's error, and the flicker from frame to frame.
#include "bench/run/sequence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/scene/animation.h"

namespace gnomon {
namespace {

constexpr double kPlaneTolerance = 1e-3;    // of the view depth
constexpr double kNormalTolerance = 0.906;  // cosine of 25 degrees

bool same_view(const Camera& a, const Camera& b) {
  return a.world_from_camera == b.world_from_camera && a.fov_y == b.fov_y && a.aspect == b.aspect &&
         a.span == b.span;
}

// Where a camera sees a position relative to its eye: pixel, or nothing outside its image.
std::optional<uint32_t> pixel_of(const Camera& camera, const glm::dvec3& relative, uint32_t width,
                                 uint32_t height) {
  const glm::dvec3 p = glm::transpose(glm::dmat3(camera.world_from_camera)) * relative;
  if (!(-p.z > 0)) return std::nullopt;
  const glm::dvec2 half = half_extent(camera, double(width) / height) * (camera.span ? 1.0 : -p.z);
  const double x = std::floor((0.5 + 0.5 * p.x / half.x) * width),
               y = std::floor((0.5 - 0.5 * p.y / half.y) * height);
  if (!(x >= 0 && y >= 0 && x < width && y < height)) return std::nullopt;
  return static_cast<uint32_t>(y) * width + static_cast<uint32_t>(x);
}

template <class Figure>
std::optional<Spread> spread_of(const std::vector<FrameResult>& frames, Figure figure) {
  Spread spread;
  size_t count = 0;
  for (const FrameResult& frame : frames) {
    const std::optional<double> value = figure(frame);
    if (!value) continue;
    spread.mean += *value;
    spread.max = count++ == 0 || std::isnan(*value) ? *value : std::max(spread.max, *value);
    if (std::isnan(spread.mean)) spread.max = spread.mean;
  }
  if (count == 0) return std::nullopt;
  spread.mean /= static_cast<double>(count);
  return spread;
}

}  // namespace

std::vector<uint32_t> pixels_before(const Reference& now, const Camera& camera, const Reference& before,
                                    const Camera& camera_before) {
  std::vector<uint32_t> result(now.depth.size(), kNotSeenBefore);
  if (same_view(camera, camera_before)) {
    for (uint32_t i = 0; i < result.size(); ++i)
      if (!std::isinf(now.depth[i]) && !std::isinf(before.depth[i])) result[i] = i;
    return result;
  }
  const glm::dvec3 step(camera.world_from_camera[3] - camera_before.world_from_camera[3]);
  for (size_t i = 0; i < result.size(); ++i) {
    if (std::isinf(now.depth[i])) continue;
    const glm::dvec3 place = glm::dvec3(now.position[i]) + step;  // relative to the eye before
    const auto k = pixel_of(camera_before, place, before.width, before.height);
    if (!k || std::isinf(before.depth[*k])) continue;
    const glm::dvec3 normal(before.normal[*k]);
    const bool in_plane = std::abs(glm::dot(normal, place - glm::dvec3(before.position[*k]))) <=
                          kPlaneTolerance * before.depth[*k];
    if (in_plane && glm::dot(normal, glm::dvec3(now.normal[i])) >= kNormalTolerance) result[i] = *k;
  }
  return result;
}

SequenceTruth::SequenceTruth(std::shared_ptr<const Scene> scene, const ReferenceSettings& settings,
                             std::filesystem::path cache, double frame_seconds)
    : scene_(std::move(scene)),
      settings_(settings),
      cache_(std::move(cache)),
      frame_seconds_(frame_seconds) {}

const FrameTruth& SequenceTruth::at(uint32_t frame) {
  if (frame_ == frame) return now_;
  if (frame > 0 && frame_ != frame - 1) at(frame - 1);
  before_ = std::move(now_);
  now_ = make(frame, frame > 0 ? &before_ : nullptr);
  frame_ = frame;
  return now_;
}

FrameTruth SequenceTruth::make(uint32_t frame, const FrameTruth* before) const {
  FrameTruth truth;
  truth.seconds = frame * frame_seconds_;
  if (before != nullptr && !scene_->animation) {
    truth.scene = before->scene, truth.reference = before->reference;
  } else {
    truth.scene = scene_->animation ? std::make_shared<const Scene>(posed(*scene_, truth.seconds)) : scene_;
    truth.reference = std::make_shared<const Reference>(cached_reference(*truth.scene, settings_, cache_));
  }
  truth.camera = truth.scene->cameras.at(settings_.camera);
  if (before != nullptr)
    truth.before = pixels_before(*truth.reference, truth.camera, *before->reference, before->camera);
  return truth;
}

void SequenceResult::add(const FrameTruth& truth, double frame_ms, const Image& visibility) {
  const Reference& reference = *truth.reference;
  FrameResult frame{truth.seconds, frame_ms, measure_visibility(visibility, reference)};
  if (reference_ != nullptr && !truth.before.empty()) {
    double sum = 0;
    size_t count = 0;
    for (uint32_t light = 0; light < reference.lights; ++light) {
      const std::string name = visibility_channel(light);
      const auto change = gnomon::flicker(
          {visibility.plane(name), reference.visibility[light], reference.domain[light]},
          {shown_.plane(name), reference_->visibility[light], reference_->domain[light]}, truth.before);
      if (change) sum += *change, ++count;
    }
    if (count > 0) frame.error->flicker = sum / static_cast<double>(count);
  }
  frames_.push_back(std::move(frame));
  shown_ = visibility;
  reference_ = truth.reference;
}

void SequenceResult::add(double seconds, double frame_ms) { frames_.push_back({seconds, frame_ms, {}}); }

std::optional<Spread> SequenceResult::rmse() const {
  return spread_of(frames_, [](const FrameResult& f) {
    const bool known = f.error && (f.error->all.pixels > 0 || f.error->all.nonfinite > 0);
    return known ? std::optional(f.error->all.rmse) : std::nullopt;
  });
}
std::optional<Spread> SequenceResult::flicker() const {
  return spread_of(frames_, [](const FrameResult& f) { return f.error ? f.error->flicker : std::nullopt; });
}

}  // namespace gnomon
