// Runs the cases of a stability walk, apart from one another where that is asked for.
#include "bench/stability/stability_cases.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "bench/run/results.h"
#include "bench/stability/stability_process.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using Ran = StabilityMeasurement::Ran;

class CasesHere : public StabilityCases {
 public:
  CasesHere(const StabilityOptions& options, const StabilityPlace& place)
      : options_(options), device_(open_device(place.device)), references_(make_stability_references()) {}
  bool follows_light(const fs::path& graph) override { return follows_light_size(device_, graph, options_); }
  StabilityMeasurement run(const fs::path& graph, const StabilityCase& test, bool area) override {
    return measure_stability(device_, graph, test, area, options_, *references_);
  }

 private:
  StabilityOptions options_;
  std::shared_ptr<Device> device_;
  std::shared_ptr<StabilityReferences> references_;
};

class CasesApart : public StabilityCases {
 public:
  CasesApart(const StabilityOptions& options, const StabilityPlace& place)
      : options_(options), place_(place) {}
  bool follows_light(const fs::path& graph) override {
    const auto outcome =
        apart([&] { return std::string(CasesHere(options_, place_).follows_light(graph) ? "yes" : "no"); });
    return outcome.ended == ChildOutcome::Ended::done && outcome.text == "yes";
  }
  StabilityMeasurement run(const fs::path& graph, const StabilityCase& test, bool area) override {
    const auto outcome = apart([&] {
      return to_json(CasesHere(options_, place_).run(graph, test, area))
          .dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    });
    StabilityMeasurement m;
    if (outcome.ended == ChildOutcome::Ended::done)
      return measurement_from(nlohmann::json::parse(outcome.text));
    m.ran = outcome.ended == ChildOutcome::Ended::crashed ? Ran::crashed : Ran::timed_out;
    m.message = outcome.text;
    return m;
  }

 private:
  ChildOutcome apart(const std::function<std::string()>& work) const {
    return run_in_child(work, place_.timeout, child_memory());
  }
  StabilityOptions options_;
  StabilityPlace place_;
};

// What other cases answer, each on disk as soon as it is known, and not asked again by a walk that goes on.
class CasesKept : public StabilityCases {
 public:
  CasesKept(std::unique_ptr<StabilityCases> cases, bool quick, const StabilityPlace& place)
      : cases_(std::move(cases)), quick_(quick), file_(prepared(place), place.resume) {
    for (nlohmann::json& row : read_lines(file_.path()))
      known_.insert_or_assign(row.at("key").get<std::string>(), std::move(row));
  }
  bool follows_light(const fs::path& graph) override {
    const nlohmann::json row = asked(graph, "follows the light's size", [&](nlohmann::json& answer) {
      answer["follows"] = cases_->follows_light(graph);
    });
    return row.at("follows").get<bool>();
  }
  StabilityMeasurement run(const fs::path& graph, const StabilityCase& test, bool area) override {
    const std::string name = to_string(test) + (area ? " against the area light" : "");
    const nlohmann::json row = asked(graph, name, [&](nlohmann::json& answer) {
      answer["measured"] = to_json(cases_->run(graph, test, area));
    });
    return measurement_from(row.at("measured"));
  }

 private:
  static fs::path prepared(const StabilityPlace& place) {
    fs::path file = place.out / "cases.jsonl";
    std::error_code ignored;
    if (place.overwrite)
      fs::resize_file(file, 0, ignored);  // not removed: whenever it ends, the file is there
    return file;
  }
  nlohmann::json asked(const fs::path& graph, const std::string& what,
                       const std::function<void(nlohmann::json&)>& ask) {
    const std::string key = fmt::format("{}{}: {}", graph.string(), quick_ ? " (quick)" : "", what);
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    nlohmann::json row = {{"key", key}};
    ask(row);
    file_.append(row);
    return row;
  }

  std::unique_ptr<StabilityCases> cases_;
  bool quick_;
  ResultsFile file_;
  std::map<std::string, nlohmann::json> known_;
};

}  // namespace

std::unique_ptr<StabilityCases> stability_cases(const StabilityOptions& options,
                                                const StabilityPlace& place) {
  std::unique_ptr<StabilityCases> cases;
  if (place.apart)
    cases = std::make_unique<CasesApart>(options, place);
  else
    cases = std::make_unique<CasesHere>(options, place);
  if (place.out.empty()) return cases;
  return std::make_unique<CasesKept>(std::move(cases), options.quick, place);
}

}  // namespace gnomon
