// The steps of resolve_graph(), each on its own.
#pragma once

#include <string>
#include <vector>

#include "engine/graph/graph_order.h"
#include "engine/graph/graph_resolve.h"

namespace gnomon {

// Collects what is wrong with one graph file.
struct Complaints {
  const std::string& file;
  Problems& problems;

  void add(std::string what, std::string place, std::string hint = {}) const {
    problems.add(std::move(what), file, std::move(place), std::move(hint));
  }
  // ... of a node, which nothing else is derived from then.
  void add(ResolvedNode& node, std::string what, std::string place, std::string hint = {}) const {
    node.sound = false;
    add(std::move(what), std::move(place), std::move(hint));
  }
};

std::string who(const ResolvedNode& node);  // "'test' (shadow_test)"
// The place of what connects an input: its member of "in", or the node's "from".
std::string place_of_input(const ResolvedNode& node, const std::string& port);
void report_cycle(const ResolvedGraph& graph, const std::vector<uint32_t>& cycle, const std::string& what,
                  const Complaints& complaints);

// --- order (graph_users.cpp) ---
Order data_order(const ResolvedGraph& graph);  // producers before readers
// Users of every value, and the order in which all of them run.
void find_users(ResolvedGraph& graph, const Complaints& complaints);

// --- declarations (graph_declare.cpp) ---
// Declares the nodes, in an order in which producers come first; connects what their "from" lists.
void declare_nodes(ResolvedGraph& graph, const std::vector<uint32_t>& order,
                   const Declaration::Setting& setting, const Complaints& complaints);
void declare_node(ResolvedGraph& graph, uint32_t index, const Declaration::Setting& setting,
                  const Complaints& complaints);

// --- checks (graph_check.cpp) ---
void check_node(ResolvedGraph& graph, uint32_t index, const Complaints& complaints);

}  // namespace gnomon
