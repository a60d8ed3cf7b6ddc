// Measures several techniques in turn (A B C A B C ...), so that a slow spell of the machine hits all of
// them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/render/renderer.h"

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

  // Seconds of wall-clock time for each technique's frames of one mode; 0: no limit, and none for sequences.
  // A technique takes part in the rounds that fit, at least in `least` (of those with stamps: in one), at
  // most in those stated above; warm-up frames after the first, which compiles, are left out when they do not
  // fit. Time alone decides, never the spread of the samples: rounds that end when an interval happens to be
  // narrow give intervals that promise too much.
  double seconds = 0;
  uint32_t least = 5;
  // The subject by whose frames the others are divided: it takes part in a round as long as any other does.
  std::optional<size_t> baseline = std::nullopt;
};

// What one technique's rounds gave; index = round. A technique that throws takes no further part.
struct Samples {
  std::vector<FrameTiming> plain, overlapped, isolated;
  std::string error;  // empty: none
  std::vector<double> frame_ms() const;
  std::vector<double> record_ms() const;
};

// Called after each frame that counts, which may be read then: the subject's index, the round's of its mode,
// and the time. What it throws counts as the technique's failure.
using FrameHook = std::function<void(size_t, TimingMode, uint32_t, const FrameTiming&)>;

// One Samples per subject, in order. `step` is called after each frame with the share done, 0..1; both may be
// empty. `before`: empty, or of each subject the frames that an earlier run measured until it was
// interrupted, which are not rendered again; not for sequences, whose frames depend on those before them.
std::vector<Samples> run_rounds(const std::vector<Subject*>& subjects, const RoundSettings& settings,
                                const std::function<void(double)>& step = {}, const FrameHook& frame = {},
                                std::vector<Samples> before = {});

}  // namespace gnomon
