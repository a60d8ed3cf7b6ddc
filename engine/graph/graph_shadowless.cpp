// Makes the graph that takes a technique's place where the camera sees no shadow.
#include "engine/graph/graph_shadowless.h"

#include <algorithm>

namespace gnomon {
namespace {

constexpr const char* kType = "unshadowed";  // of the pass; the G-buffer's channel and parameter
constexpr uint32_t kMostInGBuffer = 4;       // lights: colour attachments beside the other channels

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

PortRef add_pass(Graph& graph, std::vector<GraphNode>::iterator gbuffer) {
  GraphNode node;
  node.id = free_id(graph);
  node.type = kType;
  node.place = "/outputs/visibility";
  node.in["depth"] = {gbuffer->id, "depth"};
  node.in["geometric"] = {gbuffer->id, "geometric"};
  PortRef visibility{node.id, "visibility"};
  graph.nodes.insert(gbuffer + 1, std::move(node));
  return visibility;
}

}  // namespace

std::optional<Graph> without_shadows(const Graph& graph, uint32_t lights) {
  const auto output = graph.outputs.find("visibility");
  const auto found = std::find_if(graph.nodes.begin(), graph.nodes.end(),
                                  [](const GraphNode& node) { return node.type == "gbuffer"; });
  if (output == graph.outputs.end() || found == graph.nodes.end()) return std::nullopt;
  Graph result = graph;
  const auto gbuffer = result.nodes.begin() + (found - graph.nodes.begin());
  PortRef instead{gbuffer->id, kType};
  if (lights <= kMostInGBuffer)
    gbuffer->params[kType] = true;
  else
    instead = add_pass(result, gbuffer);
  const PortRef shown = output->second;
  redirect(result.nodes, shown, instead);
  for (auto& [name, ref] : result.outputs)
    if (ref == shown) ref = instead;
  return result;
}

}  // namespace gnomon
