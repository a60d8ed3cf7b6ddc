// Runs a suite: every technique on every scene and size, row by row into results.jsonl.
#include "bench/run/harness.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/run/checkpoint.h"
#include "bench/run/results.h"
#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/image/image.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct PlaceToMeasure : SuitePlace {
  std::vector<size_t> configs;
  std::set<size_t> finished;  // of these, in the run that this one resumes
};

// Techniques that are measured in turn.
struct Chunk {
  size_t baseline = 0;
  std::vector<size_t> configs;
};

Row row_of(const Suite& suite, const BenchOptions& options, const SuitePlace& place,
           const SuiteConfig& config) {
  Row row;
  row.scene = place.scene;
  describe_graph(row, config.graph);
  row.set = config.set;
  row.size = place.size;
  row.light_scale = place.light_scale;
  row.camera = suite.camera;
  row.memory_limit = suite.memory;
  row.reference_samples = suite.samples;
  row.device = options.device;
  std::error_code ignored;
  json identity = {row.scene.string(), fs::file_size(row.scene, ignored),
                   row.graph_hash,     row.size.width,
                   row.size.height,    row.camera,
                   suite.repeat,       suite.instrumented,
                   suite.samples,      row.device.name,
                   row.device.driver,  version()};
  if (row.light_scale != 1) identity.push_back({{"light_scale", row.light_scale}});
  if (suite.frames > 0) identity.push_back({suite.frames, suite.fps});
  if (suite.seconds > 0) identity.push_back({{"seconds", suite.seconds}, {"least", suite.least}});
  row.key = canonical_hash(identity);
  return row;
}

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
  for (const json& row : read_results(results))
    if (row.value("status", "") == "ok") keys.insert(row.value("key", ""));
  return keys;
}

class SuiteRun {
 public:
  SuiteRun(const Suite& suite, const BenchOptions& options, const StageMaker& make_stage)
      : suite_(suite),
        options_(options),
        make_stage_(make_stage),
        file_(results_file(options), options.resume),
        checkpoint_(options.out / "interrupted.jsonl", options.resume) {
    if (options.resume) finished_ = finished_keys(file_.path());
    write_text(options.out / "suite.json", suite_as_run().dump(2) + "\n");
    plan();
  }

  BenchResult run() {
    result_.results = file_.path();
    for (const PlaceToMeasure& place : places_) run_place(place);
    report("done");
    return result_;
  }

 private:
  static fs::path results_file(const BenchOptions& options) {
    if (options.shards < 1 || options.shard < 1 || options.shard > options.shards)
      fail(fmt::format("shard {}/{}: the first number must be in 1..{}", options.shard, options.shards,
                       options.shards));
    fs::path file = options.out / "results.jsonl";
    if (options.overwrite && !options.resume) fs::remove(file);
    return file;
  }

  // The suite with its scenes found and its sizes spelled out, so that it can be run again from this folder.
  json suite_as_run() const {
    json scenes = json::array(), sizes = json::array();
    for (const fs::path& scene : suite_.scenes) scenes.push_back(scene.string());
    for (const Extent& size : suite_.sizes) sizes.push_back({size.width, size.height});
    return {{"schema", 1},
            {"scenes", scenes},
            {"size", sizes},
            {"light_scale", suite_.light_scales},
            {"camera", suite_.camera},
            {"baseline", suite_.baseline},
            {"graphs", suite_.graphs_json.empty() ? json(nullptr) : json::parse(suite_.graphs_json)},
            {"warmup", suite_.warmup},
            {"repeat", suite_.repeat},
            {"instrumented", suite_.instrumented},
            {"seconds", suite_.seconds},
            {"least", suite_.least},
            {"frames", suite_.frames},
            {"fps", suite_.fps},
            {"images", suite_.images},
            {"reference", {{"samples", suite_.samples}}}};
  }

  static bool runs_at(const SuiteConfig& config, const SuitePlace& place) {
    const auto holds = [](const auto& all, const auto& one) {
      return std::find(all.begin(), all.end(), one) != all.end();
    };
    return holds(config.sizes, place.size) && holds(config.light_scales, place.light_scale);
  }

  void plan() {
    size_t index = 0;
    for (const fs::path& scene : suite_.scenes)
      for (const double light_scale : all_light_scales(suite_))
        for (const Extent& size : all_sizes(suite_)) plan_place({scene, size, light_scale}, index);
  }

  // `index`: of the next row among those of all shards.
  void plan_place(const SuitePlace& at, size_t& index) {
    PlaceToMeasure place{at, {}};
    for (size_t i = 0; i < suite_.configs.size(); ++i) {
      if (!runs_at(suite_.configs[i], at)) continue;
      if (index++ % options_.shards != options_.shard - 1) continue;
      place.configs.push_back(i);
      if (finished_.count(key_of(at, i)) != 0) place.finished.insert(i);
    }
    const size_t missing = place.configs.size() - place.finished.size();
    result_.resumed += place.finished.size();
    total_ += missing;
    if (missing > 0) places_.push_back(std::move(place));
  }

  std::string key_of(const SuitePlace& place, size_t config) const {
    return row_of(suite_, options_, place, suite_.configs[config]).key;
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
    file_.append(to_json(row));
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
        Row row = row_of(suite_, options_, place, suite_.configs[config]);
        row.status = std::string("error: ") + error.what();
        write(row);
      }
      return;
    }
    for (const Chunk& chunk : chunks_of(place)) run_chunk(place, *stage, chunk);
  }

  // Techniques with the same baseline are measured together. The baseline itself first, when it is to be
  // measured. What is finished counts, so that a resumed suite has the same chunks.
  std::vector<Chunk> chunks_of(const PlaceToMeasure& place) const {
    std::map<size_t, std::vector<size_t>> groups;
    for (const size_t config : place.configs) {
      std::vector<size_t>& group = groups[suite_.configs[config].baseline];
      group.insert(suite_.configs[config].baseline == config ? group.begin() : group.end(), config);
    }
    std::vector<Chunk> chunks;
    // A sequence that is interrupted begins anew: one technique at a time, so that no more than its row is
    // lost.
    const size_t step = suite_.frames > 0 ? 1 : std::max<size_t>(1, options_.max_alive - 1);
    for (const auto& [baseline, configs] : groups)
      for (size_t first = 0; first < configs.size(); first += step) {
        const size_t last = std::min(configs.size(), first + step);
        chunks.push_back({baseline, {configs.begin() + long(first), configs.begin() + long(last)}});
      }
    return chunks;
  }

  // Of what is measured in turn, in this run or in the one that it resumes.
  std::string group_of(const SuitePlace& place, const Chunk& chunk) const {
    json keys = {key_of(place, chunk.baseline)};
    for (const size_t config : chunk.configs) keys.push_back(key_of(place, config));
    return canonical_hash(keys);
  }

  struct Entry {
    size_t config = 0;
    bool wanted = true;  // false: the baseline, there for the ratios only
    Row row;
    std::unique_ptr<Subject> subject;
  };

  Entry open(const SuitePlace& place, Stage& stage, size_t config, bool wanted) const {
    Entry entry{config, wanted, row_of(suite_, options_, place, suite_.configs[config]), nullptr};
    const Stopwatch watch;
    try {
      entry.subject = stage.open(suite_.configs[config]);
      entry.row.harness_seconds["open"] = watch.seconds();
    } catch (const std::exception& error) {
      entry.row.status = std::string("error: ") + error.what();
    }
    return entry;
  }

  void measure(std::vector<Entry>& entries, Stage& stage, const std::string& scene) {
    std::vector<Subject*> subjects;
    std::vector<Entry*> open_entries;
    RoundSettings settings{suite_.warmup, suite_.repeat, suite_.instrumented};
    settings.seconds = suite_.seconds;
    settings.least = suite_.least;
    size_t wanted = 0;
    for (Entry& entry : entries) {
      wanted += entry.wanted ? 1 : 0;
      if (!entry.subject) continue;
      if (&entry == &entries.front()) settings.baseline = 0;
      subjects.push_back(entry.subject.get());
      open_entries.push_back(&entry);
    }
    settings.sequence = suite_.frames > 0;
    if (settings.sequence) settings.repeat = suite_.frames;
    // A sequence cannot be gone on with: what a frame shows depends on those before it.
    std::vector<Samples> before;
    for (const Entry* entry : open_entries)
      if (!settings.sequence) before.push_back(checkpoint_.of(entry->row.key));
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
      open_entries[i]->row.harness_seconds["frames"] = seconds_of(samples[i]);
      if (!samples[i].error.empty()) open_entries[i]->row.status = "error: " + samples[i].error;
      open_entries[i]->row.samples = std::move(samples[i]);
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
      report(fmt::format("{}: {}", scene, label(suite_.configs[config])));
      entries.push_back(open(place, stage, config, true));
    }
    checkpoint_.begin(group_of(place, chunk));
    measure(entries, stage, scene);
    const std::vector<double> base_ms = entries.front().row.samples.frame_ms();
    for (Entry& entry : entries) {
      if (!entry.wanted) continue;
      finish(stage, chunk.baseline, base_ms, entry);
      write(entry.row);
      entry.subject.reset();
    }
    checkpoint_.end();
  }

  void finish(Stage& stage, size_t baseline, const std::vector<double>& base_ms, Entry& entry) const {
    if (entry.row.status != "ok" || !entry.subject) return;
    const std::vector<double> ratios = pair_ratios(entry.row.samples.frame_ms(), base_ms);
    if (!ratios.empty()) entry.row.ratio = Ratio{label(suite_.configs[baseline]), summarise(ratios)};
    const Stopwatch watch;
    try {
      stage.finish(suite_.configs[entry.config], *entry.subject, entry.row);
      entry.row.harness_seconds["error"] = watch.seconds();
    } catch (const std::exception& error) {
      entry.row.status = std::string("error: ") + error.what();
    }
  }

  const Suite& suite_;
  const BenchOptions& options_;
  const StageMaker& make_stage_;
  ResultsFile file_;
  Checkpoint checkpoint_;
  std::set<std::string> finished_;
  std::vector<PlaceToMeasure> places_;
  size_t total_ = 0;
  BenchResult result_;
};

}  // namespace

std::string label(const SuiteConfig& config) {
  std::string text = config.graph.name;
  for (const auto& [name, value] : config.set) text += fmt::format(" {}={}", name, to_string(value));
  return text;
}

BenchResult run_suite(const Suite& suite, const BenchOptions& options, const StageMaker& make_stage) {
  return SuiteRun(suite, options, make_stage).run();
}

}  // namespace gnomon
