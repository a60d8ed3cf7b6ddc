// Every graph, and so every pass, on small scenes: it runs, repeats, and stays within its limits, whatever it
// is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "engine/base/resource_root.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/renderer.h"
#include "engine/vulkan/shader.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"
#include "tests/passes/silent_test.h"

namespace gnomon {
namespace {

using hard_shadow::device;
namespace fs = std::filesystem;

// Passes of tests, which the test program registers beside the real ones.
bool of_tests(const std::string& type) {
  return type.starts_with("test_") || type.starts_with("t_") || type.starts_with("probe_");
}

// ------------------------------------------------------------------------------------------------ graphs

constexpr double kRounding = 1.0 / 1024;  // of a half float near one

RenderSettings small() {
  RenderSettings s;
  s.width = 96, s.height = 64;
  return s;
}

// 128 texels where the graph has a shadow map.
Graph small_graph(const fs::path& file) {
  const Graph graph = load_graph(file);
  if (!graph.vars.contains("shadow_map")) return graph;
  return load_graph(file, {{"shadow_map", std::int64_t(128)}});
}

// Names of the outputs that are images, and their pixels.
using Outputs = std::map<std::string, Image>;

Outputs frame(Renderer& renderer, const Graph& graph) {
  renderer.render(TimingMode::none);
  Outputs images;
  for (const auto& [name, port] : graph.outputs) images.emplace(name, renderer.read(name));
  return images;
}

Outputs frame(const std::shared_ptr<const Scene>& scene, const Graph& graph, const RenderSettings& s) {
  Renderer renderer(device(), scene, graph, s);
  return frame(renderer, graph);
}

// Bit for bit: a NaN equals itself.
bool same(const Outputs& a, const Outputs& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [name, image] : a) {
    const Image& other = b.at(name);
    if (image.channels != other.channels || image.data.size() != other.data.size()) return false;
    if (std::memcmp(image.data.data(), other.data.data(), image.data.size() * sizeof(float)) != 0)
      return false;
  }
  return true;
}

// Above 1 relative to the value, as half floats round.
double largest_difference(const Outputs& a, const Outputs& b) {
  double most = 0;
  for (const auto& [name, image] : a)
    for (size_t i = 0; i < image.data.size(); ++i) {
      const double one = image.data[i], other = b.at(name).data[i];
      most = std::max(most, std::abs(one - other) / std::max(1.0, std::abs(one)));
    }
  return most;
}

void expect_in_range(const Outputs& images, const RenderSettings& s, size_t lights, const std::string& what) {
  for (const auto& [name, image] : images) {
    EXPECT_EQ(image.width, s.width) << what << ", " << name;
    EXPECT_EQ(image.height, s.height) << what << ", " << name;
    const bool visibility = name == "visibility";
    EXPECT_EQ(image.channels.size(), visibility ? lights : image.channels.size()) << what;
    for (const float v : image.data) {
      if (std::isfinite(v) && v >= 0 && (!visibility || v <= 1)) continue;
      ADD_FAILURE() << what << ", " << name << ": " << v;
      break;
    }
  }
}

const std::vector<std::pair<std::string, std::shared_ptr<const Scene>>>& scenes() {
  static const auto loaded = [] {
    std::vector<std::pair<std::string, std::shared_ptr<const Scene>>> all;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(resource_root() / "assets" / "scenes"))
      if (entry.path().extension() == ".glb") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files)
      all.emplace_back(file.stem().string(), std::make_shared<Scene>(load_scene(file)));
    // A light of each type, so that every layer and every kind of face is there.
    Scene mixed = analytic::square_over_plane(analytic::light(LightType::spot, {1.5, 7, 1}));
    mixed.lights.push_back(analytic::light(LightType::directional, {-3, 5, 2}));
    mixed.lights.push_back(analytic::light(LightType::point, {-4, 4, -3}));
    all.emplace_back("three lights", std::make_shared<Scene>(std::move(mixed)));
    return all;
  }();
  return loaded;
}

class EveryGraph : public test::Silent, public testing::WithParamInterface<fs::path> {};
INSTANTIATE_TEST_SUITE_P(All, EveryGraph, testing::ValuesIn(all_graphs()), test::ParameterName());

// How a renderer is set up must not show in its image. Making renderers is what costs, so one frame answers
// several questions: a renderer that shares no memory and leaves nothing out, and has the first one's bits,
// shows that renderers agree, that sharing memory changes nothing, and that leaving out changes nothing.
// Where only rounding tells them apart, a third one with the same passes must have the same bits.
TEST_P(EveryGraph, RunsRepeatsAndIsTheSameHoweverItIsSetUp) {
  const Graph graph = small_graph(GetParam());
  EXPECT_TRUE(graph.outputs.contains("visibility"));
  RenderSettings unshared = small();
  unshared.alias = false;
  RenderSettings whole = unshared, kept = small();
  whole.keep_all = kept.keep_all = true;
  for (const auto& [name, scene] : scenes()) {
    Renderer renderer(device(), scene, graph, small());
    const Outputs first = frame(renderer, graph);
    expect_in_range(first, small(), scene->lights.size(), name);
    if (reads_history(graph)) renderer.play();  // begins again
    EXPECT_TRUE(same(first, frame(renderer, graph))) << name << ": two frames differ";
    if (name == scenes().back().first) {  // with all passes there, memory is shared in other ways
      EXPECT_LE(largest_difference(first, frame(scene, graph, kept)), kRounding) << name;
    }
    const Outputs other = frame(scene, graph, whole);
    if (same(first, other)) continue;
    EXPECT_LE(largest_difference(first, other), kRounding) << name << ": leaving out shows";
    EXPECT_TRUE(same(first, frame(scene, graph, unshared))) << name << ": sharing memory shows";
  }
}

TEST_P(EveryGraph, StandardDepthAndIsolatedPassesRunToo) {
  const Graph graph = small_graph(GetParam());
  RenderSettings standard = small();
  standard.reversed_z = false;
  const auto& [name, scene] = scenes().back();
  Renderer renderer(device(), scene, graph, standard);
  const FrameTiming t = renderer.render(TimingMode::isolated);
  EXPECT_GE(t.passes.size(), renderer.passes().size());
  expect_in_range(frame(renderer, graph), standard, scene->lights.size(), name);
}

// --------------------------------------------------------------------------------------------- registry

void add_types(const std::vector<GraphNode>& nodes, std::set<std::string>& types) {
  for (const GraphNode& node : nodes) {
    if (node.body.empty()) types.insert(node.type);
    add_types(node.body, types);
  }
}

std::vector<std::string> real_types() {
  std::vector<std::string> types;
  for (const std::string& type : PassRegistry::instance().types())
    if (!of_tests(type)) types.push_back(type);
  return types;
}

TEST(Registry, EveryPassIsUsedByAGraph) {
  std::set<std::string> used;
  for (const fs::path& file : all_graphs()) add_types(load_graph(file).nodes, used);
  // What the program shows through it no graph file can name.
  used.insert("image_source");
  used.insert("unshadowed");  // the compiler puts it into graphs
  for (const std::string& type : real_types()) EXPECT_TRUE(used.contains(type)) << type;
}

TEST(Registry, EveryPassSaysWhatItIs) {
  for (const std::string& type : real_types()) {
    Declaration d;
    PassRegistry::instance().make(type)->declare(d);
    EXPECT_FALSE(d.summary().empty()) << type;
    EXPECT_FALSE(d.ports().empty()) << type;
    for (const Port& port : d.ports()) EXPECT_FALSE(port.help.empty()) << type << "." << port.name;
    for (const ParamSpec& spec : d.param_specs()) EXPECT_FALSE(spec.help.empty()) << type << "." << spec.name;
  }
}

// ------------------------------------------------------------------------------------- use of parameters

std::map<std::string, std::set<std::string>>
    looked_up;  // by type: parameters that prepare() or record() read
const std::vector<std::string>& probed() {
  static const std::vector<std::string> types = real_types();
  return types;
}

// The pass itself, and notes what it looks up on the host.
class Probe : public Pass {
 public:
  explicit Probe(std::string type) : type_(std::move(type)), pass_(PassRegistry::instance().make(type_)) {}
  void declare(Declaration& d) const override { pass_->declare(d); }
  Need need(const SceneFacts& facts, const Params& p) const override { return pass_->need(facts, p); }
  void prepare(Environment& e) override {
    pass_->prepare(e);
    note(e.params());
  }
  void record(Context& c) override {
    pass_->record(c);
    note(c.params());
  }
  Step decide(const HostView& view) override { return pass_->decide(view); }

 private:
  void note(const Params& params) const {
    const auto unread = params.never_read();
    for (const ParamSpec& spec : params.specs())
      if (std::find(unread.begin(), unread.end(), spec.name) == unread.end())
        looked_up[type_].insert(spec.name);
  }
  std::string type_;
  std::unique_ptr<Pass> pass_;
};

constexpr size_t kMostTypes = 128;
template <size_t I>
std::unique_ptr<Pass> make_probe() {
  return std::make_unique<Probe>(probed()[I]);
}
template <size_t... I>
void add_probes(std::index_sequence<I...>) {
  const PassRegistry::Make makers[] = {make_probe<I>...};
  for (size_t i = 0; i < probed().size(); ++i)
    PassRegistry::instance().add("probe_" + probed()[i], makers[i]);
}

void probe(std::vector<GraphNode>& nodes) {
  for (GraphNode& node : nodes) {
    if (node.body.empty()) node.type = "probe_" + node.type;
    probe(node.body);
  }
}

// The text of every shader of the pass (files whose name begins with its type), includes expanded, comments
// gone.
std::string shader_text(const std::string& type) {
  std::string text;
  for (const auto& entry : fs::recursive_directory_iterator(resource_root() / "shaders" / "glsl")) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name.starts_with(type)) text += expand_includes(entry.path());
  }
  return std::regex_replace(text, std::regex("//[^\n]*"), "");
}

bool in_shaders(const std::string& text, const ParamSpec& spec) {
  const bool in_block = spec.type == ParamType::integer || spec.type == ParamType::number;
  std::string name = spec.name;
  if (!in_block)
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
  return std::regex_search(
      text, std::regex(in_block ? "\\bparams\\s*\\.\\s*" + name + "\\b" : "\\b" + name + "\\b"));
}

// Values that differ from the default, in range.
std::vector<Value> other_values(const ParamSpec& spec) {
  switch (spec.type) {
    case ParamType::flag:
      return {!std::get<bool>(spec.default_value)};
    case ParamType::integer:
      return {std::int64_t(spec.min), std::int64_t(spec.max)};
    case ParamType::number:
      return {spec.min, spec.max};
    case ParamType::choice:
      return {spec.choices.begin(), spec.choices.end()};
  }
  return {};
}

// Everything that a declaration shows of the pass' ports and of its other parameters' defaults.
std::string shape_text(const Declaration& d) {
  std::ostringstream text;
  for (const Port& p : d.ports())
    text << p.name << ' ' << uint32_t(p.access) << ' ' << p.image.extent.width << 'x' << p.image.extent.height
         << ' ' << p.image.layers << ' ' << p.image.mips << ' ' << p.image.format << ' ' << p.buffer.count
         << ' ' << p.buffer.stride << '\n';
  for (const Port& p : d.ports())
    for (const auto& [key, value] : p.traits) text << key << ' ' << to_string(value) << '\n';
  for (const ParamSpec& s : d.param_specs()) text << s.name << ' ' << to_string(s.default_value) << '\n';
  return text.str();
}

// The defaults, and each choice of each other parameter alone: what a parameter does may depend on one.
std::vector<Values> circumstances(const std::string& type, const std::string& parameter) {
  Declaration d;
  PassRegistry::instance().make(type)->declare(d);
  std::vector<Values> all{{}};
  for (const ParamSpec& other : d.param_specs())
    if (other.type == ParamType::choice && other.name != parameter)
      for (const std::string& choice : other.choices) all.push_back({{other.name, choice}});
  return all;
}

// Does declare() itself use the value: do ports or defaults depend on it?
bool in_declaration(const std::string& type, const ParamSpec& spec) {
  const auto text = [&](const Values& given) {
    Declaration d({}, given, {});
    PassRegistry::instance().make(type)->declare(d);
    return shape_text(d);
  };
  const auto others = other_values(spec);
  for (Values given : circumstances(type, spec.name)) {
    const std::string by_default = text(given);
    for (const Value& v : others) {
      given[spec.name] = v;
      if (text(given) != by_default) return true;
    }
  }
  return false;
}

TEST(Registry, EveryParameterIsUsed) {
  ASSERT_LE(probed().size(), kMostTypes);
  add_probes(std::make_index_sequence<kMostTypes>());
  Scene sized = *scenes().back().second;  // passes that look for penumbrae run, too
  sized.lights.front().area = AreaLight{AreaLight::Shape::rectangle, 0.5, 0.5, {}, {}};
  const auto scene = std::make_shared<const Scene>(std::move(sized));
  for (const fs::path& file : all_graphs()) {
    Graph graph = small_graph(file);
    probe(graph.nodes);
    frame(scene, graph, small());
  }
  for (const std::string& type : probed()) {
    Declaration d;
    PassRegistry::instance().make(type)->declare(d);
    const std::string shaders = d.param_specs().empty() ? std::string() : shader_text(type);
    for (const ParamSpec& spec : d.param_specs()) {
      if (!spec.from.empty()) continue;  // says what a source is: no graph file sets it
      EXPECT_TRUE(looked_up[type].contains(spec.name) || in_shaders(shaders, spec) ||
                  in_declaration(type, spec))
          << type << "." << spec.name << " is declared and used nowhere";
    }
  }
}

}  // namespace
}  // namespace gnomon
