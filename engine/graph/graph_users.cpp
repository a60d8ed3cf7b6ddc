// Who uses which value of a graph, and in which order passes run for it.
#include <algorithm>

#include "engine/graph/graph_resolve_parts.h"

namespace gnomon {
namespace {

std::vector<int> loop_numbers(const ResolvedGraph& graph) {
  std::vector<int> numbers;
  for (const ResolvedNode& node : graph.nodes) numbers.push_back(node.loop);
  return numbers;
}

// A node's "from" counts as a whole: which of its values are read is known only once it is declared.
std::vector<OrderEdge> data_edges(const ResolvedGraph& graph) {
  std::vector<OrderEdge> edges;
  for (uint32_t i = 0; i < graph.nodes.size(); ++i) {
    for (const auto& [port, source] : graph.nodes[i].in) edges.push_back({source.node, i});
    for (const uint32_t source : graph.nodes[i].from) edges.push_back({source, i});
  }
  return edges;
}

void collect_users(ResolvedGraph& graph) {
  graph.users.clear();
  for (uint32_t i = 0; i < graph.nodes.size(); ++i) {
    for (const auto& [name, source] : graph.nodes[i].in) {
      const Port* port = graph.nodes[i].declaration.find(name);
      if (!port) continue;
      PortUsers& users = graph.users[source];
      (port->direction == Direction::inout ? users.modifiers : users.readers).push_back(i);
    }
    for (const auto& [name, source] : graph.nodes[i].previous) graph.users[source].previous = true;
  }
}

void check_modifiers(const ResolvedGraph& graph, const Complaints& complaints) {
  const auto id = [&](uint32_t node) { return "'" + graph.nodes[node].node->id + "'"; };
  for (const auto& [key, users] : graph.users) {
    if (users.modifiers.empty()) continue;
    const std::string name = "'" + graph.nodes[key.node].node->id + "." + key.port + "'";
    const uint32_t first = users.modifiers.front();
    const std::string& place = graph.nodes[users.modifiers.back()].node->place;
    if (users.modifiers.size() > 1)
      complaints.add(id(first) + " and " + id(users.modifiers[1]) + " both modify " + name + " in place",
                     place, "let the second modify what the first gives out");
    if (users.previous)
      complaints.add(name + " is read as history, but " + id(first) + " modifies it in place", place,
                     "read the history of what " + id(first) + " gives out");
    if (std::find(users.readers.begin(), users.readers.end(), first) != users.readers.end())
      complaints.add(id(first) + " reads " + name + " and modifies it in place at once", place);
  }
}

}  // namespace

Order data_order(const ResolvedGraph& graph) { return stable_order(loop_numbers(graph), data_edges(graph)); }

void find_users(ResolvedGraph& graph, const Complaints& complaints) {
  collect_users(graph);
  check_modifiers(graph, complaints);
  std::vector<OrderEdge> edges = data_edges(graph);
  for (const auto& [key, users] : graph.users)
    for (const uint32_t modifier : users.modifiers)
      for (const uint32_t reader : users.readers)
        if (reader != modifier) edges.push_back({reader, modifier});
  Order order = stable_order(loop_numbers(graph), edges);
  if (!order.cycle.empty())
    report_cycle(graph, order.cycle,
                 "no order in which every reader of a value runs before the pass that modifies it in place",
                 complaints);
  graph.order = std::move(order.nodes);
}

}  // namespace gnomon
