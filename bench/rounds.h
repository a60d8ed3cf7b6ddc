// Measures several techniques in turn (A B C A B C ...), so that a slow spell of the machine hits all of
// them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/renderer.h"

namespace gnomon {

// One technique under measurement. The Renderer in earnest; something simpler in tests.
class Subject {
 public:
  virtual ~Subject() = default;
  virtual FrameTiming render(TimingMode mode) = 0;
  virtual void play() {}  // as Renderer::play()
};
std::unique_ptr<Subject> subject_of(Renderer& renderer);  // refers to `renderer`

struct RoundSettings {
  uint32_t warmup = 2;        // frames before anything counts, for each technique and mode
  uint32_t repeat = 5;        // rounds without time stamps: what a frame costs
  uint32_t instrumented = 5;  // rounds of each mode with time stamps; 0: none
  // Each technique plays from the scene's time 0 after the warm-up, which it has forgotten: the rounds are
  // the sequence's frames. Those with time stamps are its first ones again, once for each mode.
  bool sequence = false;
};

// What one technique's rounds gave; index = round. A technique that throws takes no further part.
struct Samples {
  std::vector<FrameTiming> plain, overlapped, isolated;
  std::string error;  // empty: none
  std::vector<double> frame_ms() const;
  std::vector<double> record_ms() const;
};

// Called after each frame of the rounds without stamps, which may be read then: the subject's index, the
// round's, and the time. What it throws counts as the technique's failure.
using FrameHook = std::function<void(size_t, uint32_t, const FrameTiming&)>;

// One Samples per subject, in order. `step` is called after each frame with the share done, 0..1; both may be
// empty.
std::vector<Samples> run_rounds(const std::vector<Subject*>& subjects, const RoundSettings& settings,
                                const std::function<void(double)>& step = {}, const FrameHook& frame = {});

}  // namespace gnomon
