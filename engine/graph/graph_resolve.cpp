// Makes, declares, connects and orders a graph's passes.
#include "engine/graph/graph_resolve.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <numeric>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/json_text.h"
#include "engine/graph/graph_order.h"

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
      collect_users();
      check_modifiers();
      order_with_modifiers();
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
  const uint32_t* find_node(const PortRef& ref, const std::string& place) {
    const auto found = result_.index.find(ref.node);
    if (found != result_.index.end()) return &found->second;
    if (ids_.contains(ref.node)) {
      problem(in_quotes(ref.node) + " is a loop, which has no ports", place, "name a pass of its body");
    } else {
      std::vector<std::string> ids;
      for (const auto& [name, index] : result_.index) ids.push_back(name);
      problem("unknown pass " + in_quotes(ref.node), place, did_you_mean(ref.node, ids));
    }
    return nullptr;
  }

  void connect(ResolvedNode& node) {
    for (const auto& [port, ref] : node.node->in) {
      const uint32_t* source = find_node(ref, in_place(node, port));
      if (!source) {
        node.sound = false;
        continue;
      }
      (ref.previous ? node.previous : node.in)[port] = {*source, ref.port};
    }
  }

  static std::string in_place(const ResolvedNode& node, const std::string& port) {
    return pointer_to(pointer_to(node.node->place, "in"), port);
  }

  // --- declare ---
  std::vector<int> loop_numbers() const {
    std::vector<int> numbers;
    for (const ResolvedNode& node : result_.nodes) numbers.push_back(node.loop);
    return numbers;
  }

  std::vector<OrderEdge> data_edges() const {
    std::vector<OrderEdge> edges;
    for (uint32_t i = 0; i < result_.nodes.size(); ++i)
      for (const auto& [port, source] : result_.nodes[i].in) edges.push_back({source.node, i});
    return edges;
  }

  void report_cycle(const std::vector<uint32_t>& cycle, const std::string& what) {
    std::string text;
    for (const uint32_t node : cycle) text += id(node) + " -> ";
    problem(what + ": " + text + id(cycle.front()), result_.nodes[cycle.front()].node->place);
  }

  bool declare_in_order() {
    Order order = stable_order(loop_numbers(), data_edges());
    const bool cyclic = !order.cycle.empty();
    if (cyclic) {
      report_cycle(order.cycle, "a cycle");
      order.nodes.resize(result_.nodes.size());  // names and parameters can be checked all the same
      std::iota(order.nodes.begin(), order.nodes.end(), 0u);
      for (ResolvedNode& node : result_.nodes) node.sound = false;
    }
    for (const uint32_t i : order.nodes) declare(result_.nodes[i]);
    if (problems_.empty()) declare_history(order.nodes);
    for (const uint32_t i : order.nodes)
      if (result_.nodes[i].pass) check_node(result_.nodes[i]);
    return !cyclic;
  }

  // The shape of what is connected, for declare(); nothing when the source is in doubt.
  void add_shape(const PortKey& source, const std::string& input, Declaration::Inputs& inputs) {
    const Port* found = result_.nodes[source.node].declaration.find(source.port);
    if (!found) return;
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

  void declare(ResolvedNode& node) {
    if (!node.pass) return;
    Declaration::Inputs inputs;
    for (const auto& [port, source] : node.in) {
      const ResolvedNode& from = result_.nodes[source.node];
      node.sound = node.sound && from.sound;
      add_shape(source, port, inputs);
    }
    for (const auto& [port, source] : node.previous) add_shape(source, port, inputs);
    run_declare(node, std::move(inputs));
    connect_behind(node);
    if (!node.declaration.value_errors().empty() || !node.declaration.undeclared().empty())
      node.sound = false;
  }

  // A pass that reads its own or a later pass' history learns the shape only once that one is declared.
  void declare_history(const std::vector<uint32_t>& order) {
    const bool any = std::any_of(order.begin(), order.end(),
                                 [&](uint32_t i) { return !result_.nodes[i].previous.empty(); });
    if (any)
      for (const uint32_t i : order) declare(result_.nodes[i]);
  }

  void run_declare(ResolvedNode& node, Declaration::Inputs inputs) {
    node.declaration = Declaration(setting_, node.node->params, std::move(inputs));
    try {
      node.pass->declare(node.declaration);
    } catch (const Error& error) {
      for (const Problem& p : error.problems()) problem(p.what, node.node->place, p.hint);
      node.sound = false;
    } catch (const std::exception& error) {
      problem("declaring '" + node.node->type + "' failed: " + error.what(), node.node->place);
      node.sound = false;
    }
  }

  // --- check ---
  void check_node(ResolvedNode& node) {
    check_params(node);
    for (const auto& [port, ref] : node.node->in) check_input(node, port);
    for (const auto& [port, why] : node.declaration.source_errors()) refuse_source(node, port, why);
    for (const Port& port : node.declaration.ports()) {
      const bool input = port.direction == Direction::in || port.direction == Direction::inout;
      const bool by_itself = !port.beside.empty();
      if (by_itself && !check_behind(result_, node, port, file_, problems_)) node.sound = false;
      if (input && !by_itself && !port.optional && !node.node->in.contains(port.name))
        unsound(node, "required input '" + port.name + "' of '" + node.node->type + "' is not connected",
                pointer_to(node.node->place, "in"));
    }
    if (!node.sound) return;
    const size_t before = problems_.all().size();
    check_declaration(node, file_, problems_);
    node.sound = problems_.all().size() == before;
  }

  void unsound(ResolvedNode& node, std::string what, std::string place, std::string hint = {}) {
    node.sound = false;
    problem(std::move(what), std::move(place), std::move(hint));
  }

  void check_params(ResolvedNode& node) {
    const std::string place = pointer_to(node.node->place, "params");
    std::vector<std::string> names;
    std::map<std::string, std::string> from;
    for (const ParamSpec& spec : node.declaration.param_specs())
      spec.from.empty() ? names.push_back(spec.name) : void(from[spec.name] = spec.from);
    for (const std::string& name : node.declaration.undeclared())
      from.contains(name)
          ? unsound(node,
                    "'" + name + "' of '" + node.node->type + "' is not set here: it comes with input '" +
                        from[name] + "'",
                    pointer_to(place, name), "set it where what is read is made")
          : unsound(node, "unknown parameter " + in_quotes(name) + " of '" + node.node->type + "'",
                    pointer_to(place, name), did_you_mean(name, names));
    for (const std::string& sentence : node.declaration.value_errors()) {
      const std::string name = sentence.substr(1, sentence.find('\'', 1) - 1);  // "'size' is 0: must be ..."
      unsound(node, sentence, pointer_to(place, name));
    }
  }

  // The pass cannot use what is connected, though its shape would do.
  void refuse_source(ResolvedNode& node, const std::string& input, const std::string& why) {
    const auto& sources = node.previous.contains(input) ? node.previous : node.in;
    const auto source = sources.find(input);
    if (source == sources.end()) return;
    const ResolvedNode& from = result_.nodes[source->second.node];
    if (!from.sound) return;
    unsound(node, who(node) + " cannot read '" + source->second.port + "' of " + who(from) + ": it " + why,
            in_place(node, input), "'" + from.node->id + "' is at " + from.node->place);
  }
  static std::string who(const ResolvedNode& node) {
    return "'" + node.node->id + "' (" + node.node->type + ")";
  }

  void check_input(ResolvedNode& node, const std::string& name) {
    const Port* port = node.declaration.find(name);
    const std::string place = in_place(node, name);
    if (!port || port->direction == Direction::transient) {
      std::vector<std::string> names;
      for (const Port& p : node.declaration.ports())
        if (p.beside.empty() && (p.direction == Direction::in || p.direction == Direction::inout))
          names.push_back(p.name);
      return unsound(node, "unknown input " + in_quotes(name) + " of '" + node.node->type + "'", place,
                     did_you_mean(name, names));
    }
    if (!port->beside.empty())
      return unsound(node,
                     "'" + name + "' of '" + node.node->type + "' is not connected here: it comes with '" +
                         port->beside + "'",
                     place);
    if (port->direction == Direction::out)
      return unsound(node, "'" + name + "' is an output of '" + node.node->type + "', not an input", place);
    check_source(node, *port, place);
  }

  void check_source(ResolvedNode& node, const Port& port, const std::string& place) {
    const bool history = node.previous.contains(port.name);
    const auto& sources = history ? node.previous : node.in;
    const auto source = sources.find(port.name);
    if (source == sources.end()) return;  // reported when it was connected
    const ResolvedNode& from = result_.nodes[source->second.node];
    if (!from.pass) return;
    const Port* given = readable_port(from, source->second.port, file_, place, problems_);
    if (!given) {
      node.sound = false;
      return;
    }
    const std::string ref = in_quotes(from.node->id + "." + given->name);
    if (history && port.direction == Direction::inout)
      return unsound(node, "'" + port.name + "' is modified in place and cannot be history", place);
    if (given->is_buffer != port.is_buffer)
      return unsound(node,
                     ref + (given->is_buffer ? " is a buffer, and '" : " is an image, and '") + port.name +
                         (port.is_buffer ? "' takes a buffer" : "' takes an image"),
                     place);
    if (!given->is_buffer && !port.array && given->image.layers > 1 && from.sound)
      unsound(node,
              ref + " has " + std::to_string(given->image.layers) + " layers, and '" + port.name +
                  "' takes a single one",
              place);
    if (has(port.access, Access::host_read) && !has(given->access, Access::host_read))
      unsound(node, "'" + port.name + "' is read by the host, and " + ref + " is not host-readable", place);
  }

  // --- who uses what ---
  void collect_users() {
    for (uint32_t i = 0; i < result_.nodes.size(); ++i) {
      for (const auto& [name, source] : result_.nodes[i].in) {
        const Port* port = result_.nodes[i].declaration.find(name);
        if (!port) continue;
        PortUsers& users = result_.users[source];
        (port->direction == Direction::inout ? users.modifiers : users.readers).push_back(i);
      }
      for (const auto& [name, source] : result_.nodes[i].previous) result_.users[source].previous = true;
    }
  }

  std::string name_of(const PortKey& key) const { return result_.nodes[key.node].node->id + "." + key.port; }

  void check_modifiers() {
    for (const auto& [key, users] : result_.users) {
      if (users.modifiers.empty()) continue;
      const uint32_t first = users.modifiers.front();
      const std::string& place = result_.nodes[users.modifiers.back()].node->place;
      if (users.modifiers.size() > 1)
        problem(id(first) + " and " + id(users.modifiers[1]) + " both modify '" + name_of(key) + "' in place",
                place, "let the second modify what the first gives out");
      if (users.previous)
        problem("'" + name_of(key) + "' is read as history, but " + id(first) + " modifies it in place",
                place, "read the history of what " + id(first) + " gives out");
      if (std::find(users.readers.begin(), users.readers.end(), first) != users.readers.end())
        problem(id(first) + " reads '" + name_of(key) + "' and modifies it in place at once", place);
    }
  }

  void order_with_modifiers() {
    std::vector<OrderEdge> edges = data_edges();
    for (const auto& [key, users] : result_.users)
      for (const uint32_t modifier : users.modifiers)
        for (const uint32_t reader : users.readers)
          if (reader != modifier) edges.push_back({reader, modifier});
    Order order = stable_order(loop_numbers(), edges);
    if (!order.cycle.empty())
      report_cycle(
          order.cycle,
          "no order in which every reader of a value runs before the pass that modifies it in place");
    result_.order = std::move(order.nodes);
  }

  void check_outputs() {
    if (graph_.outputs.empty()) problem("the graph has no outputs", "/outputs");
    for (const auto& [name, ref] : graph_.outputs) {
      const std::string place = pointer_to("/outputs", name);
      const uint32_t* node = find_node(ref, place);
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
  ResolvedGraph result_;
  std::map<std::string, std::string> ids_;  // id -> place
};

}  // namespace

const Port* readable_port(const ResolvedNode& node, const std::string& port, const std::string& file,
                          const std::string& place, Problems& problems) {
  const Port* found = node.declaration.find(port);
  if (found && (found->direction == Direction::out || found->direction == Direction::inout)) return found;
  std::vector<std::string> names;
  for (const Port& p : node.declaration.ports())
    if (p.direction == Direction::out || p.direction == Direction::inout) names.push_back(p.name);
  const std::string who = "'" + node.node->id + "' (" + node.node->type + ")";
  const std::string hint = did_you_mean(port, names);
  if (!found) {
    problems.add("unknown output " + in_quotes(port) + " of " + who, file, place, hint);
  } else if (found->direction == Direction::in) {
    problems.add("'" + port + "' is an input of " + who + ", not an output", file, place, hint);
  } else {
    problems.add("'" + port + "' is internal to " + who, file, place, hint);
  }
  return nullptr;
}

ResolvedGraph resolve_graph(const Graph& graph, const Declaration::Setting& setting, Problems& problems) {
  return Resolver(graph, setting, problems).run();
}

}  // namespace gnomon
