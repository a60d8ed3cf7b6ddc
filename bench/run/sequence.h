// Frames in order: each frame's own reference, its error, and how the error changes from frame to frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/error/measure.h"
#include "engine/image/image.h"
#include "engine/scene/scene.h"
#include "engine/truth/reference.h"

namespace gnomon {

// For every pixel its point's pixel in the frame before (metrics.h, flicker): itself when the camera stands
// still. When it moves, the pixel nearest to where the point, taken as standing still, was seen; its surface
// there must be the same: the point in its tangent plane within a thousandth of the view depth, the normals
// within 25 degrees. Background has none.
std::vector<uint32_t> pixels_before(const Reference& now, const Camera& camera, const Reference& before,
                                    const Camera& camera_before);

struct FrameTruth {
  double seconds = 0;                  // of the scene's time
  std::shared_ptr<const Scene> scene;  // as it stands then
  Camera camera;
  std::shared_ptr<const Reference> reference;
  std::vector<uint32_t> before;  // pixels_before(); empty in frame 0
};

// The references of a sequence's frames; frame i is at i * frame_seconds. Holds two: ask in order, or pay for
// it again. Still scenes are traced once.
class SequenceTruth {
 public:
  SequenceTruth(std::shared_ptr<const Scene> scene, const ReferenceSettings& settings,
                std::filesystem::path cache, double frame_seconds);
  const FrameTruth& at(uint32_t frame);

 private:
  FrameTruth make(uint32_t frame, const FrameTruth* before) const;
  std::shared_ptr<const Scene> scene_;
  ReferenceSettings settings_;
  std::filesystem::path cache_;
  double frame_seconds_;
  std::optional<uint32_t> frame_;  // of now_
  FrameTruth now_, before_;        // before_: of frame_ - 1, unless that is none
};

struct FrameResult {
  double seconds = 0, frame_ms = 0;
  // Without acne, leak and FLIP; absent: not measured. Flicker is absent in frame 0 and without pixels seen
  // twice.
  std::optional<MeasuredError> error;
};

// Mean and largest over a sequence's frames that have the figure; NaN when any is NaN.
struct Spread {
  double mean = 0, max = 0;
};

// One technique's frames so far.
class SequenceResult {
 public:
  // `truth`: of the frame that is shown, the next one of the sequence.
  void add(const FrameTruth& truth, double frame_ms, const Image& visibility);
  void add(double seconds, double frame_ms);  // without its error
  const std::vector<FrameResult>& frames() const { return frames_; }
  std::optional<Spread> rmse() const;
  std::optional<Spread> flicker() const;

 private:
  std::vector<FrameResult> frames_;
  Image shown_;                                 // the last frame's visibility
  std::shared_ptr<const Reference> reference_;  // and its truth
};

}  // namespace gnomon
