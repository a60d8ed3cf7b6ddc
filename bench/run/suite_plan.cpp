// Which rows a suite has, in which order and in whose company they are measured.
#include "bench/run/suite_plan.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/base/config.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

bool runs_at(const SuiteConfig& config, const SuitePlace& place) {
  const auto holds = [](const auto& all, const auto& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  };
  return holds(config.sizes, place.size) && holds(config.light_scales, place.light_scale);
}

}  // namespace

Row planned_row(const Suite& suite, const BenchOptions& options, const SuitePlace& place,
                const SuiteConfig& config) {
  Row row;
  set_scene(row, place.scene);
  describe_graph(row, config.graph);
  row.set = config.set;
  row.size = place.size;
  row.light_scale = place.light_scale;
  row.camera = suite.camera;
  row.memory.limit_bytes = suite.memory;
  row.device = options.device;
  std::error_code ignored;
  json identity = {row.scene_file.string(),
                   fs::file_size(row.scene_file, ignored),
                   row.graph_hash,
                   row.size.width,
                   row.size.height,
                   row.camera,
                   suite.repeat,
                   suite.instrumented,
                   suite.samples,
                   row.device.name,
                   row.device.driver,
                   version()};
  if (row.light_scale != 1) identity.push_back({{"light_scale", row.light_scale}});
  if (suite.frames > 0) identity.push_back({suite.frames, suite.fps});
  if (suite.seconds > 0) identity.push_back({{"seconds", suite.seconds}, {"least", suite.least}});
  row.key = canonical_hash(identity);
  return row;
}

std::vector<PlaceToMeasure> planned_places(const Suite& suite, const BenchOptions& options,
                                           const std::set<std::string>& finished) {
  std::vector<PlaceToMeasure> places;
  size_t index = 0;  // of the next row among those of all shards
  const auto plan = [&](const SuitePlace& at) {
    PlaceToMeasure place{at, {}, {}};
    for (size_t i = 0; i < suite.configs.size(); ++i) {
      if (!runs_at(suite.configs[i], at)) continue;
      if (index++ % options.shards != options.shard - 1) continue;
      place.configs.push_back(i);
      if (finished.contains(planned_row(suite, options, at, suite.configs[i]).key)) place.finished.insert(i);
    }
    if (!place.configs.empty()) places.push_back(std::move(place));
  };
  for (const fs::path& scene : suite.scenes)
    for (const double light_scale : all_light_scales(suite))
      for (const Extent& size : all_sizes(suite)) plan({scene, size, light_scale});
  return places;
}

std::vector<Chunk> chunks_of(const Suite& suite, const BenchOptions& options, const PlaceToMeasure& place) {
  std::map<size_t, std::vector<size_t>> groups;
  for (const size_t config : place.configs) {
    std::vector<size_t>& group = groups[suite.configs[config].baseline];
    group.insert(suite.configs[config].baseline == config ? group.begin() : group.end(), config);
  }
  std::vector<Chunk> chunks;
  // A sequence that is interrupted begins anew: one technique at a time, so that no more than its row is
  // lost.
  const size_t step = suite.frames > 0 ? 1 : std::max<size_t>(1, options.max_alive - 1);
  for (const auto& [baseline, configs] : groups)
    for (size_t first = 0; first < configs.size(); first += step) {
      const size_t last = std::min(configs.size(), first + step);
      chunks.push_back({baseline, {configs.begin() + long(first), configs.begin() + long(last)}});
    }
  return chunks;
}

std::string group_of(const Suite& suite, const BenchOptions& options, const SuitePlace& place,
                     const Chunk& chunk) {
  const auto key_of = [&](size_t config) {
    return planned_row(suite, options, place, suite.configs[config]).key;
  };
  json keys = {key_of(chunk.baseline)};
  for (const size_t config : chunk.configs) keys.push_back(key_of(config));
  return canonical_hash(keys);
}

json suite_as_run(const Suite& suite) {
  json scenes = json::array(), sizes = json::array();
  for (const fs::path& scene : suite.scenes) scenes.push_back(scene.string());
  for (const Extent& size : suite.sizes) sizes.push_back({size.width, size.height});
  return {{"schema", 1},
          {"scenes", scenes},
          {"size", sizes},
          {"light_scale", suite.light_scales},
          {"camera", suite.camera},
          {"baseline", suite.baseline},
          {"graphs", suite.graphs ? *suite.graphs : json()},
          {"warmup", suite.warmup},
          {"repeat", suite.repeat},
          {"instrumented", suite.instrumented},
          {"seconds", suite.seconds},
          {"least", suite.least},
          {"frames", suite.frames},
          {"fps", suite.fps},
          {"images", suite.images},
          {"reference", {{"samples", suite.samples}}}};
}

}  // namespace gnomon
