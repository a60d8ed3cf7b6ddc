// Makes, declares, connects and orders a graph's passes.
#include "engine/graph/graph_resolve.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/json_text.h"
#include "engine/graph/graph_resolve_parts.h"

namespace gnomon {
namespace {

bool is_identifier(const std::string& text) {
  const auto allowed = [](unsigned char c) { return c == '_' || c == '-' || (c < 128 && std::isalnum(c)); };
  return !text.empty() && std::all_of(text.begin(), text.end(), allowed);
}

class Resolver {
 public:
  Resolver(const Graph& graph, const Declaration::Setting& setting, Problems& problems)
      : graph_(graph), setting_(setting), file_(graph.file.string()), problems_(problems) {}

  ResolvedGraph run() {
    for (const GraphNode& node : graph_.nodes) add(node);
    for (ResolvedLoop& loop : result_.loops) find_controller(loop);
    for (ResolvedNode& node : result_.nodes) connect(node);
    if (declare_in_order()) {
      find_users(result_, complaints_);
    }
    check_outputs();
    return std::move(result_);
  }

 private:
  void problem(std::string what, std::string place, std::string hint = {}) {
    problems_.add(std::move(what), file_, std::move(place), std::move(hint));
  }
  std::string id(uint32_t node) const { return "'" + result_.nodes[node].node->id + "'"; }

  // --- flatten ---
  void add(const GraphNode& node) {
    check_id(node);
    if (node.type != "loop") return add_pass(node, -1);
    ResolvedLoop loop{&node, uint32_t(result_.nodes.size()), 0, 0};
    const int number = int(result_.loops.size());
    for (const GraphNode& inner : node.body) {
      check_id(inner);
      if (inner.type == "loop") {
        problem("a loop inside a loop", inner.place, "put the passes of both into one body");
      } else {
        add_pass(inner, number);
      }
    }
    loop.last = uint32_t(result_.nodes.size());
    if (loop.first == loop.last && problems_.empty())
      problem("the loop has no passes", pointer_to(node.place, "passes"));
    result_.loops.push_back(loop);
  }

  // Whoever read the file has complained about what is missing.
  bool reported_missing(const std::string& text) const { return text.empty() && !problems_.empty(); }

  void check_id(const GraphNode& node) {
    if (reported_missing(node.id)) return;
    if (!is_identifier(node.id))
      problem("id " + in_quotes(node.id) + " is not a name", pointer_to(node.place, "id"),
              "letters, digits, '_' and '-'");
    if (!ids_.emplace(node.id, node.place).second)
      problem("duplicate id " + in_quotes(node.id), pointer_to(node.place, "id"),
              "first at " + ids_[node.id]);
  }

  void add_pass(const GraphNode& node, int loop) {
    ResolvedNode resolved;
    resolved.node = &node;
    resolved.loop = loop;
    resolved.pass = PassRegistry::instance().make(node.type);
    if (!resolved.pass) {
      resolved.sound = false;
    }
    if (!resolved.pass && !reported_missing(node.type)) {
      std::vector<std::string> types = PassRegistry::instance().types();
      types.push_back("loop");
      problem("unknown pass type " + in_quotes(node.type), pointer_to(node.place, "type"),
              did_you_mean(node.type, types));
    }
    if (!node.id.empty()) result_.index.emplace(node.id, uint32_t(result_.nodes.size()));
    result_.nodes.push_back(std::move(resolved));
  }

  void find_controller(ResolvedLoop& loop) {
    std::vector<std::string> body;
    for (uint32_t i = loop.first; i < loop.last; ++i) {
      body.push_back(result_.nodes[i].node->id);
      if (body.back() == loop.node->controller) loop.controller = i;
    }
    const std::string& name = loop.node->controller;
    if (!reported_missing(name) && std::find(body.begin(), body.end(), name) == body.end())
      problem("controller " + in_quotes(name) + " is not a pass of the loop's body",
              pointer_to(loop.node->place, "controller"), did_you_mean(name, body));
  }

  // --- connect ---
  const uint32_t* find_node(const std::string& id, const std::string& place) {
    const auto found = result_.index.find(id);
    if (found != result_.index.end()) return &found->second;
    if (ids_.contains(id)) {
      problem(in_quotes(id) + " is a loop, which has no ports", place, "name a pass of its body");
    } else {
      std::vector<std::string> ids;
      for (const auto& [name, index] : result_.index) ids.push_back(name);
      problem("unknown pass " + in_quotes(id), place, did_you_mean(id, ids));
    }
    return nullptr;
  }

  void connect(ResolvedNode& node) {
    const std::string from = pointer_to(node.node->place, "from");
    for (const std::string& id : node.node->from)
      if (const uint32_t* source = find_node(id, from)) {
        node.from.push_back(*source);
      } else {
        node.sound = false;
      }
    for (const auto& [port, ref] : node.node->in) {
      const uint32_t* source = find_node(ref.node, place_of_input(node, port));
      if (!source) {
        node.sound = false;
        continue;
      }
      (ref.previous ? node.previous : node.in)[port] = {*source, ref.port};
    }
  }

  bool declare_in_order() {
    Order order = data_order(result_);
    const bool cyclic = !order.cycle.empty();
    if (cyclic) {
      report_cycle(result_, order.cycle, "a cycle", complaints_);
      order.nodes.resize(result_.nodes.size());  // names and parameters can be checked all the same
      std::iota(order.nodes.begin(), order.nodes.end(), 0u);
      for (ResolvedNode& node : result_.nodes) node.sound = false;
    }
    declare_nodes(result_, order.nodes, setting_, complaints_);
    for (const uint32_t i : order.nodes)
      if (result_.nodes[i].pass) check_node(result_, i, complaints_);
    return !cyclic;
  }

  void check_outputs() {
    if (graph_.outputs.empty()) problem("the graph has no outputs", "/outputs");
    for (const auto& [name, ref] : graph_.outputs) {
      const std::string place = pointer_to("/outputs", name);
      const uint32_t* node = find_node(ref.node, place);
      if (!node || !result_.nodes[*node].pass) continue;
      if (ref.previous) problem("an output cannot be history", place);
      readable_port(result_.nodes[*node], ref.port, file_, place, problems_);
      const auto users = result_.users.find({*node, ref.port});
      if (users != result_.users.end() && !users->second.modifiers.empty()) {
        const std::string modifier = id(users->second.modifiers.front());
        problem("'" + to_string(ref) + "' is modified in place by " + modifier, place,
                "name what " + modifier + " gives out");
      }
    }
  }

  const Graph& graph_;
  const Declaration::Setting setting_;
  const std::string file_;
  Problems& problems_;
  const Complaints complaints_{file_, problems_};
  ResolvedGraph result_;
  std::map<std::string, std::string> ids_;  // id -> place
};

}  // namespace

std::string who(const ResolvedNode& node) { return "'" + node.node->id + "' (" + node.node->type + ")"; }

std::string place_of_input(const ResolvedNode& node, const std::string& port) {
  if (!node.node->in.contains(port)) return pointer_to(node.node->place, "from");
  return pointer_to(pointer_to(node.node->place, "in"), port);
}

void report_cycle(const ResolvedGraph& graph, const std::vector<uint32_t>& cycle, const std::string& what,
                  const Complaints& complaints) {
  std::string text;
  for (const uint32_t node : cycle) text += "'" + graph.nodes[node].node->id + "' -> ";
  complaints.add(what + ": " + text + "'" + graph.nodes[cycle.front()].node->id + "'",
                 graph.nodes[cycle.front()].node->place);
}

ResolvedGraph resolve_graph(const Graph& graph, const Declaration::Setting& setting, Problems& problems) {
  return Resolver(graph, setting, problems).run();
}

}  // namespace gnomon
