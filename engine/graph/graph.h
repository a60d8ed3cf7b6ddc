// A graph file: passes, how their ports are connected, variables. Device-free.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/pass.h"

namespace gnomon {

struct PortRef {
  std::string node, port;
  bool previous = false;  // "node.port@previous": the value of the frame before (history)
  bool operator==(const PortRef&) const = default;
};
std::string to_string(const PortRef& ref);

// One entry of "passes". A node of type "loop" repeats `body` until its `controller` (a node of the body)
// says done, or `max` times.
struct GraphNode {
  std::string id, type;
  std::map<std::string, PortRef> in;
  // Ids of nodes: inputs that `in` does not name read the outputs of the same names of these.
  std::vector<std::string> from;
  Values params;                                 // variables already substituted
  std::map<std::string, std::string> variables;  // of params: the variable whose value it has
  std::vector<std::string> vars;                 // those params that are named by their variable alone
  std::string place;                             // JSON pointer, for errors
  std::vector<GraphNode> body;                   // of a loop
  std::string controller;                        // of a loop
  uint32_t max = 0;                              // of a loop
};

struct Graph {
  std::filesystem::path file;
  std::string name, cite;
  Values vars;                             // as resolved: defaults overridden by what was set
  std::vector<GraphNode> nodes;            // file order
  std::map<std::string, PortRef> outputs;  // "color", "visibility", ...
};

// Does some pass read what a frame before wrote?
bool reads_history(const Graph& graph);

// Reads and checks a graph file: syntax, schema, variables, pass types, ports, parameters, cycles. All
// problems at once, each with its JSON pointer. `set` overrides variables; an unknown one is an error.
Graph load_graph(const std::filesystem::path& file, const Values& set = {});
Graph parse_graph(const std::string& text, const std::string& file_for_errors, const Values& set = {});
// NAME -> assets/graphs/NAME.json in the search path (GNOMON_ASSETS, the source tree, the install), FILE as
// it is.
std::filesystem::path find_graph(const std::string& name_or_file);
std::vector<std::filesystem::path> all_graphs();

// The JSON Schema of graph files, from the registry's declarations.
nlohmann::json graph_schema();
// The graph file of `graph`, variables resolved; load_graph reads it back.
nlohmann::json to_json(const Graph& graph);

}  // namespace gnomon
