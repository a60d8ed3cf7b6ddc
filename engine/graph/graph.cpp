// A graph as JSON text.
#include "engine/graph/graph.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

using nlohmann::json;

json to_json(const Value& value) {
  return std::visit([](const auto& v) { return json(v); }, value);
}

json to_json(const GraphNode& node) {
  json result{{"id", node.id}, {"type", node.type}};
  for (const auto& [port, ref] : node.in) result["in"][port] = to_string(ref);
  for (const std::string& id : node.from) result["from"].push_back(id);
  for (const auto& [name, value] : node.params) result["params"][name] = to_json(value);
  if (node.type == "loop") {
    result["controller"] = node.controller;
    result["max"] = node.max;
    result["passes"] = json::array();
    for (const GraphNode& inner : node.body) result["passes"].push_back(to_json(inner));
  }
  return result;
}

bool read_history(const std::vector<GraphNode>& nodes) {
  return std::any_of(nodes.begin(), nodes.end(), [](const GraphNode& node) {
    return read_history(node.body) ||
           std::any_of(node.in.begin(), node.in.end(), [](const auto& in) { return in.second.previous; });
  });
}

}  // namespace

bool reads_history(const Graph& graph) { return read_history(graph.nodes); }

std::string to_string(const PortRef& ref) {
  return ref.node + "." + ref.port + (ref.previous ? "@previous" : "");
}

// Variables are already substituted; a list of them would name variables that nothing uses.
json to_json(const Graph& graph) {
  json result{{"schema", 1}, {"name", graph.name}, {"passes", json::array()}, {"outputs", json::object()}};
  if (!graph.cite.empty()) result["cite"] = graph.cite;
  for (const GraphNode& node : graph.nodes) result["passes"].push_back(to_json(node));
  for (const auto& [name, ref] : graph.outputs) result["outputs"][name] = to_string(ref);
  return result;
}

}  // namespace gnomon
