// Runs a suite: every technique on every scene and size, in turn, row by row into results.jsonl.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "bench/run/rounds.h"
#include "bench/run/row.h"
#include "bench/run/suite.h"

namespace gnomon {

// Where techniques are compared with one another.
struct SuitePlace {
  std::filesystem::path scene;
  Extent size;             // pixels
  double light_scale = 1;  // as with_light_scale()
};

// A place, ready for techniques. Made anew for each.
class Stage {
 public:
  virtual ~Stage() = default;
  virtual std::unique_ptr<Subject> open(
      const SuiteConfig& config) = 0;  // compiles, uploads; Error for what cannot run
  // After each frame of a suite's sequence.
  virtual void frame(const SuiteConfig& config, Subject& subject, uint32_t index, double frame_ms) {
    static_cast<void>(config), static_cast<void>(subject), static_cast<void>(index),
        static_cast<void>(frame_ms);
  }
  // After the rounds: memory, what was left out, warnings, error and non-finite values into the row.
  virtual void finish(const SuiteConfig& config, Subject& subject, Row& row) = 0;
};
using StageMaker = std::function<std::unique_ptr<Stage>(const Suite& suite, const SuitePlace& place)>;

struct BenchOptions {
  std::filesystem::path out;       // folder; results.jsonl and suite.json go there
  bool resume = false;             // skip rows that are there with status "ok"
  bool overwrite = false;          // throw away what is there
  uint32_t shard = 1, shards = 1;  // this run measures every shards-th row, from the shard-th (1..shards)
  uint32_t max_alive =
      8;              // techniques that hold memory at the same time, the baseline among them; at least 2
  DeviceInfo device;  // named in the rows
  std::function<void(double, const std::string&)> progress;  // 0..1 and what is going on; may be empty
};

struct BenchResult {
  std::filesystem::path results;
  size_t measured = 0;  // rows written, failures included
  size_t resumed = 0;   // rows that were there
  size_t failed = 0;    // rows with a status other than "ok"
  std::string stopped;  // why no further row could be written (full disk, ...); empty: all were
};

// A technique or scene that fails gives a row whose status says why, and the suite goes on; what makes every
// further row impossible ends it (BenchResult::stopped). Error: it cannot begin: bad options, there are rows
// already, another process writes them.
BenchResult run_suite(const Suite& suite, const BenchOptions& options, const StageMaker& make_stage);

}  // namespace gnomon
