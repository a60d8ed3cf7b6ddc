// From measurements to verdicts, and from verdicts to the map of techniques and axes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/stability/stability.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using Ran = StabilityMeasurement::Ran;
using Verdict = StabilityVerdict;

constexpr double kAllowedGrowth = 1.1;  // of the base case's RMSE
constexpr double kAllowedPixels = 2;    // wrong by 1, of the counted ones: an edge may fall otherwise
constexpr size_t kPairAxes = 4;         // of the worst axes, each two are walked together

double bound(const StabilityMeasurement& m, const StabilityMeasurement& base) {
  const double grown = kAllowedGrowth * base.rmse;
  return std::sqrt(grown * grown + kAllowedPixels / static_cast<double>(m.pixels));
}

// What may never happen, however extreme the case is; empty: nothing of it did.
std::string breach(const StabilityMeasurement& m) {
  if (m.ran == Ran::crashed) return "crash: " + m.message;
  if (m.ran == Ran::timed_out) return "time-out: " + m.message;
  if (m.nonfinite > 0) return fmt::format("{} values are not finite", m.nonfinite);
  if (m.out_of_range > 0) return fmt::format("{} values are outside 0..1", m.out_of_range);
  if (!m.repeats) return "two frames differ";
  if (!m.validation.empty()) return "validation: " + m.validation.front();
  return {};
}

// The first warning that the base case does not have; empty: none.
std::string own_warning(const StabilityMeasurement& m, const StabilityMeasurement& base) {
  for (const std::string& warning : m.warnings)
    if (std::find(base.warnings.begin(), base.warnings.end(), warning) == base.warnings.end()) return warning;
  return {};
}

double error_ratio(const StabilityFinding& finding, const StabilityMeasurement& base) {
  return finding.measured.pixels > 0 ? finding.measured.rmse / bound(finding.measured, base) : 0;
}

}  // namespace

std::string to_string(StabilityVerdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::warned:
      return "warned";
    case Verdict::refuses:
      return "refuses";
    case Verdict::degrades:
      return "degrades";
    case Verdict::fails:
      break;
  }
  return "fails";
}

StabilityFinding judge_stability(const StabilityCase& test, const StabilityMeasurement& measured,
                                 const StabilityMeasurement& base) {
  StabilityFinding finding{test, measured, Verdict::holds, false, {}};
  if (measured.ran == Ran::refused) {
    finding.verdict = Verdict::refuses;
    finding.reason = measured.message;
    return finding;
  }
  finding.reason = breach(measured);
  finding.broken = !finding.reason.empty();
  if (finding.broken) finding.verdict = Verdict::fails;
  if (finding.broken || measured.pixels == 0 || measured.rmse <= bound(measured, base)) return finding;
  const bool useless = measured.rmse >= measured.constant_rmse;
  finding.verdict = useless ? Verdict::fails : Verdict::degrades;
  finding.reason = fmt::format("RMSE {:.3f}, {:.3f} at the base case", measured.rmse, base.rmse);
  if (useless) finding.reason += fmt::format(", {:.3f} of an image of one value", measured.constant_rmse);
  if (const std::string warning = own_warning(measured, base); !warning.empty()) {
    finding.verdict = Verdict::warned;
    finding.reason += "; " + warning;
  }
  return finding;
}

namespace {

std::vector<StabilityCase> single_cases(const StabilityOptions& options,
                                        const std::vector<std::string>& wanted) {
  std::vector<StabilityCase> cases;
  for (const StabilityAxis& axis : stability_axes()) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), axis.name) == wanted.end()) continue;
    for (const std::string& value : options.quick ? axis.quick : axis.values) {
      const StabilityCase test = {{axis.name, value}};
      const auto& skipped = options.skipped;
      if (std::find(skipped.begin(), skipped.end(), test) == skipped.end()) cases.push_back(test);
    }
  }
  return cases;
}

// Of each axis the point with the largest error inside the technique's domain; of those the worst, each two
// together.
std::vector<StabilityCase> worst_pairs(const StabilityRow& row) {
  std::map<std::string, const StabilityFinding*> worst;
  for (const StabilityFinding& f : row.findings) {
    if (f.verdict == Verdict::fails || f.verdict == Verdict::refuses || f.verdict == Verdict::warned ||
        f.test.size() != 1)
      continue;
    const StabilityFinding*& best = worst[f.test.front().first];
    if (best == nullptr || error_ratio(f, row.base) > error_ratio(*best, row.base)) best = &f;
  }
  std::vector<const StabilityFinding*> order;
  for (const auto& [axis, finding] : worst) order.push_back(finding);
  std::sort(order.begin(), order.end(), [&](const auto* a, const auto* b) {
    const double first = error_ratio(*a, row.base), second = error_ratio(*b, row.base);
    return first != second ? first > second : a->test < b->test;
  });
  order.resize(std::min(order.size(), kPairAxes));
  std::vector<StabilityCase> pairs;
  for (size_t i = 0; i < order.size(); ++i)
    for (size_t k = i + 1; k < order.size(); ++k) {
      StabilityCase pair = order[i]->test;
      pair.push_back(order[k]->test.front());
      pairs.push_back(std::move(pair));
    }
  return pairs;
}

}  // namespace

StabilityRow walk_stability(const fs::path& graph, bool area, const StabilityOptions& options,
                            const std::vector<std::string>& axes, const StabilityRunner& run,
                            const std::function<void(double, const std::string&)>& progress) {
  StabilityRow row;
  row.graph = graph, row.area = area;
  row.name = graph.stem().string();
  row.base = run(graph, {}, area);
  const auto walk = [&](const std::vector<StabilityCase>& cases, double from, double to) {
    for (size_t i = 0; i < cases.size(); ++i) {
      if (progress) progress(from + (to - from) * double(i) / double(cases.size()), to_string(cases[i]));
      const StabilityMeasurement m = run(graph, cases[i], area);
      if (m.ran != Ran::not_applicable) row.findings.push_back(judge_stability(cases[i], m, row.base));
    }
  };
  if (const StabilityFinding base = judge_stability({}, row.base, row.base); base.verdict != Verdict::holds) {
    row.findings.push_back(base);
    return row;
  }
  walk(single_cases(options, axes), 0, options.quick ? 1 : 0.95);
  if (!options.quick) walk(worst_pairs(row), 0.95, 1);
  return row;
}

// ----------------------------------------------------------------------------------------------- report

namespace {

std::string axis_name(const StabilityCase& test) {
  if (test.empty()) return "base";
  return test.size() == 1 ? test.front().first : "pairs";
}

// The names of axes that some technique was walked along, in the axes' order.
std::vector<std::string> walked_axes(const std::vector<StabilityRow>& rows) {
  std::set<std::string> seen;
  for (const StabilityRow& row : rows)
    for (const StabilityFinding& f : row.findings) seen.insert(axis_name(f.test));
  std::vector<std::string> names;
  if (seen.contains("base")) names.push_back("base");
  for (const StabilityAxis& axis : stability_axes())
    if (seen.contains(axis.name)) names.push_back(axis.name);
  if (seen.contains("pairs")) names.push_back("pairs");
  return names;
}

std::vector<const StabilityFinding*> along(const StabilityRow& row, const std::string& axis) {
  std::vector<const StabilityFinding*> findings;
  for (const StabilityFinding& f : row.findings)
    if (axis_name(f.test) == axis) findings.push_back(&f);
  return findings;
}

const StabilityFinding* worst_of(const std::vector<const StabilityFinding*>& findings) {
  const StabilityFinding* worst = nullptr;
  for (const StabilityFinding* f : findings)
    if (worst == nullptr || f->verdict > worst->verdict) worst = f;
  return worst;
}

std::string value_of(const StabilityCase& test) {
  return test.size() == 1 ? test.front().second : to_string(test);
}

std::string cell(const StabilityRow& row, const std::string& axis) {
  const StabilityFinding* worst = worst_of(along(row, axis));
  if (worst == nullptr) return "";
  if (worst->verdict == Verdict::holds) return "holds";
  return to_string(worst->verdict) + " " + value_of(worst->test);
}

std::string values_with(const std::vector<const StabilityFinding*>& findings, Verdict verdict) {
  std::string text;
  for (const StabilityFinding* f : findings)
    if (f->verdict == verdict) text += (text.empty() ? "" : ", ") + value_of(f->test);
  return text;
}

const StabilityFinding* first_failure(const StabilityRow& row) {
  for (const StabilityFinding& f : row.findings)
    if (f.broken) return &f;
  for (const StabilityFinding& f : row.findings)
    if (f.verdict == Verdict::fails) return &f;
  return nullptr;
}

std::string markdown_table(const std::vector<StabilityRow>& rows, const std::vector<std::string>& axes) {
  std::string text = "| axis |", rule = "|---|";
  for (const StabilityRow& row : rows) text += " " + row.name + " |", rule += "---|";
  text += "\n" + rule + "\n";
  for (const std::string& axis : axes) {
    text += "| " + axis + " |";
    for (const StabilityRow& row : rows) text += " " + cell(row, axis) + " |";
    text += "\n";
  }
  return text;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string reproduce(const StabilityRow& row, const StabilityCase& test, const StabilityOptions& options) {
  const auto known = all_graphs();
  const bool shipped = std::any_of(known.begin(), known.end(), [&](const fs::path& file) {
    std::error_code ignored;
    return fs::equivalent(file, row.graph, ignored);
  });
  return fmt::format("gnomon stability --graph {}{} --case {}", shipped ? row.name : row.graph.string(),
                     options.quick ? " --quick" : "", to_string(test));
}

std::map<std::string, std::string> stated_domain(const StabilityRow& row) {
  std::map<std::string, std::string> domain;
  for (const std::string& axis : walked_axes({row})) {
    const auto findings = along(row, axis);
    const std::string good = values_with(findings, Verdict::holds);
    std::string text = "holds at " + (good.empty() ? "no value walked" : good);
    bool all = true;
    for (const Verdict verdict : {Verdict::warned, Verdict::refuses, Verdict::degrades, Verdict::fails})
      if (const std::string values = values_with(findings, verdict); !values.empty())
        text += fmt::format("; {} at {}", to_string(verdict), values), all = false;
    if (!all) domain[axis] = text;
  }
  return domain;
}

nlohmann::json to_json(const std::vector<StabilityRow>& rows, const StabilityOptions& options) {
  nlohmann::json json = {{"schema", 1}, {"quick", options.quick}};
  json["size"] = {options.size().width, options.size().height};
  json["shadow_map"] = options.shadow_map();
  for (const StabilityAxis& axis : stability_axes())
    json["axes"].push_back({{"name", axis.name}, {"unit", axis.unit}, {"help", axis.help}});
  json["techniques"] = nlohmann::json::array();
  for (const StabilityRow& row : rows) {
    nlohmann::json technique = {{"name", row.name},
                                {"graph", row.graph.string()},
                                {"reference", row.area ? "area" : "hard"},
                                {"base", to_json(row.base)}};
    technique["map"] = nlohmann::json::object();
    for (const std::string& axis : walked_axes({row}))
      technique["map"][axis] = to_string(worst_of(along(row, axis))->verdict);
    technique["domain"] = stated_domain(row);
    technique["cases"] = nlohmann::json::array();
    for (const StabilityFinding& f : row.findings) {
      nlohmann::json one = to_json(f.measured);
      one["case"] = to_string(f.test), one["verdict"] = to_string(f.verdict), one["broken"] = f.broken;
      if (!f.reason.empty()) one["reason"] = f.reason;
      technique["cases"].push_back(std::move(one));
    }
    if (const StabilityFinding* failure = first_failure(row))
      technique["first_failure"] = {{"reason", failure->reason},
                                    {"command", reproduce(row, failure->test, options)}};
    json["techniques"].push_back(std::move(technique));
  }
  return json;
}

std::string stability_report(const std::vector<StabilityRow>& rows, const StabilityOptions& options) {
  std::string text = "# Stability map\n\n" + markdown_table(rows, walked_axes(rows));
  for (const StabilityRow& row : rows) {
    text += fmt::format("\n## {}\n\nBase case: RMSE {:.4f} against the {} reference.\n", row.name,
                        row.base.rmse, row.area ? "area light's" : "hard shadows'");
    const auto domain = stated_domain(row);
    if (domain.empty()) text += "\nHolds on every axis.\n";
    for (const auto& [axis, sentence] : domain) text += fmt::format("\n- {}: {}", axis, sentence);
    if (!domain.empty()) text += "\n";
    if (const StabilityFinding* failure = first_failure(row))
      text += fmt::format("\nFirst failing case: {}\n\n    {}\n", one_line(failure->reason),
                          reproduce(row, failure->test, options));
  }
  return text;
}

}  // namespace gnomon
