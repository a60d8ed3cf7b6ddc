// Reports and comparisons from rows made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/report/compare.h"
#include "bench/report/pick.h"
#include "bench/report/report_data.h"
#include "bench/report/report_fit.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json row(const std::string& graph, int map, double ms, double rmse, double ratio = 1) {
  return {
      {"key", graph + std::to_string(map)},
      {"scene", "fence"},
      {"graph", graph},
      {"vars", {{"shadow_map", map}, {"bias", "none"}}},
      {"set", {{"shadow_map", map}}},
      {"size", {640, 360}},
      {"camera", 0},
      {"device", "test"},
      {"driver", "1"},
      {"reference", {{"samples", 0}}},
      {"frame_ms", {{"median", ms}, {"mad", 0}, {"ci95", {ms * 0.9, ms * 1.1}}, {"n", 7}}},
      {"ratio",
       {{"median", ratio},
        {"mad", 0},
        {"ci95", {ratio * 0.98, ratio * 1.02}},
        {"n", 7},
        {"baseline", "shadow_mapping"}}},
      {"error", {{"rmse", rmse}, {"ssim", 1 - rmse}, {"bias", -rmse}}},
      {"passes",
       {{{"id", "a"}, {"type", "gbuffer"}, {"iteration", 0}, {"gpu_ms", {{"overlapped", {{"median", 1.0}}}}}},
        {{"id", "b"}, {"type", "pcf"}, {"iteration", 0}, {"gpu_ms", {{"overlapped", {{"median", 2.0}}}}}},
        {{"id", "b"}, {"type", "pcf"}, {"iteration", 1}, {"gpu_ms", {{"overlapped", {{"median", 3.0}}}}}}}},
      {"left_out", json::array()},
      {"warnings", json::array()},
      {"status", "ok"}};
}

std::vector<Row> typed(const std::vector<json>& objects) {
  std::vector<Row> rows;
  for (const json& one : objects) rows.push_back(row_from(one));
  return rows;
}

json report_of(const std::vector<json>& rows) {
  std::vector<ReportRow> sources;
  for (const Row& one : typed(rows)) sources.push_back({one, "."});
  return report_data(sources);
}

TEST(PowerLaw, FindsTheExponentOfAnExactLaw) {
  const std::vector<double> x = {1, 2, 4, 8};
  std::vector<double> y;
  for (const double value : x) y.push_back(3 * std::pow(value, -1.5));
  const auto law = fit_power_law(x, y);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, -1.5, 1e-12);
  EXPECT_NEAR(law->factor, 3, 1e-12);
  EXPECT_NEAR(law->r2, 1, 1e-12);
  EXPECT_EQ(law->n, 4u);
}

TEST(PowerLaw, LeavesOutZerosAndNeedsTwoPlaces) {
  const auto law = fit_power_law(std::vector<double>{1, 2, 4}, std::vector<double>{0, 2, 8});
  ASSERT_TRUE(law);
  EXPECT_EQ(law->n, 2u);
  EXPECT_NEAR(law->exponent, 2, 1e-12);
  EXPECT_FALSE(fit_power_law(std::vector<double>{3, 3}, std::vector<double>{1, 2}));
  EXPECT_FALSE(fit_power_law({}, {}));
}

TEST(Report, FrontsSweepsAndFailuresOfAPlace) {
  json failed = row("vsm", 512, 1, 1);
  failed["status"] = "error: no memory";
  const json report = report_of({row("pcf", 512, 10, 0.2), row("pcf", 1024, 20, 0.1),
                                 row("pcf", 2048, 40, 0.05), row("esm", 512, 50, 0.3), failed});
  ASSERT_EQ(report["places"].size(), 1u);
  EXPECT_EQ(report["places"][0]["fronts"]["rmse"], json({0, 1, 2}));
  ASSERT_EQ(report["failed"].size(), 1u);
  EXPECT_EQ(report["failed"][0]["status"], "error: no memory");
  ASSERT_EQ(report["sweeps"].size(), 1u);
  const json& sweep = report["sweeps"][0];
  EXPECT_EQ(sweep["parameter"], "shadow_map");
  EXPECT_NEAR(sweep["ms"]["exponent"].get<double>(), 1, 1e-9);
  EXPECT_NEAR(sweep["errors"]["rmse"]["exponent"].get<double>(), -1, 1e-9);
}

// The machine was half as quick when `late` was measured: its ratio to the baseline of its rounds is 2 all
// the same, so that it stands at 20 ms and on the front, where its milliseconds would leave it behind
// `early`.
TEST(Report, SteadyTimeTakesOutTheMachinesDrift) {
  json base = row("base", 512, 10, 0.3), early = row("early", 512, 25, 0.2, 2.5),
       late = row("late", 512, 40, 0.1, 2);
  base["ratio"] = {
      {"median", 1.0}, {"mad", 0.0}, {"ci95", {1, 1}}, {"n", 7}, {"baseline", "base shadow_map=512"}};
  early["ratio"]["baseline"] = late["ratio"]["baseline"] = "base shadow_map=512";
  json lost = row("lost", 512, 5, 0.4, 3);
  lost["ratio"]["baseline"] = "nobody";
  const json report = report_of({base, early, late, lost});
  EXPECT_EQ(report["rows"][0]["steady_ms"]["median"], 10);
  EXPECT_DOUBLE_EQ(report["rows"][2]["steady_ms"]["median"].get<double>(), 20);
  EXPECT_DOUBLE_EQ(report["rows"][2]["steady_ms"]["high"].get<double>(), 20.4);
  EXPECT_EQ(report["rows"][3]["steady_ms"]["median"], 5);
  EXPECT_EQ(report["places"][0]["fronts"]["rmse"], json({3, 0, 1, 2}));
  EXPECT_EQ(report["places"][0]["steady_fronts"]["rmse"], json({3, 0, 2}));
}

TEST(Report, IntervalsOfTheErrorAreThoseOfTheRow) {
  json one = row("pcf", 512, 10, 0.2);
  one["error"]["ci95"] = {{"rmse", {0.15, 0.26}}, {"bias", {-0.3, 0.1}}};
  const json errors = report_of({one})["rows"][0]["errors"];
  EXPECT_EQ(errors["rmse"]["low"], 0.15);
  EXPECT_EQ(errors["rmse"]["high"], 0.26);
  EXPECT_EQ(errors["bias"]["low"], 0);  // its magnitude is shown
  EXPECT_EQ(errors["bias"]["high"], 0.3);
  EXPECT_EQ(errors["ssim"]["low"], errors["ssim"]["value"]);
}

TEST(Report, LessIsBetterInEveryErrorAndTurnsOfALoopAddUp) {
  const json report = report_of({row("pcf", 512, 10, 0.25)});
  const json& shown = report["rows"][0];
  EXPECT_DOUBLE_EQ(shown["errors"]["ssim"]["value"].get<double>(), 0.25);
  EXPECT_DOUBLE_EQ(shown["errors"]["bias"]["value"].get<double>(), 0.25);
  EXPECT_DOUBLE_EQ(shown["passes"][1]["ms"].get<double>(), 5);
  EXPECT_DOUBLE_EQ(shown["rest_ms"].get<double>(), 4);
}

TEST(Report, OutputSizesAreASweepOfTheirOwn) {
  json large = row("pcf", 512, 40, 0.2);
  large["size"] = {1280, 720};
  const json report = report_of({row("pcf", 512, 10, 0.2), large});
  ASSERT_EQ(report["places"].size(), 2u);
  ASSERT_EQ(report["sweeps"].size(), 1u);
  EXPECT_EQ(report["sweeps"][0]["parameter"], "output_pixels");
  EXPECT_NEAR(report["sweeps"][0]["ms"]["exponent"].get<double>(), 1, 1e-9);
}

TEST(Report, LightSizesAreASweepBetweenPlaces) {
  json half = row("pcf", 512, 10, 0.2), twice = row("pcf", 512, 20, 0.8);
  half["light_scale"] = 0.5, twice["light_scale"] = 2;
  const json report = report_of({twice, row("pcf", 512, 10, 0.4), half});
  ASSERT_EQ(report["places"].size(), 3u);
  ASSERT_EQ(report["sweeps"].size(), 1u);
  EXPECT_EQ(report["sweeps"][0]["parameter"], "light_scale");
  EXPECT_EQ(report["sweeps"][0]["x"], (json{0.5, 1, 2}));
  EXPECT_NEAR(report["sweeps"][0]["errors"]["rmse"]["exponent"].get<double>(), 1, 1e-9);
}

TEST(Report, CsvHasALinePerRowAndQuotes) {
  json odd = row("p,c\"f", 512, 10, 0.2);
  const std::string csv = report_csv(report_of({odd}));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
  EXPECT_NE(csv.find("\"p,c\"\"f\""), std::string::npos) << csv;
}

TEST(Report, CsvHasNoFormulas) {
  json odd = row("=cmd|' /C calc'!A0", 512, 10, 0.2);
  odd["scene"] = "@sum(1)", odd["device"] = "+1";
  const std::string csv = report_csv(report_of({odd}));
  for (const char* cell : {"\"'=cmd|", "\"'@sum(1)\"", "\"'+1\""})
    EXPECT_NE(csv.find(cell), std::string::npos) << cell << "\n" << csv;
  EXPECT_EQ(csv.find(",="), std::string::npos);
  json negative = row("pcf", 512, 10, 0.2, -1);  // numbers stay numbers
  EXPECT_NE(report_csv(report_of({negative})).find(",-1,"), std::string::npos);
}

TEST(Report, TheBaselineIsTheRowThatSaysSo) {
  json base = row("pcf", 512, 10, 0.2), other = row("pcf", 1024, 10, 0.2);
  base["baseline"] = true;
  base["ratio"]["mad"] = 0.01;  // measured again with each group, it need not be 1
  const json report = report_of({base, other});
  EXPECT_EQ(report["rows"][0]["baseline"], true);
  EXPECT_EQ(report["rows"][1]["baseline"], false);
}

TEST(Report, FiguresThatDoNotExistAreEmpty) {
  json none = row("pcf", 512, 10, 0.2);
  none["error"] = {{"rmse", nullptr}, {"misclassified", nullptr}, {"reason", "no pixel counts"}};
  none["frame_ms"] = none["ratio"] = nullptr;
  const json report = report_of({none});
  EXPECT_TRUE(report["rows"][0]["errors"].empty());
  EXPECT_TRUE(report["rows"][0]["ms"].is_null());
  EXPECT_TRUE(report["places"][0]["fronts"].empty());
}

TEST(Rows, AMemberOfAnotherKindIsAnErrorWithItsPlace) {
  json bad = row("pcf", 512, 10, 0.2);
  bad["frame_ms"]["median"] = "ten";
  try {
    row_from(bad, "results.jsonl", "line 3");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "results.jsonl: line 3: /frame_ms/median: must be a number");
  }
  EXPECT_THROW(row_from({{"camera", -1}}), Error);
  EXPECT_THROW(row_from({{"camera", 1e30}}), Error);
  EXPECT_THROW(row_from({{"passes", json::object()}}), Error);
  EXPECT_FALSE(row_from(json::object()).ok());
}

class Merge : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("report_merge_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "a");
    fs::create_directories(folder_ / "b");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::vector<json>& rows) const {
    std::ofstream file(folder_ / name / "results.jsonl");
    for (const json& one : rows) file << one.dump() << '\n';
  }
  fs::path folder_;
};

TEST_F(Merge, TakesTheLatestRowThatIsOk) {
  json failed = row("pcf", 512, 99, 9);
  failed["status"] = "error: lost";
  write("a", {row("pcf", 512, 10, 0.2), row("esm", 512, 10, 0.2)});
  write("b", {row("esm", 512, 20, 0.2), failed, row("vsm", 512, 1, 1)});
  const auto rows = merge_results({folder_ / "a", folder_ / "b"});
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].row.frame_ms->median, 10);
  EXPECT_EQ(rows[1].row.frame_ms->median, 20);
  EXPECT_EQ(rows[1].folder, folder_ / "b");
  EXPECT_EQ(rows[2].row.graph, "vsm");
}

TEST_F(Merge, SaysWhatIsMissing) {
  EXPECT_THROW(merge_results({folder_ / "c"}), Error);
  write("a", {});
  EXPECT_THROW(merge_results({folder_ / "a"}), Error);
}

Comparison compare_results(const std::vector<json>& before, const std::vector<json>& after,
                           double tolerance) {
  return gnomon::compare_results(typed(before), typed(after), tolerance);
}

TEST(Compare, EqualRunsHaveNoChange) {
  const std::vector<json> rows = {row("pcf", 512, 10, 0.2, 2)};
  const Comparison comparison = compare_results(rows, rows, 0.05);
  EXPECT_EQ(comparison.compared, 1u);
  EXPECT_TRUE(comparison.changes.empty());
  EXPECT_FALSE(comparison.regressed());
}

TEST(Compare, TimeNeedsIntervalsApartAndTheTolerance) {
  const std::vector<json> before = {row("pcf", 512, 10, 0.2, 2)};
  // Milliseconds alone say nothing; overlapping intervals neither.
  EXPECT_TRUE(compare_results(before, {row("pcf", 512, 90, 0.2, 2.05)}, 0).changes.empty());
  EXPECT_TRUE(compare_results(before, {row("pcf", 512, 10, 0.2, 2.1)}, 0.1).changes.empty());
  EXPECT_TRUE(compare_results(before, {row("pcf", 512, 10, 0.2, 3)}, 0.05).regressed());
  const Comparison faster = compare_results(before, {row("pcf", 512, 10, 0.2, 1)}, 0.05);
  ASSERT_EQ(faster.changes.size(), 1u);
  EXPECT_FALSE(faster.regressed());
}

TEST(Compare, CountsTheIntervalsThatOverlap) {
  // Intervals are 2 % to both sides; the baseline's own says nothing.
  json baseline = row("shadow_mapping", 512, 5, 0.3);
  baseline["ratio"]["ci95"] = {1, 1};
  baseline["baseline"] = true;
  const std::vector<json> before = {baseline, row("pcf", 512, 10, 0.2, 2), row("esm", 512, 10, 0.2, 2)};
  const Comparison comparison =
      compare_results(before, {baseline, row("pcf", 512, 10, 0.2, 2.05), row("esm", 512, 10, 0.2, 1.9)}, 0.1);
  EXPECT_EQ(comparison.intervals, 2u);
  EXPECT_EQ(comparison.overlapping, 1u);
  EXPECT_EQ(comparison.overlap(), 0.5);
  EXPECT_TRUE(comparison.changes.empty());  // within the tolerance
  EXPECT_NE(to_table(comparison).find("1 of 2 intervals"), std::string::npos);
  EXPECT_EQ(compare_results(before, {}, 0).overlap(), 1);
}

TEST(Compare, ErrorsAreExact) {
  const std::vector<json> before = {row("pcf", 512, 10, 0.25)};
  const Comparison worse = compare_results(before, {row("pcf", 512, 10, std::nextafter(0.25, 1))}, 0.05);
  EXPECT_TRUE(worse.regressed());
  EXPECT_FALSE(compare_results(before, {row("pcf", 512, 10, 0.125)}, 0.05).regressed());
}

TEST(Compare, RowsThatFailNowAreRegressionsAndMissingOnesAreNot) {
  json failed = row("pcf", 512, 10, 0.2);
  failed["status"] = "error: lost";
  failed["reference"] = nullptr;
  EXPECT_TRUE(compare_results({row("pcf", 512, 10, 0.2)}, {failed}, 0.05).regressed());
  const Comparison gone = compare_results({row("pcf", 512, 10, 0.2)}, {}, 0.05);
  ASSERT_EQ(gone.changes.size(), 1u);
  EXPECT_EQ(gone.changes[0].kind, Change::Kind::missing);
  EXPECT_FALSE(gone.regressed());
}

TEST(Pick, TakesTheLeastErrorInTimeAndTheLeastTimeForAnError) {
  json failed = row("msm", 512, 1, 0);
  failed["status"] = "error: lost";
  const std::vector<Row> rows =
      typed({row("pcf", 512, 10, 0.2), row("pcf", 2048, 40, 0.05), row("esm", 512, 20, 0.1), failed});
  PickRule rule;
  rule.max_ms = 22;  // esm's interval ends at 22
  EXPECT_EQ(pick_row(rows, rule), std::optional<size_t>(2));
  rule.max_ms = 21.9;
  EXPECT_EQ(pick_row(rows, rule), std::optional<size_t>(0));
  rule.max_ms.reset();
  rule.max_error = 0.1;
  EXPECT_EQ(pick_row(rows, rule), std::optional<size_t>(2));
  rule.max_error = 0.01;
  EXPECT_EQ(pick_row(rows, rule), std::nullopt);
}

}  // namespace
}  // namespace gnomon
