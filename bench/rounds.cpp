#include "bench/rounds.h"

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
         const std::function<void(double)>& step, const FrameHook& frame)
      : subjects_(subjects), settings_(settings), step_(step), frame_(frame), all_(subjects.size()) {}

  std::vector<Samples> run() {
    // One frame settles a mode that differs only in its time stamps.
    const uint32_t settle = settings_.instrumented > 0 && settings_.warmup > 0 ? 1 : 0;
    total_ = subjects_.size() *
             (settings_.warmup + settings_.repeat + 2 * size_t{settle + settings_.instrumented});
    turns(TimingMode::none, settings_.warmup, nullptr);
    measured(TimingMode::none, settings_.repeat, &Samples::plain, frame_);
    turns(TimingMode::overlapped, settle, nullptr);
    measured(TimingMode::overlapped, settings_.instrumented, &Samples::overlapped);
    turns(TimingMode::isolated, settle, nullptr);
    measured(TimingMode::isolated, settings_.instrumented, &Samples::isolated);
    return std::move(all_);
  }

 private:
  void measured(TimingMode mode, uint32_t rounds, Frames frames, const FrameHook& hook = {}) {
    if (settings_.sequence && rounds > 0)
      for (Subject* subject : subjects_) subject->play();
    turns(mode, rounds, frames, hook);
  }

  // `frames` nullptr: results are thrown away (warm-up).
  void turns(TimingMode mode, uint32_t rounds, Frames frames, const FrameHook& hook = {}) {
    for (uint32_t round = 0; round < rounds; ++round) {
      for (size_t i = 0; i < subjects_.size(); ++i) {
        if (all_[i].error.empty()) {
          try {
            FrameTiming timing = subjects_[i]->render(mode);
            if (hook) hook(i, round, timing);
            if (frames != nullptr) (all_[i].*frames).push_back(std::move(timing));
          } catch (const std::exception& error) {
            all_[i].error = error.what();
          }
        }
        ++done_;
        if (step_) step_(double(done_) / double(total_));
      }
    }
  }

  const std::vector<Subject*>& subjects_;
  const RoundSettings& settings_;
  const std::function<void(double)>& step_;
  const FrameHook& frame_;
  std::vector<Samples> all_;
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
                                const std::function<void(double)>& step, const FrameHook& frame) {
  return Rounds(subjects, settings, step, frame).run();
}

}  // namespace gnomon
