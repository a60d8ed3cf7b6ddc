// Measures several techniques in turn, frame by frame.
#include "bench/run/rounds.h"

#include <utility>

namespace gnomon {
namespace {

class RendererSubject final : public Subject {
 public:
  explicit RendererSubject(Renderer& renderer) : renderer_(renderer) {}
  FrameTiming render(TimingMode mode) override { return renderer_.render(mode); }
  void play() override { renderer_.play(); }

 private:
  Renderer& renderer_;
};

using Frames = std::vector<FrameTiming> Samples::*;

class Rounds {
 public:
  Rounds(const std::vector<Subject*>& subjects, const RoundSettings& settings,
         const std::function<void(double)>& step, const FrameHook& frame, std::vector<Samples> before)
      : subjects_(subjects),
        settings_(settings),
        step_(step),
        frame_(frame),
        limit_ms_(settings.sequence ? 0 : 1e3 * settings.seconds),
        all_(std::move(before)),
        last_ms_(subjects.size(), 0) {
    all_.resize(subjects.size());
  }

  std::vector<Samples> run() {
    // One frame settles a mode that differs only in its time stamps.
    const uint32_t settle = settings_.instrumented > 0 && settings_.warmup > 0 ? 1 : 0;
    total_ = subjects_.size() *
             (settings_.warmup + settings_.repeat + 2 * size_t{settle + settings_.instrumented});
    turns({TimingMode::none, settings_.warmup, 1, nullptr});
    measured({TimingMode::none, settings_.repeat, settings_.least, &Samples::plain});
    for (const auto& [mode, frames] : {std::pair{TimingMode::overlapped, Frames(&Samples::overlapped)},
                                       std::pair{TimingMode::isolated, Frames(&Samples::isolated)}}) {
      turns({mode, settle, 0, nullptr});
      measured({mode, settings_.instrumented, 1, frames});
    }
    return std::move(all_);
  }

 private:
  struct Turns {
    TimingMode mode = TimingMode::none;
    uint32_t rounds = 0, least = 0;  // at most, and at least whatever the time
    Frames frames = nullptr;         // nullptr: results are thrown away (warm-up)
  };

  void measured(const Turns& turn) {
    if (settings_.sequence && turn.rounds > 0)
      for (Subject* subject : subjects_) subject->play();
    turns(turn);
  }

  void turns(const Turns& turn) {
    std::vector<double> spent_ms(subjects_.size(), 0);
    for (uint32_t round = 0; round < turn.rounds; ++round) {
      const std::vector<bool> takes_part = participants(turn, round, spent_ms);
      for (size_t i = 0; i < subjects_.size(); ++i) {
        if (takes_part[i]) spent_ms[i] += last_ms_[i] = frame_of(i, turn, round);
        ++done_;
        if (step_) step_(double(done_) / double(total_));
      }
    }
  }

  // Whoever still runs and has time for a frame as long as its last one.
  std::vector<bool> participants(const Turns& turn, uint32_t round,
                                 const std::vector<double>& spent_ms) const {
    std::vector<bool> takes_part(subjects_.size());
    bool any = false;
    for (size_t i = 0; i < subjects_.size(); ++i) {
      // A frame that settles must leave time for one that counts.
      const double needed_ms = (turn.least == 0 ? 2 : 1) * last_ms_[i];
      const bool fits = limit_ms_ == 0 || round < turn.least || spent_ms[i] + needed_ms <= limit_ms_;
      takes_part[i] = fits && all_[i].error.empty();
      any = any || takes_part[i];
    }
    if (settings_.baseline) {
      const size_t i = *settings_.baseline;
      takes_part[i] = any && all_[i].error.empty();
    }
    return takes_part;
  }

  // Milliseconds of wall-clock time.
  double frame_of(size_t i, const Turns& turn, uint32_t round) {
    std::vector<FrameTiming>* frames = turn.frames == nullptr ? nullptr : &(all_[i].*turn.frames);
    if (frames != nullptr && round < frames->size()) return (*frames)[round].frame_ms;  // measured before
    try {
      FrameTiming timing = subjects_[i]->render(turn.mode);
      const double ms = timing.frame_ms;
      if (frames == nullptr) return ms;
      if (frame_) frame_(i, turn.mode, round, timing);
      frames->push_back(std::move(timing));
      return ms;
    } catch (const std::exception& error) {
      all_[i].error = error.what();
      return 0;
    }
  }

  const std::vector<Subject*>& subjects_;
  const RoundSettings& settings_;
  const std::function<void(double)>& step_;
  const FrameHook& frame_;
  double limit_ms_;  // 0: none
  std::vector<Samples> all_;
  std::vector<double> last_ms_;  // of each subject's last frame
  size_t total_ = 0, done_ = 0;
};

std::vector<double> pick(const std::vector<FrameTiming>& frames, double FrameTiming::*member) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const FrameTiming& frame : frames) values.push_back(frame.*member);
  return values;
}

}  // namespace

std::unique_ptr<Subject> subject_of(Renderer& renderer) {
  return std::make_unique<RendererSubject>(renderer);
}

std::vector<double> Samples::frame_ms() const { return pick(plain, &FrameTiming::frame_ms); }
std::vector<double> Samples::record_ms() const { return pick(plain, &FrameTiming::record_ms); }

std::vector<Samples> run_rounds(const std::vector<Subject*>& subjects, const RoundSettings& settings,
                                const std::function<void(double)>& step, const FrameHook& frame,
                                std::vector<Samples> before) {
  return Rounds(subjects, settings, step, frame, std::move(before)).run();
}

}  // namespace gnomon
