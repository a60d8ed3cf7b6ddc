// Cases, verdicts and the map of the stability walk, and processes that die: no device.
#include "bench/stability/stability.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/stability/stability_process.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

using Ran = StabilityMeasurement::Ran;
using Verdict = StabilityVerdict;

StabilityMeasurement measured(double rmse, double constant = 0.4) {
  StabilityMeasurement m;
  m.reference = "hard", m.pixels = 20000, m.rmse = rmse, m.constant_rmse = constant;
  return m;
}

TEST(StabilityCases, AreReadAndWritten) {
  EXPECT_TRUE(parse_stability_case("base").empty());
  const StabilityCase pair = parse_stability_case("offset=1e6,size=31x17");
  ASSERT_EQ(pair.size(), 2u);
  EXPECT_EQ(pair[1], (std::pair<std::string, std::string>{"size", "31x17"}));
  EXPECT_EQ(to_string(pair), "offset=1e6,size=31x17");
  EXPECT_EQ(to_string(StabilityCase{}), "base");
  for (const char* bad : {"", "offset", "offset=", "ofset=1", "offset=far", "offset=1,offset=2", "size=3",
                          "size=0x9", "fov=200", "scale=-1", "offset=nan"})
    EXPECT_THROW(parse_stability_case(bad), Error) << bad;
}

TEST(StabilityCases, EveryWalkedValueIsOne) {
  for (const StabilityAxis& axis : stability_axes()) {
    EXPECT_FALSE(axis.values.empty()) << axis.name;
    EXPECT_FALSE(axis.quick.empty()) << axis.name;
    EXPECT_FALSE(axis.help.empty()) << axis.name;
    for (const auto& values : {axis.values, axis.quick})
      for (const std::string& value : values)
        EXPECT_NO_THROW(parse_stability_case(axis.name + "=" + value)) << value;
  }
}

TEST(StabilityVerdicts, ComeFromTheErrorAtTheBaseCase) {
  const StabilityMeasurement base = measured(0.1);
  const auto verdict = [&](const StabilityMeasurement& m) { return judge_stability({}, m, base).verdict; };
  // 1.1 x 0.1, and two pixels of 20000: sqrt(0.11^2 + 2/20000) = 0.11045...
  EXPECT_EQ(verdict(measured(0.1104)), Verdict::holds);
  EXPECT_EQ(verdict(measured(0.1106)), Verdict::degrades);
  EXPECT_EQ(verdict(measured(0.41)), Verdict::fails);
  EXPECT_FALSE(judge_stability({}, measured(0.41), base).broken);
  StabilityMeasurement nothing_counted = measured(std::nan(""));
  nothing_counted.pixels = 0;
  EXPECT_EQ(verdict(nothing_counted), Verdict::holds);
}

TEST(StabilityVerdicts, WhatMayNeverHappenFailsWhateverTheError) {
  const StabilityMeasurement base = measured(0.1);
  std::vector<StabilityMeasurement> bad(6, base);
  bad[0].nonfinite = 1;
  bad[1].out_of_range = 1;
  bad[2].repeats = false;
  bad[3].validation = {"a message"};
  bad[4].ran = Ran::crashed;
  bad[5].ran = Ran::timed_out;
  for (const StabilityMeasurement& m : bad) {
    const StabilityFinding finding = judge_stability({}, m, base);
    EXPECT_EQ(finding.verdict, Verdict::fails);
    EXPECT_TRUE(finding.broken);
    EXPECT_FALSE(finding.reason.empty());
  }
  StabilityMeasurement refused;
  refused.ran = Ran::refused, refused.message = "must be odd";
  EXPECT_EQ(judge_stability({}, refused, base).verdict, Verdict::refuses);
}

TEST(StabilityVerdicts, AWarningOfItsOwnPutsACaseOutsideTheDomain) {
  StabilityMeasurement base = measured(0.1);
  base.warnings = {"an open mesh"};
  StabilityMeasurement m = measured(0.3);
  m.warnings = {"an open mesh"};
  EXPECT_EQ(judge_stability({}, m, base).verdict, Verdict::degrades);
  m.warnings.emplace_back("the light grazes");
  const StabilityFinding warned = judge_stability({}, m, base);
  EXPECT_EQ(warned.verdict, Verdict::warned);
  EXPECT_NE(warned.reason.find("the light grazes"), std::string::npos);
  m.rmse = 0.9;
  EXPECT_EQ(judge_stability({}, m, base).verdict, Verdict::warned);
  m.rmse = 0.1;  // it holds nevertheless
  EXPECT_EQ(judge_stability({}, m, base).verdict, Verdict::holds);
  m.nonfinite = 1;  // what may never happen, warned of or not
  EXPECT_EQ(judge_stability({}, m, base).verdict, Verdict::fails);
}

TEST(StabilityMeasurements, SurviveJson) {
  StabilityMeasurement m = measured(0.25);
  m.nonfinite = 3, m.out_of_range = 2, m.repeats = false, m.misclassified = 0.125, m.acne = 0.5;
  m.validation = {"v"}, m.warnings = {"w"};
  const StabilityMeasurement back = measurement_from(to_json(m));
  EXPECT_EQ(to_json(back), to_json(m));
  EXPECT_EQ(back.acne, m.acne);
  EXPECT_FALSE(back.leak);
}

// Error grows with the field of view, the process dies at one scale, and nothing else happens.
StabilityMeasurement pretend(const std::filesystem::path&, const StabilityCase& test, bool) {
  StabilityMeasurement m = measured(0.1);
  for (const auto& [axis, value] : test) {
    if (axis == "fov" && value == "170") m.rmse = 0.2;
    if (axis == "scale" && value == "1e6") m.ran = Ran::crashed, m.message = "signal 11";
    if (axis == "kernel") m.ran = Ran::not_applicable;
  }
  return m;
}

TEST(StabilityWalk, MapsAxesStatesDomainsAndReproduces) {
  const StabilityOptions whole;
  const StabilityRow row =
      walk_stability("some/technique.json", false, whole, {"fov", "scale", "kernel", "offset"}, pretend);
  const auto domain = stated_domain(row);
  ASSERT_TRUE(domain.contains("fov"));
  EXPECT_NE(domain.at("fov").find("degrades at 170"), std::string::npos);
  ASSERT_TRUE(domain.contains("scale"));
  EXPECT_NE(domain.at("scale").find("fails at 1e6"), std::string::npos);
  EXPECT_FALSE(domain.contains("offset"));
  const nlohmann::json json = to_json({row}, whole);
  const nlohmann::json& technique = json.at("techniques").at(0);
  EXPECT_EQ(technique.at("map").at("fov"), "degrades");
  EXPECT_EQ(technique.at("map").at("scale"), "fails");
  EXPECT_EQ(technique.at("map").at("offset"), "holds");
  EXPECT_FALSE(technique.at("map").contains("kernel"));
  EXPECT_EQ(technique.at("first_failure").at("command"),
            "gnomon stability --graph some/technique.json --case scale=1e6");
  // Pairs: the worst point of each of the three axes, each two together.
  size_t pairs = 0;
  for (const StabilityFinding& f : row.findings) pairs += f.test.size() == 2;
  EXPECT_EQ(pairs, 3u);
  const std::string report = stability_report({row}, whole);
  EXPECT_NE(report.find("| fov | degrades 170 |"), std::string::npos) << report;
}

TEST(StabilityWalk, LeavesOutSkippedPoints) {
  StabilityOptions whole;
  whole.skipped = {{{"fov", "170"}}, {{"scale", "1e6"}}};
  const StabilityRow row = walk_stability("g.json", false, whole, {"fov", "scale"}, pretend);
  for (const StabilityFinding& f : row.findings) EXPECT_EQ(f.verdict, Verdict::holds) << to_string(f.test);
  EXPECT_FALSE(row.findings.empty());
}

TEST(StabilityWalk, EndsWhereTheBaseCaseFails) {
  const auto dies = [](const std::filesystem::path&, const StabilityCase&, bool) {
    StabilityMeasurement m;
    m.ran = Ran::timed_out, m.message = "no answer in 1 s";
    return m;
  };
  const StabilityRow row = walk_stability("g.json", true, {}, {}, dies);
  ASSERT_EQ(row.findings.size(), 1u);
  EXPECT_TRUE(row.findings.front().test.empty());
  EXPECT_TRUE(row.findings.front().broken);
}

constexpr uint64_t plenty = uint64_t{1} << 46;  // bytes of address space: a sanitizer reserves 2^44

TEST(StabilityProcess, SaysHowItsWorkEnded) {
  using Ended = ChildOutcome::Ended;
  const std::string long_text(100000, 'x');  // more than a pipe holds
  const ChildOutcome done = run_in_child([&] { return long_text; }, 20, plenty);
  EXPECT_EQ(done.ended, Ended::done);
  EXPECT_EQ(done.text, long_text);
  const ChildOutcome killed = run_in_child([]() -> std::string { return raise(SIGKILL), ""; }, 20, plenty);
  EXPECT_EQ(killed.ended, Ended::crashed);
  EXPECT_NE(killed.text.find("signal 9"), std::string::npos);
  const ChildOutcome threw = run_in_child([]() -> std::string { fail("no such thing"); }, 20, plenty);
  EXPECT_EQ(threw.ended, Ended::crashed);
  EXPECT_EQ(threw.text, "no such thing");
  const ChildOutcome hung = run_in_child([]() -> std::string { return pause(), ""; }, 0.2, plenty);
  EXPECT_EQ(hung.ended, Ended::timed_out);
}

}  // namespace
}  // namespace gnomon
