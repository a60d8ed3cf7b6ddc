// One case of the stability walk, rendered and measured.
#include "bench/stability/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <nlohmann/json.hpp>

#include "bench/error/measure.h"
#include "bench/run/row.h"
#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/render/renderer.h"
#include "passes/technique.h"

namespace gnomon {

// What a scene looks like at one size.
struct StabilityTruth {
  StabilityTruth(std::shared_ptr<const Scene> s, const ReferenceSettings& settings)
      : scene(std::move(s)), tracer(*scene), reference(tracer.trace(settings)) {}
  std::shared_ptr<const Scene> scene;
  ReferenceTracer tracer;
  Reference reference;
};
struct StabilityReferences {
  std::map<std::string, std::shared_ptr<const StabilityTruth>> by_case;
};
std::shared_ptr<StabilityReferences> make_stability_references() {
  return std::make_shared<StabilityReferences>();
}

namespace {

namespace fs = std::filesystem;
using Ran = StabilityMeasurement::Ran;

constexpr uint64_t kMostReferencePixels = uint64_t{1} << 21;  // larger images are not judged by their error
constexpr uint64_t kMostReferenceRays = uint64_t{1} << 24;    // fewer samples of the light in large images
constexpr uint32_t kFewestSamples = 16;
constexpr uint64_t kMostEdgePixels = uint64_t{1} << 16;  // acne and leak cost hundreds of rays a pixel
constexpr uint32_t kUsualMapSide = 1024;                 // texels: of techniques without a map
constexpr uint32_t kFramesOfHistory = 4;                 // rendered before a technique with history is judged

const StabilityAxis& axis_of(const std::string& name) {
  for (const StabilityAxis& axis : stability_axes())
    if (axis.name == name) return axis;
  fail("no such axis", name);
}

// Everything a case is, ready to be rendered.
struct Stage {
  StabilitySetup setup;
  Extent size;
  Values set;
  std::string scene_key;  // of what changes the reference
  bool applies = true;
};

void apply_variables(const StabilityAxis& axis, const std::string& value, const Graph& graph, Stage& stage) {
  const Values& known = graph.vars;
  std::vector<std::string> variables = axis.variables;
  if (axis.map_side) variables = map_side_variables(graph);
  bool any = false;
  for (const std::string& name : variables)
    if (known.contains(name)) stage.set.insert_or_assign(name, parse_value(value)), any = true;
  for (const auto& [name, with] : axis.with)
    if (known.contains(name)) stage.set.insert_or_assign(name, with);
  if ((axis.map_side || !axis.variables.empty()) && !any) stage.applies = false;
}

Stage stage_of(const StabilityCase& test, const Graph& graph, const StabilityOptions& options) {
  Stage stage;
  stage.size = options.size();
  for (const std::string& name : map_side_variables(graph)) stage.set[name] = options.shadow_map();
  for (const auto& [name, value] : test) {
    const StabilityAxis& axis = axis_of(name);
    apply_variables(axis, value, graph, stage);
    if (!axis.apply) continue;
    axis.apply(stage.setup, stage.size, value);
    stage.scene_key.append(name).append("=").append(value).append(",");
  }
  return stage;
}

struct Frame {
  Image visibility;
  std::optional<Image> color;
};

Frame render(Renderer& renderer, const Graph& graph) {
  renderer.play();
  const uint32_t frames = reads_history(graph) ? kFramesOfHistory : 1;
  for (uint32_t i = 0; i < frames; ++i) renderer.render(TimingMode::none);
  Frame frame{renderer.read("visibility"), {}};
  if (graph.outputs.contains("color")) frame.color = renderer.read("color");
  return frame;
}

bool same_bits(const Image& a, const Image& b) {  // a NaN equals itself
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

void check_values(const Frame& first, const Frame& second, StabilityMeasurement& m) {
  m.nonfinite = count_nonfinite(first.visibility) + (first.color ? count_nonfinite(*first.color) : 0);
  for (const float v : first.visibility.data) m.out_of_range += v < 0 || v > 1;
  m.repeats = same_bits(first.visibility, second.visibility) &&
              (!first.color || same_bits(*first.color, *second.color));
}

std::shared_ptr<const StabilityTruth> truth_of(const Stage& stage, std::shared_ptr<const Scene> scene,
                                               bool area, const StabilityOptions& options,
                                               StabilityReferences& references) {
  const uint64_t pixels = uint64_t(stage.size.width) * stage.size.height;
  if (pixels > kMostReferencePixels) return nullptr;
  auto& truth = references.by_case[(area ? "area " : "hard ") + stage.scene_key];
  if (truth) return truth;
  ReferenceSettings settings;
  settings.width = stage.size.width, settings.height = stage.size.height;
  if (area) {
    const uint64_t affordable = kMostReferenceRays / (pixels * scene->lights.size());
    settings.samples =
        static_cast<uint32_t>(std::clamp<uint64_t>(affordable, kFewestSamples, uint64_t{options.samples()}));
  }
  truth = std::make_shared<const StabilityTruth>(std::move(scene), settings);
  return truth;
}

// RMSE of each light's best image of one value, its mean, over the lights with counted pixels.
double constant_rmse(const Reference& reference) {
  double sum = 0;
  uint32_t lights = 0;
  for (uint32_t k = 0; k < reference.lights; ++k) {
    double n = 0, first = 0, second = 0;
    for (size_t i = 0; i < reference.visibility[k].size(); ++i)
      if (reference.domain[k][i] == Reference::counted) {
        const double v = reference.visibility[k][i];
        n += 1, first += v, second += v * v;
      }
    if (n == 0) continue;
    sum += std::sqrt(std::max(0.0, second / n - first * first / (n * n)));
    ++lights;
  }
  return lights > 0 ? sum / lights : 0;
}

void measure_error(const Image& visibility, const Graph& graph, const StabilityTruth& truth,
                   StabilityMeasurement& m) {
  const Reference& reference = truth.reference;
  EdgeSettings edges{&truth.tracer, truth.scene->cameras.front(), map_side(graph).value_or(kUsualMapSide)};
  std::vector<std::vector<uint32_t>> deep;
  if (uint64_t(reference.width) * reference.height > kMostEdgePixels)
    edges.tracer = nullptr;
  else
    for (uint32_t i = 0; i < reference.lights; ++i) deep.push_back(deep_umbra(reference, i, edges));
  const auto error = measure_visibility(visibility, reference, edges, deep).all;
  m.pixels = error.pixels;
  if (m.pixels == 0) return;
  m.rmse = error.rmse, m.misclassified = error.misclassified;
  m.acne = error.acne, m.leak = error.leak;
  m.constant_rmse = constant_rmse(reference);
}

RenderSettings settings_of(const Stage& stage, const StabilityOptions& options) {
  RenderSettings settings;
  settings.width = stage.size.width, settings.height = stage.size.height;
  settings.memory = options.memory;
  return settings;
}

void run(const std::shared_ptr<Device>& device, const Stage& stage, const Graph& graph, bool area,
         const StabilityOptions& options, StabilityReferences& references, StabilityMeasurement& m) {
  const auto scene = std::make_shared<const Scene>(stability_scene(stage.setup));
  std::optional<Renderer> renderer;
  try {
    renderer.emplace(device, scene, graph, settings_of(stage, options));
  } catch (const Error& error) {
    m.ran = Ran::refused, m.message = error.what();
    return;
  }
  const Frame first = render(*renderer, graph), second = render(*renderer, graph);
  m.warnings = renderer->warnings();
  check_values(first, second, m);
  const auto truth = truth_of(stage, scene, area, options, references);
  if (!truth || m.nonfinite > 0) return;
  m.reference = area ? "area" : "hard";
  measure_error(first.visibility, graph, *truth, m);
}

}  // namespace

StabilityMeasurement measure_stability(const std::shared_ptr<Device>& device, const fs::path& graph,
                                       const StabilityCase& test, bool area, const StabilityOptions& options,
                                       StabilityReferences& references) {
  StabilityMeasurement m;
  const Stage stage = stage_of(test, load_graph(graph), options);
  if (!stage.applies) {
    m.ran = Ran::not_applicable;
    return m;
  }
  const size_t messages = validation_messages(*device).size();
  std::optional<Graph> loaded;
  try {
    loaded = load_graph(graph, stage.set);
  } catch (const Error& error) {
    m.ran = Ran::refused, m.message = error.what();
    return m;
  }
  try {
    run(device, stage, *loaded, area, options, references, m);
  } catch (const Error& error) {
    m.ran = Ran::crashed, m.message = error.what();
  } catch (const std::bad_alloc&) {
    m.ran = Ran::refused, m.message = "out of memory";
  }
  const auto& all = validation_messages(*device);
  m.validation.assign(all.begin() + std::ptrdiff_t(messages), all.end());
  return m;
}

bool follows_light_size(const std::shared_ptr<Device>& device, const fs::path& graph,
                        const StabilityOptions& options) {
  const Stage stage = stage_of({}, load_graph(graph), options);
  const Graph loaded = load_graph(graph, stage.set);
  const auto visibility = [&](double light_size) {
    StabilitySetup setup = stage.setup;
    setup.light_size = light_size;
    const auto scene = std::make_shared<const Scene>(stability_scene(setup));
    Renderer renderer(device, scene, loaded, settings_of(stage, options));
    return render(renderer, loaded).visibility;
  };
  return !same_bits(visibility(stage.setup.light_size), visibility(0.5 * stage.setup.light_size));
}

// ------------------------------------------------------------------------------------------------- JSON

namespace {

constexpr std::pair<Ran, const char*> kRanNames[] = {{Ran::ran, "ran"},
                                                     {Ran::refused, "refused"},
                                                     {Ran::crashed, "crashed"},
                                                     {Ran::timed_out, "timed out"},
                                                     {Ran::not_applicable, "not applicable"}};

}  // namespace

nlohmann::json to_json(const StabilityMeasurement& m) {
  nlohmann::json json;
  for (const auto& [ran, name] : kRanNames)
    if (ran == m.ran) json["ran"] = name;
  if (!m.message.empty()) json["message"] = m.message;
  if (m.ran != Ran::ran) return json;
  json["nonfinite"] = m.nonfinite, json["out_of_range"] = m.out_of_range, json["repeats"] = m.repeats;
  if (!m.validation.empty()) json["validation"] = m.validation;
  if (!m.warnings.empty()) json["warnings"] = m.warnings;
  json["reference"] = m.reference, json["pixels"] = m.pixels;
  if (m.pixels == 0) return json;
  json["rmse"] = m.rmse, json["misclassified"] = m.misclassified, json["constant_rmse"] = m.constant_rmse;
  if (m.acne && std::isfinite(*m.acne)) json["acne"] = *m.acne;
  if (m.leak && std::isfinite(*m.leak)) json["leak"] = *m.leak;
  return json;
}

StabilityMeasurement measurement_from(const nlohmann::json& json) {
  StabilityMeasurement m;
  for (const auto& [ran, name] : kRanNames)
    if (json.at("ran") == name) m.ran = ran;
  m.message = json.value("message", "");
  m.nonfinite = json.value("nonfinite", uint64_t{0}),
  m.out_of_range = json.value("out_of_range", uint64_t{0});
  m.repeats = json.value("repeats", true);
  m.validation = json.value("validation", std::vector<std::string>());
  m.warnings = json.value("warnings", std::vector<std::string>());
  m.reference = json.value("reference", ""), m.pixels = json.value("pixels", uint64_t{0});
  const auto number = [&](const char* name) {
    return json.contains(name) && json[name].is_number() ? json[name].get<double>() : 0.0;
  };
  m.rmse = number("rmse"), m.misclassified = number("misclassified"),
  m.constant_rmse = number("constant_rmse");
  if (json.contains("acne")) m.acne = number("acne");
  if (json.contains("leak")) m.leak = number("leak");
  return m;
}

}  // namespace gnomon
