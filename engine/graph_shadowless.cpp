#include "engine/graph_shadowless.h"

#include <algorithm>

namespace gnomon {
namespace {

constexpr const char* kType = "unshadowed";

void redirect(std::vector<GraphNode>& nodes, const PortRef& from, const PortRef& to) {
  for (GraphNode& node : nodes) {
    for (auto& [port, ref] : node.in)
      if (ref == from) ref = to;
    redirect(node.body, from, to);
  }
}

// A name that no pass has.
std::string free_id(const Graph& graph) {
  std::string id = kType;
  const auto taken = [&](const GraphNode& node) {
    return node.id == id || std::any_of(node.body.begin(), node.body.end(),
                                        [&](const GraphNode& inner) { return inner.id == id; });
  };
  while (std::any_of(graph.nodes.begin(), graph.nodes.end(), taken)) id += '_';
  return id;
}

}  // namespace

std::optional<Graph> without_shadows(const Graph& graph) {
  const auto output = graph.outputs.find("visibility");
  const auto gbuffer = std::find_if(graph.nodes.begin(), graph.nodes.end(),
                                    [](const GraphNode& node) { return node.type == "gbuffer"; });
  if (output == graph.outputs.end() || gbuffer == graph.nodes.end()) return std::nullopt;
  Graph result = graph;
  GraphNode node;
  node.id = free_id(graph);
  node.type = kType;
  node.place = "/outputs/visibility";
  node.in["depth"] = {gbuffer->id, "depth"};
  node.in["geometric"] = {gbuffer->id, "geometric"};
  const PortRef shown = output->second, instead{node.id, "visibility"};
  redirect(result.nodes, shown, instead);
  for (auto& [name, ref] : result.outputs)
    if (ref == shown) ref = instead;
  const auto after = result.nodes.begin() + (gbuffer - graph.nodes.begin()) + 1;
  result.nodes.insert(after, std::move(node));
  return result;
}

}  // namespace gnomon
