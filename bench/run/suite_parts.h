// The parts that a suite is read in. Internal to suite.cpp and its neighbours.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/run/suite.h"
#include "engine/base/error.h"

namespace gnomon {

struct SuiteReading {
  Suite& suite;
  Problems& problems;
  std::string file;
};

// "scenes": fills Suite::scenes and notices. `scenes` may be null.
void read_scenes(SuiteReading& reading, const nlohmann::json* scenes, const std::string& place);

// "size" and "light_scale" of a suite or one of its graphs; `standard` where there are none.
std::vector<Extent> read_sizes(SuiteReading& reading, const nlohmann::json* size, const std::string& place,
                               const std::vector<Extent>& standard);
std::vector<double> read_light_scales(SuiteReading& reading, const nlohmann::json* scale,
                                      const std::string& place, const std::vector<double>& standard);

// "graphs": fills Suite::configs.
void read_graphs(SuiteReading& reading, const nlohmann::json* graphs, const std::string& place);
// Finds each configuration's baseline: the first entry that names the suite's holds the candidates, so that a
// later entry may sweep the same graph.
void match_baselines(SuiteReading& reading, const std::string& place);

}  // namespace gnomon
