#include "bench/rounds.h"

namespace gnomon {
namespace {

class RendererSubject final : public Subject {
 public:
  explicit RendererSubject(Renderer& renderer) : renderer_(renderer) {}
  FrameTiming render(TimingMode mode) override { return renderer_.render(mode); }

 private:
  Renderer& renderer_;
};

using Frames = std::vector<FrameTiming> Samples::*;

// `frames` nullptr: results are thrown away (warm-up).
void run_turns(const std::vector<Subject*>& subjects, TimingMode mode, uint32_t rounds, Frames frames,
               std::vector<Samples>& all, const std::function<void()>& step) {
  for (uint32_t round = 0; round < rounds; ++round) {
    for (size_t i = 0; i < subjects.size(); ++i) {
      if (all[i].error.empty()) {
        try {
          FrameTiming timing = subjects[i]->render(mode);
          if (frames != nullptr) (all[i].*frames).push_back(std::move(timing));
        } catch (const std::exception& error) {
          all[i].error = error.what();
        }
      }
      step();
    }
  }
}

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
                                const std::function<void(double)>& step) {
  std::vector<Samples> all(subjects.size());
  const bool stamps = settings.instrumented > 0;
  // One frame settles a mode that differs only in its time stamps.
  const uint32_t mode_warmup = stamps && settings.warmup > 0 ? 1 : 0;
  const size_t total =
      subjects.size() * (settings.warmup + settings.repeat + 2 * (mode_warmup + settings.instrumented));
  size_t done = 0;
  const auto count = [&] {
    ++done;
    if (step) step(double(done) / double(total));
  };
  run_turns(subjects, TimingMode::none, settings.warmup, nullptr, all, count);
  run_turns(subjects, TimingMode::none, settings.repeat, &Samples::plain, all, count);
  run_turns(subjects, TimingMode::overlapped, mode_warmup, nullptr, all, count);
  run_turns(subjects, TimingMode::overlapped, settings.instrumented, &Samples::overlapped, all, count);
  run_turns(subjects, TimingMode::isolated, mode_warmup, nullptr, all, count);
  run_turns(subjects, TimingMode::isolated, settings.instrumented, &Samples::isolated, all, count);
  return all;
}

}  // namespace gnomon
