// Finds the passes that an output needs, and leaves out the rest.
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

class Culler {
 public:
  Culler(const ResolvedGraph& graph, const Folding& folding) : graph_(graph), folding_(folding) {
    find_loop_modifiers();
  }

  std::set<uint32_t> run(const std::vector<PortKey>& roots) {
    for (const PortKey& root : roots) need(root);
    while (!open_.empty()) {
      const uint32_t node = open_.back();
      open_.pop_back();
      visit(graph_.nodes[node]);
    }
    return std::move(live_);
  }

 private:
  using LoopMemory = std::pair<int, PortKey>;  // a loop, and memory that its body uses

  void find_loop_modifiers() {
    for (const auto& [key, users] : graph_.users)
      for (const uint32_t modifier : users.modifiers) {
        const int loop = graph_.nodes[modifier].loop;
        if (loop >= 0) modifiers_[{loop, root_of(graph_, folding_, key)}].push_back(modifier);
      }
  }

  void need(const PortKey& key) {
    const Folding::Instead instead = folding_.resolve(key);
    if (!instead.constant) mark(instead.source.node);
  }

  void mark(uint32_t node) {
    if (live_.insert(node).second) open_.push_back(node);
  }

  void visit(const ResolvedNode& node) {
    for (const auto& [port, source] : node.in) {
      need(source);
      if (node.loop >= 0) need_next_turn(node.loop, source);
    }
    for (const auto& [port, source] : node.previous) need(source);
    if (node.loop >= 0) mark(graph_.loops[node.loop].controller);
  }

  // What the body modifies in place in one iteration is what it reads in the next.
  void need_next_turn(int loop, const PortKey& key) {
    const auto found = modifiers_.find({loop, root_of(graph_, folding_, key)});
    if (found == modifiers_.end()) return;
    for (const uint32_t modifier : found->second)
      if (!folded_away(modifier)) mark(modifier);
  }

  // A modifier that said it leaves its memory untouched.
  bool folded_away(uint32_t node) const {
    for (const Port& port : graph_.nodes[node].declaration.ports())
      if (port.direction == Direction::inout && !folding_.ports.contains({node, port.name})) return false;
    return true;
  }

  const ResolvedGraph& graph_;
  const Folding& folding_;
  std::map<LoopMemory, std::vector<uint32_t>> modifiers_;
  std::set<uint32_t> live_;
  std::vector<uint32_t> open_;
};

}  // namespace

PortKey root_of(const ResolvedGraph& graph, const Folding& folding, PortKey key) {
  for (;;) {
    const Folding::Instead instead = folding.resolve(key);
    if (instead.constant) return instead.source;
    key = instead.source;
    const ResolvedNode& node = graph.nodes[key.node];
    const Port* port = node.declaration.find(key.port);
    const auto source = node.in.find(key.port);
    if (!port || port->direction != Direction::inout || source == node.in.end()) return key;
    key = source->second;
  }
}

std::set<uint32_t> live_nodes(const ResolvedGraph& graph, const Folding& folding,
                              const std::vector<PortKey>& roots) {
  return Culler(graph, folding).run(roots);
}

}  // namespace gnomon
