// A graph whose passes are made, declared, connected and ordered: what checking and compiling start from.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/graph/pass.h"

namespace gnomon {

// A port as everything behind the resolver names it.
struct PortKey {
  uint32_t node = 0;  // index into ResolvedGraph::nodes
  std::string port;
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 misreads <=>
  auto operator<=>(const PortKey&) const = default;
};

struct ResolvedNode {
  const GraphNode* node = nullptr;
  int loop = -1;  // index into ResolvedGraph::loops; -1: outside
  std::shared_ptr<Pass> pass;
  Declaration declaration;
  std::vector<uint32_t> from;               // nodes whose outputs feed the inputs of the same names
  std::map<std::string, PortKey> in;        // connected inputs
  std::map<std::string, PortKey> previous;  // inputs that read the frame before
  bool sound = true;                        // no problem here nor in what it reads
};

struct ResolvedLoop {
  const GraphNode* node = nullptr;
  uint32_t first = 0, last = 0;  // [first, last) of ResolvedGraph::nodes
  uint32_t controller = 0;
};

// A value that a port gives out, and who uses it.
struct PortUsers {
  std::vector<uint32_t> readers;    // nodes that read it through an input
  std::vector<uint32_t> modifiers;  // nodes that change it in place; at most one in a sound graph
  bool previous = false;            // read as history
};

struct ResolvedGraph {
  std::vector<ResolvedNode> nodes;  // file order, bodies in place
  std::vector<ResolvedLoop> loops;
  std::map<std::string, uint32_t> index;  // by id
  std::map<PortKey, PortUsers> users;
  std::vector<std::shared_ptr<const GraphNode>> added;  // nodes that the file does not have
  std::vector<uint32_t> order;  // execution order: readers of a value before the one who modifies it
};

// `graph` must outlive the result. Order and users are meaningful only when no problem was added.
ResolvedGraph resolve_graph(const Graph& graph, const Declaration::Setting& setting, Problems& problems);

// A port that can be read: an output, or an inout (its value after the pass). nullptr and a problem
// otherwise.
const Port* readable_port(const ResolvedNode& node, const std::string& port, const std::string& file,
                          const std::string& place, Problems& problems);

// Connects inputs that stand behind other ones (Declaration::input_behind) to what those sources offer.
void connect_behind(ResolvedNode& node);
// Is the input `port`, which connects itself, connected where it has to be? A problem otherwise.
bool check_behind(const ResolvedGraph& graph, const ResolvedNode& node, const Port& port,
                  const std::string& file, Problems& problems);

// What is wrong with a declaration in itself: accesses against directions, formats and shapes.
void check_declaration(const ResolvedNode& node, const std::string& file, Problems& problems);

}  // namespace gnomon
