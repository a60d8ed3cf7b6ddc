// How the cases of a stability walk are run: here, each in a process of its own, or taken from an earlier
// walk.
#pragma once

#include <filesystem>
#include <memory>

#include "bench/stability/stability.h"

namespace gnomon {

class StabilityCases {
 public:
  virtual ~StabilityCases() = default;
  // follows_light_size()
  virtual bool follows_light(const std::filesystem::path& graph) = 0;
  virtual StabilityMeasurement run(const std::filesystem::path& graph, const StabilityCase& test,
                                   bool area) = 0;
};

struct StabilityPlace {
  DeviceOptions device;
  bool apart = true;  // each case in a process of its own, so that a crash or a hang is a finding
  double timeout =
      1800;  // seconds a case, of those apart: three frames of the longest that a device may take
  std::filesystem::path out;  // answers are kept in its cases.jsonl; empty: nowhere
  bool resume = false;        // what cases.jsonl holds is not run again
  bool overwrite = false;     // throw away what it holds
};
std::unique_ptr<StabilityCases> stability_cases(const StabilityOptions& options, const StabilityPlace& place);

}  // namespace gnomon
