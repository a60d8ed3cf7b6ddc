// Seeds of every target: what the project ships, and what its writers write.
#include "tests/fuzz/seeds.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/run/row.h"
#include "engine/base/input_file.h"
#include "engine/base/resource_root.h"
#include "engine/graph/graph.h"
#include "tests/fuzz/target.h"

namespace gnomon::fuzz {
namespace {

using nlohmann::json;

Seeds graph_seeds() {
  Seeds all;
  for (const auto& file : all_graphs()) all[file.stem().string()] = read_input_file(file);
  return all;
}

// Every member once, and one of each kind of sweep and pattern.
Seeds suite_seeds() {
  const std::string scenes = (resource_root() / "assets" / "scenes").string();
  const json whole = {
      {"schema", 1},
      {"scenes", {scenes + "/square_plane.glb", scenes + "/s*.glb"}},
      {"size", {{16, 9}, {32, 18}}},
      {"baseline", "shadow_mapping"},
      {"repeat", 3},
      {"warmup", 1},
      {"instrumented", 2},
      {"seconds", 0.5},
      {"least", 2},
      {"reference", {{"samples", 16}}},
      {"camera", 0},
      {"images", true},
      {"light_scale", {0, 1}},
      {"graphs",
       {"shadow_mapping",
        {{"name", "pcf"}, {"set", {{"kernel", {3, 5}}, {"shadow_map", {256, 512}}}}, {"size", {8, 8}}},
        {{"name", "area_uniform"}, {"light_scale", {0.5, 2}}}}}};
  json sequence = {{"schema", 1}, {"scenes", {scenes}}, {"size", {16, 9}},
                   {"frames", 4}, {"fps", 25},          {"graphs", {"shadow_mapping"}}};
  return {{"whole", whole.dump(1)}, {"sequence", sequence.dump()}};
}

}  // namespace

Seeds row_seeds() {
  Row row;
  row.key = "a", row.scene = "fence", row.scene_file = "fence.glb", row.graph = "pcf";
  row.vars = {{"kernel", int64_t{5}}, {"bias", std::string("none")}, {"far", 2.5}, {"on", true}};
  row.set = {{"kernel", int64_t{5}}};
  row.size = {640, 360};
  row.device.name = "device";
  const Summary summary{7, 4.5, 0.1, 4.25, 5, 0.98};
  row.frame_ms = row.record_ms = row.gpu_ms.overlapped = row.gpu_ms.isolated = summary;
  row.passes = {{.id = "a", .type = "pcf", .gpu_ms = {summary, summary}, .cpu_ms = 1}};
  MeasuredError& error = row.error.emplace();
  error.lights.resize(1);
  error.all = over_lights(error.lights);
  error.reference_noise = 0.01, error.flicker = 0.02;
  error.intervals = {{{"rmse", {0.1, 0.2}}}};
  row.reference = RowReference{16};
  row.left_out = {{"pass", "part", "reason"}};
  row.ratio = Ratio{"shadow_mapping", summary};
  row.warnings = {"one"};
  row.facts = {{"pixels", 3.0}};
  row.frames = {{0, 4, error}, {0.04, 5, {}}};
  row.sequence = SequenceFigures{2, Spread{0.1, 0.2}, Spread{0.1, 0.2}};
  row.harness_seconds = {{"open", 1.0}};
  row.images = {{"visibility", "images/a.png"}};
  Row other = row, failed = row;
  other.key = "b", other.vars["kernel"] = other.set["kernel"] = int64_t{9}, other.frame_ms->median = 9;
  failed.key = "c", failed.status = "error: none";
  return {
      {"three", to_json(row).dump() + "\n" + to_json(other).dump() + "\n" + to_json(failed).dump() + "\n"},
      {"one", to_json(row).dump() + "\n"},
      {"least", "{\"scene\":\"s\",\"graph\":\"g\",\"size\":[1,1],\"frame_ms\":{\"median\":1}}\n"}};
}

std::map<std::string, std::string> seeds(const Target& target) {
  const std::string name = target.name;
  if (name == "scene") return scene_seeds();
  if (name == "graph") return graph_seeds();
  if (name == "suite") return suite_seeds();
  if (name == "rows") return row_seeds();
  return name == "exr" ? exr_seeds() : png_seeds();
}

}  // namespace gnomon::fuzz
