// Runs the passes' declare() with the shapes and traits of what is connected; connects what "from" lists.
#include <algorithm>
#include <exception>

#include "engine/base/json_text.h"
#include "engine/graph/graph_resolve_parts.h"

namespace gnomon {
namespace {

bool gives_out(const Port& port) {
  return port.direction == Direction::out || port.direction == Direction::inout;
}

class Declarer {
 public:
  Declarer(ResolvedGraph& graph, const Declaration::Setting& setting, const Complaints& complaints)
      : graph_(graph), setting_(setting), complaints_(complaints) {}

  void declare(ResolvedNode& node) {
    if (!node.pass) return;
    connect_from(node);
    for (const auto& [port, source] : node.in) node.sound = node.sound && graph_.nodes[source.node].sound;
    for (const uint32_t source : node.from) node.sound = node.sound && graph_.nodes[source].sound;
    node.declaration = Declaration(setting_, node.node->params, inputs_of(node));
    try {
      node.pass->declare(node.declaration);
    } catch (const Error& error) {
      for (const Problem& p : error.problems()) complaints_.add(node, p.what, node.node->place, p.hint);
    } catch (const std::exception& error) {
      complaints_.add(node, "declaring '" + node.node->type + "' failed: " + error.what(), node.node->place);
    }
    connect_behind(node);
    if (!node.declaration.value_errors().empty() || !node.declaration.undeclared().empty())
      node.sound = false;
  }

 private:
  // Shapes and traits of what is connected; nothing where the source is in doubt.
  Declaration::Inputs inputs_of(const ResolvedNode& node) const {
    Declaration::Inputs inputs;
    for (const auto* sources : {&node.in, &node.previous})
      for (const auto& [input, source] : *sources) {
        const Port* found = graph_.nodes[source.node].declaration.find(source.port);
        if (!found) continue;
        Declaration::Connected& connected = inputs[input];
        connected.traits = found->traits;
        connected.behind = found->behind;
        if (found->is_buffer) {
          connected.buffer = found->buffer;
          connected.node = source.node, connected.port = source.port;
        } else {
          connected.image = found->image;
        }
      }
    return inputs;
  }

  // Which inputs there are may depend on what is connected to others: asked again until nothing is added.
  void connect_from(ResolvedNode& node) {
    if (node.from.empty()) return;
    const size_t before = complaints_.problems.all().size();
    bool added = true;
    while (added) added = connect_more(node);
    if (complaints_.problems.all().size() == before && node.sound) check_use(node);
  }

  bool connect_more(ResolvedNode& node) {
    Declaration asked(setting_, node.node->params, inputs_of(node));
    try {
      node.pass->declare(asked);
    } catch (const std::exception&) {
      return false;  // told when it is declared
    }
    bool added = false;
    for (const Port& port : asked.ports())
      if (port.beside.empty() && (port.direction == Direction::in || port.direction == Direction::inout))
        added = connect(node, port.name) || added;
    return added;
  }

  bool connect(ResolvedNode& node, const std::string& input) {
    if (node.in.contains(input) || node.node->in.contains(input)) return false;
    std::vector<PortKey> found;
    for (const uint32_t source : node.from) {
      const Port* port = graph_.nodes[source].declaration.find(input);
      if (port && gives_out(*port)) found.push_back({source, input});
    }
    if (found.empty()) return false;
    node.in[input] = found.front();
    if (found.size() > 1) ambiguous(node, input, found);
    return true;
  }

  void ambiguous(ResolvedNode& node, const std::string& input, const std::vector<PortKey>& found) {
    std::string names;
    for (const PortKey& key : found)
      names += (names.empty() ? "" : ", ") + in_quotes(graph_.nodes[key.node].node->id + "." + key.port);
    complaints_.add(node, "input '" + input + "' of " + who(node) + " may be any of " + names,
                    pointer_to(node.node->place, "from"), "name one of them under \"in\"");
  }

  void check_use(ResolvedNode& node) {
    for (const uint32_t source : node.from) {
      const bool used = std::any_of(node.in.begin(), node.in.end(), [&](const auto& in) {
        return in.second.node == source && !node.node->in.contains(in.first);
      });
      if (!used && graph_.nodes[source].sound)
        complaints_.add(node,
                        who(graph_.nodes[source]) + " gives " + who(node) +
                            " nothing: no output of its has the name of an input that is still open",
                        pointer_to(node.node->place, "from"), "connect it under \"in\", or leave it out");
    }
  }

  ResolvedGraph& graph_;
  const Declaration::Setting& setting_;
  const Complaints& complaints_;
};

}  // namespace

void declare_node(ResolvedGraph& graph, uint32_t index, const Declaration::Setting& setting,
                  const Complaints& complaints) {
  Declarer(graph, setting, complaints).declare(graph.nodes[index]);
}

void declare_nodes(ResolvedGraph& graph, const std::vector<uint32_t>& order,
                   const Declaration::Setting& setting, const Complaints& complaints) {
  Declarer declarer(graph, setting, complaints);
  for (const uint32_t i : order) declarer.declare(graph.nodes[i]);
  if (!complaints.problems.empty()) return;
  // A pass that reads its own or a later pass' history learns the shape only once that one is declared.
  const bool any =
      std::any_of(order.begin(), order.end(), [&](uint32_t i) { return !graph.nodes[i].previous.empty(); });
  if (any)
    for (const uint32_t i : order) declarer.declare(graph.nodes[i]);
}

}  // namespace gnomon
