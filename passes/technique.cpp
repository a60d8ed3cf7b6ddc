// What a technique is, asked of its graph.
#include "passes/technique.h"

#include <algorithm>
#include <array>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/graph/graph_resolve.h"

namespace gnomon {
namespace {

constexpr const char* kShadows = "shadows";        // trait of visibility: its kind
constexpr const char* kMapSide = "map_side";       // trait of a map: the parameter that says how wide it is
constexpr const char* kVisibility = "visibility";  // the output of a graph that is measured
constexpr std::array<const char*, 3> kKinds = {"hard", "filtered", "soft"};

ResolvedGraph resolved(const Graph& graph) {
  Problems problems;
  ResolvedGraph result = resolve_graph(graph, {}, problems);
  problems.raise();
  return result;
}

// Maps made of maps carry the trait on, and have no such parameter.
bool has_parameter(const ResolvedNode& node, const std::string& name) {
  const auto& specs = node.declaration.param_specs();
  return std::any_of(specs.begin(), specs.end(), [&](const ParamSpec& spec) { return spec.name == name; });
}

// Every port of a graph that says by which parameter its width is set, with that node.
template <typename Use>
void for_each_map(const ResolvedGraph& graph, const Use& use) {
  for (const ResolvedNode& node : graph.nodes)
    for (const Port& port : node.declaration.ports()) {
      const auto side = port.traits.find(kMapSide);
      if (side == port.traits.end()) continue;
      const auto& parameter = std::get<std::string>(side->second);
      if (port.direction != Direction::in && has_parameter(node, parameter)) use(node, parameter);
    }
}

}  // namespace

void makes_shadows(Declaration& d, const std::string& output, ShadowKind kind) {
  d.set_trait(output, kShadows, std::string(kKinds[size_t(kind)]));
}

ShadowKind shadow_kind(const Graph& graph) {
  const auto output = graph.outputs.find(kVisibility);
  if (output == graph.outputs.end()) return ShadowKind::hard;
  const ResolvedGraph all = resolved(graph);
  const Port* port = all.nodes[all.index.at(output->second.node)].declaration.find(output->second.port);
  const auto said = port->traits.find(kShadows);
  if (said == port->traits.end()) return ShadowKind::hard;
  const auto kind = std::find(kKinds.begin(), kKinds.end(), std::get<std::string>(said->second));
  return ShadowKind(kind - kKinds.begin());
}

void draws_maps(Declaration& d, const std::string& port, const std::string& side) {
  d.set_trait(port, kMapSide, side);
}

std::optional<uint32_t> map_side(const Graph& graph) {
  std::optional<uint32_t> widest;
  for_each_map(resolved(graph), [&](const ResolvedNode& node, const std::string& side) {
    const auto texels = uint32_t(node.declaration.params().integer(side));
    widest = std::max(widest.value_or(0), texels);
  });
  return widest;
}

std::vector<std::string> map_side_variables(const Graph& graph) {
  std::vector<std::string> names;
  for_each_map(resolved(graph), [&](const ResolvedNode& node, const std::string& side) {
    const auto variable = node.node->variables.find(side);
    if (variable == node.node->variables.end()) return;
    if (std::find(names.begin(), names.end(), variable->second) == names.end())
      names.push_back(variable->second);
  });
  return names;
}

}  // namespace gnomon
