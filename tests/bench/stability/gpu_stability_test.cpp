// The quick stability walk: whatever the case, a technique's image is finite, in range, repeatable, and the
// layers are silent; and some bounds that techniques claim.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "bench/stability/stability.h"
#include "passes/technique.h"
#include "tests/parameter_name.h"
#include "tests/passes/silent_test.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using test::kernel_device;

const StabilityOptions& quick() {
  static const StabilityOptions options = [] {
    StabilityOptions o;
    o.quick = true;
    return o;
  }();
  return options;
}

StabilityReferences& references() {  // shared by all techniques
  static const auto all = make_stability_references();
  return *all;
}

StabilityMeasurement run(const fs::path& graph, const StabilityCase& test, bool area) {
  return measure_stability(kernel_device(), graph, test, area, quick(), references());
}

class EveryTechnique : public test::Silent, public testing::WithParamInterface<fs::path> {};
INSTANTIATE_TEST_SUITE_P(Stability, EveryTechnique, testing::ValuesIn(all_graphs()), test::ParameterName());

// Two cases a technique that every one must survive, and the axes in turn over the techniques.
std::vector<StabilityCase> cases_of(const fs::path& graph) {
  std::vector<StabilityCase> all;
  for (const StabilityAxis& axis : stability_axes())
    for (const std::string& value : axis.quick) all.push_back({{axis.name, value}});
  const auto graphs = all_graphs();
  const auto index = size_t(std::find(graphs.begin(), graphs.end(), graph) - graphs.begin());
  std::vector<StabilityCase> mine = {{{"offset", "1e6"}}, {{"scale", "1e-6"}}};
  constexpr size_t stride = 8;  // each case on an eighth of the techniques
  for (size_t i = index % stride; i < all.size(); i += stride)
    if (std::find(mine.begin(), mine.end(), all[i]) == mine.end()) mine.push_back(all[i]);
  return mine;
}

TEST_P(EveryTechnique, StaysFiniteInRangeAndRepeatable) {
  const bool area = shadow_kind(load_graph(GetParam())) == ShadowKind::soft;  // judged against its light
  const StabilityMeasurement base = run(GetParam(), {}, area);
  ASSERT_EQ(judge_stability({}, base, base).verdict, StabilityVerdict::holds);
  ASSERT_GT(base.pixels, 500u);
  EXPECT_LT(base.rmse, base.constant_rmse);
  for (const StabilityCase& test : cases_of(GetParam())) {
    const StabilityFinding finding = judge_stability(test, run(GetParam(), test, area), base);
    EXPECT_FALSE(finding.broken) << to_string(test) << ": " << finding.reason;
    // Far from the world's origin and in other units nothing may change.
    const std::string& axis = test.front().first;
    if (axis == "offset" || axis == "scale") {
      EXPECT_EQ(finding.verdict, StabilityVerdict::holds) << to_string(test) << ": " << finding.reason;
    }
  }
}

TEST(StabilityLight, IsFollowedByTechniquesThatSampleIt) {
  const auto follows = [](const char* graph) {
    return follows_light_size(kernel_device(), find_graph(graph), quick());
  };
  EXPECT_FALSE(follows("shadow_mapping"));
  EXPECT_TRUE(follows("area_adaptive_rb"));
}

}  // namespace
}  // namespace gnomon
