// What is done with graphs, suites and rows.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/report/compare.h"
#include "bench/report/pick.h"
#include "bench/report/report_data.h"
#include "bench/report/table.h"
#include "bench/run/suite.h"
#include "bench/run/suite_plan.h"
#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"
#include "tests/fuzz/target.h"

namespace gnomon::fuzz {

namespace fs = std::filesystem;

void use_graph(const fs::path& file) {
  const Graph graph = load_graph(file);
  // As written again it is the same.
  const nlohmann::json again = to_json(graph);
  try {
    parse_graph(again.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), "again");
  } catch (const Error& error) {
    throw std::logic_error(std::string("a graph that was read is refused as written: ") + error.what());
  }
  SceneFacts facts;  // of a light that shadows something, so that nothing is left out
  facts.triangles = 1;
  facts.lights = 1;
  facts.has_alpha_mask = facts.has_double_sided = facts.has_open_meshes = true;
  facts.shadowless = {{}};
  facts.light_size = {1};
  facts.penumbra = {1};
  facts.light_moves = {true};
  to_text(compile(graph, Declaration::Setting{}, facts));
  technique_passes(graph, Declaration::Setting{});
}

void use_suite(const fs::path& file) {
  const Suite suite = load_suite(file);
  suite_as_run(suite);
  BenchOptions options;
  options.out = file.parent_path();
  for (const PlaceToMeasure& place : planned_places(suite, options, {})) {
    for (const Chunk& chunk : chunks_of(suite, options, place)) group_of(suite, options, place, chunk);
    for (const size_t config : place.configs) planned_row(suite, options, place, suite.configs[config]);
  }
}

void use_rows(const fs::path& file) {
  const std::vector<ReportRow> sources = merge_results({file});
  std::vector<Row> rows;
  for (const ReportRow& source : sources) rows.push_back(source.row);
  to_table(rows);
  constexpr double tolerance = 0.05;
  to_table(compare_results(rows, {rows.rbegin(), rows.rend()}, tolerance));
  report_csv(report_data(sources));
  for (const std::string& metric : error_metrics()) pick_row(rows, {.max_ms = 10, .metric = metric});
  for (const Row& row : rows) to_json(row);
}

}  // namespace gnomon::fuzz
