// Runs a suite: techniques in turn, row by row into results.jsonl.
#include "bench/run/harness.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/run/checkpoint.h"
#include "bench/run/output_lock.h"
#include "bench/run/results.h"
#include "bench/run/suite_plan.h"
#include "engine/base/error.h"
#include "engine/image/image.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

// Of the frames that count.
double seconds_of(const Samples& samples) {
  double ms = 0;
  for (const auto* frames : {&samples.plain, &samples.overlapped, &samples.isolated})
    for (const FrameTiming& frame : *frames) ms += frame.frame_ms;
  return ms / 1e3;
}

std::set<std::string> finished_keys(const fs::path& results) {
  std::set<std::string> keys;
  if (!fs::exists(results)) return keys;
  for (const Row& row : read_results(results))
    if (row.ok()) keys.insert(row.key);
  return keys;
}

// Calls `attempt`; what it throws becomes the row's status.
template <class Attempt>
void or_status(Row& row, Attempt attempt) {
  try {
    attempt();
  } catch (const std::bad_alloc&) {
    row.status = "error: out of memory";
  } catch (const std::exception& error) {
    row.status = std::string("error: ") + error.what();
  }
}

class SuiteRun {
 public:
  SuiteRun(const Suite& suite, const BenchOptions& options, const StageMaker& make_stage)
      : suite_(suite),
        options_(options),
        make_stage_(make_stage),
        lock_(options.out),
        file_(results_file(options), options.resume),
        checkpoint_(options.out / "interrupted.jsonl", options.resume) {
    const auto finished = options.resume ? finished_keys(file_.path()) : std::set<std::string>();
    write_text(options.out / "suite.json",
               suite_as_run(suite).dump(2, ' ', false, json::error_handler_t::replace) + "\n");
    places_ = planned_places(suite, options, finished);
    for (const PlaceToMeasure& place : places_) {
      result_.resumed += place.finished.size();
      total_ += place.missing();
    }
  }

  BenchResult run() {
    result_.results = file_.path();
    try {
      for (const PlaceToMeasure& place : places_)
        if (place.missing() > 0) run_place(place);
      report("done");
    } catch (const Error& error) {  // no further row can be written
      result_.stopped = error.what();
    }
    return result_;
  }

 private:
  static fs::path results_file(const BenchOptions& options) {
    if (options.shards < 1 || options.shard < 1 || options.shard > options.shards)
      fail(fmt::format("shard {}/{}: the first number must be in 1..{}", options.shard, options.shards,
                       options.shards));
    fs::path file = options.out / "results.jsonl";
    std::error_code ignored;  // there may be none
    if (options.overwrite && !options.resume) fs::resize_file(file, 0, ignored);
    return file;
  }

  void report(const std::string& note, double part = 0) const {
    if (!options_.progress) return;
    const double share = total_ == 0 ? 1.0 : (double(result_.measured) + part) / double(total_);
    options_.progress(share, note);
  }

  void write(Row& row) {
    if (row.status == "ok" && row.nonfinite > 0)
      row.status = fmt::format("error: {} values of the output are not finite", row.nonfinite);
    if (row.status != "ok") ++result_.failed;
    file_.append(row);
    ++result_.measured;
  }

  void run_place(const PlaceToMeasure& place) {
    const std::string name = place.scene.stem().string();
    report(name + ": scene and reference");
    std::unique_ptr<Stage> stage;
    try {
      stage = make_stage_(suite_, place);
    } catch (const std::exception& error) {
      for (const size_t config : place.configs) {
        if (place.finished.count(config) != 0) continue;
        Row row = planned_row(suite_, options_, place, suite_.configs[config]);
        row.status = std::string("error: ") + error.what();
        write(row);
      }
      return;
    }
    for (const Chunk& chunk : chunks_of(suite_, options_, place)) run_chunk(place, *stage, chunk);
  }

  struct Entry {
    size_t config = 0;
    bool wanted = true;  // false: the baseline, there for the ratios only
    Row row;
    Samples samples;
    std::unique_ptr<Subject> subject;
  };

  Entry open(const SuitePlace& place, Stage& stage, size_t config, bool wanted) const {
    Entry entry{config, wanted, planned_row(suite_, options_, place, suite_.configs[config]), {}, nullptr};
    const Stopwatch watch;
    or_status(entry.row, [&] {
      entry.subject = stage.open(suite_.configs[config]);
      entry.row.harness_seconds["open"] = watch.seconds();
    });
    return entry;
  }

  RoundSettings rounds() const {
    RoundSettings settings{suite_.warmup, suite_.repeat, suite_.instrumented};
    settings.seconds = suite_.seconds;
    settings.least = suite_.least;
    settings.sequence = suite_.frames > 0;
    if (settings.sequence) settings.repeat = suite_.frames;
    return settings;
  }

  void measure(std::vector<Entry>& entries, Stage& stage, const std::string& scene) {
    std::vector<Subject*> subjects;
    std::vector<Entry*> open_entries;
    RoundSettings settings = rounds();
    // A sequence cannot be gone on with: what a frame shows depends on those before it.
    std::vector<Samples> before;
    size_t wanted = 0;
    for (Entry& entry : entries) {
      wanted += entry.wanted ? 1 : 0;
      if (!entry.subject) continue;
      if (&entry == &entries.front()) settings.baseline = 0;
      subjects.push_back(entry.subject.get());
      open_entries.push_back(&entry);
      if (!settings.sequence) before.push_back(checkpoint_.of(entry.row.key));
    }
    const auto on_frame = [&](size_t i, TimingMode mode, uint32_t index, const FrameTiming& timing) {
      const Entry& entry = *open_entries[i];
      if (!settings.sequence)
        checkpoint_.keep(entry.row.key, mode, timing);
      else if (entry.wanted && mode == TimingMode::none)
        stage.frame(suite_.configs[entry.config], *subjects[i], index, timing.frame_ms);
    };
    const std::string note = fmt::format("{}: {} techniques in turn", scene, subjects.size());
    std::vector<Samples> samples = run_rounds(
        subjects, settings, [&](double part) { report(note, part * double(wanted)); }, on_frame,
        std::move(before));
    for (size_t i = 0; i < open_entries.size(); ++i) {
      Entry& entry = *open_entries[i];
      entry.samples = std::move(samples[i]);
      entry.row.harness_seconds["frames"] = seconds_of(entry.samples);
      if (!entry.samples.error.empty()) entry.row.status = "error: " + entry.samples.error;
      describe_samples(entry.row, entry.samples);
    }
  }

  void run_chunk(const PlaceToMeasure& place, Stage& stage, const Chunk& chunk) {
    const std::string scene = place.scene.stem().string();
    std::vector<size_t> missing;
    for (const size_t config : chunk.configs)
      if (place.finished.count(config) == 0) missing.push_back(config);
    if (missing.empty()) return;
    std::vector<Entry> entries;
    if (missing.front() != chunk.baseline) entries.push_back(open(place, stage, chunk.baseline, false));
    for (const size_t config : missing) {
      report(fmt::format("{}: {}", scene,
                         label_of(suite_.configs[config].graph.name, suite_.configs[config].set)));
      entries.push_back(open(place, stage, config, true));
    }
    checkpoint_.begin(group_of(suite_, options_, place, chunk));
    measure(entries, stage, scene);
    const std::vector<double> base_ms = entries.front().samples.frame_ms();
    for (Entry& entry : entries) {
      if (!entry.wanted) continue;
      finish(stage, chunk.baseline, base_ms, entry);
      write(entry.row);
      entry.subject.reset();
    }
    checkpoint_.end();
  }

  void finish(Stage& stage, size_t baseline, const std::vector<double>& base_ms, Entry& entry) const {
    if (!entry.row.ok() || !entry.subject) return;
    const SuiteConfig& base = suite_.configs[baseline];
    entry.row.is_baseline = entry.config == baseline;
    const std::vector<double> ratios = pair_ratios(entry.samples.frame_ms(), base_ms);
    if (!ratios.empty()) entry.row.ratio = Ratio{label_of(base.graph.name, base.set), summarise(ratios)};
    const Stopwatch watch;
    or_status(entry.row, [&] {
      stage.finish(suite_.configs[entry.config], *entry.subject, entry.row);
      entry.row.harness_seconds["error"] = watch.seconds();
    });
  }

  const Suite& suite_;
  const BenchOptions& options_;
  const StageMaker& make_stage_;
  OutputLock lock_;
  ResultsFile file_;
  Checkpoint checkpoint_;
  std::vector<PlaceToMeasure> places_;
  size_t total_ = 0;
  BenchResult result_;
};

}  // namespace

BenchResult run_suite(const Suite& suite, const BenchOptions& options, const StageMaker& make_stage) {
  return SuiteRun(suite, options, make_stage).run();
}

}  // namespace gnomon
