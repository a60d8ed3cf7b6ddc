// Where the camera sees no shadow: what passes declare for that case takes the technique's place.
#include "engine/graph/graph_resolve_parts.h"
#include "engine/graph/shadow_free.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

class Substitution {
 public:
  Substitution(ResolvedGraph graph, PortKey shown, const Declaration::Setting& setting,
               const std::string& file)
      : graph_(std::move(graph)), shown_(std::move(shown)), setting_(setting), file_(file) {}

  // The output that takes the place of what is shown; for it a pass may be added.
  std::optional<PortKey> run() {
    std::optional<PortKey> instead = find_output();
    if (!instead) instead = add_pass();
    if (!instead) return std::nullopt;
    for (ResolvedNode& node : graph_.nodes)
      for (auto& [input, source] : node.in)
        if (source == shown_) source = *instead;
    Problems problems;
    find_users(graph_, {file_, problems});  // a cycle where the substitute itself needs what it replaces
    return problems.empty() ? instead : std::nullopt;
  }

  ResolvedGraph& graph() { return graph_; }

 private:
  const Port& port(const PortKey& key) const { return *graph_.nodes[key.node].declaration.find(key.port); }

  bool fits(const PortKey& key) const {
    const Port& candidate = port(key);
    return is_shadow_free(candidate) && candidate.image == port(shown_).image;
  }

  std::optional<PortKey> find_output() const {
    for (uint32_t i = 0; i < graph_.nodes.size(); ++i)
      if (auto key = output_of(i)) return key;
    return std::nullopt;
  }

  std::optional<PortKey> output_of(uint32_t node) const {
    for (const Port& candidate : graph_.nodes[node].declaration.ports())
      if (PortKey key{node, candidate.name}; key != shown_ && fits(key)) return key;
    return std::nullopt;
  }

  std::optional<PortKey> add_pass() {
    for (uint32_t i = 0; i < graph_.nodes.size(); ++i)
      for (const Port& candidate : graph_.nodes[i].declaration.ports()) {
        const auto type = candidate.traits.find(kShadowFreePass);
        if (type == candidate.traits.end() || candidate.direction != Direction::out) continue;
        return add_pass(std::get<std::string>(type->second), i);
      }
    return std::nullopt;
  }

  std::optional<PortKey> add_pass(const std::string& type, uint32_t from) {
    auto node = std::make_shared<GraphNode>();
    node->id = node->type = type;
    while (graph_.index.contains(node->id)) node->id += '_';
    node->from = {graph_.nodes[from].node->id};
    node->place = graph_.nodes[from].node->place;
    const auto number = uint32_t(graph_.nodes.size());
    ResolvedNode added;
    added.node = node.get();
    added.from = {from};
    added.pass = PassRegistry::instance().make(type);
    graph_.index[node->id] = number;
    graph_.added.push_back(std::move(node));
    graph_.nodes.push_back(std::move(added));
    Problems problems;
    const Complaints complaints{file_, problems};
    declare_node(graph_, number, setting_, complaints);
    if (graph_.nodes[number].pass) check_node(graph_, number, complaints);
    problems.raise();  // the pass that names the substitute is wrong
    return output_of(number);
  }

  ResolvedGraph graph_;
  const PortKey shown_;
  const Declaration::Setting& setting_;
  const std::string& file_;
};

}  // namespace

bool is_shadow_free(const Port& port) {
  const auto found = port.traits.find(kShadowFree);
  return port.direction == Direction::out && !port.is_buffer && found != port.traits.end() &&
         found->second == Value(true);
}

bool leave_technique_out(Wanted& wanted, const Declaration::Setting& setting) {
  const auto output = wanted.outputs.find("visibility");
  if (output == wanted.outputs.end()) return false;
  const PortKey shown = output->second;
  Substitution substitution(wanted.graph, shown, setting, wanted.file);
  const std::optional<PortKey> instead = substitution.run();
  if (!instead) return false;
  wanted.graph = std::move(substitution.graph());
  for (auto& [name, key] : wanted.outputs)
    if (key == shown) key = *instead;
  return true;
}

}  // namespace gnomon
