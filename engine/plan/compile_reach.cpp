// Finds how far from a receiver's own texel any reader of a map looks.
#include <algorithm>

#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

class Reach {
 public:
  Reach(const ResolvedGraph& graph, const Folding& folding, const std::set<uint32_t>& live)
      : graph_(graph), folding_(folding), live_(live) {}

  // Of a value, over all who read it; what is exported, kept for the next frame or modified is read anywhere.
  std::optional<uint32_t> of(const PortKey& key, bool exported) const {
    uint32_t most = 0;
    if (exported) return std::nullopt;
    for (const uint32_t reader : live_) {
      const ResolvedNode& node = graph_.nodes[reader];
      for (const auto& [port, source] : node.previous)
        if (root_of(graph_, folding_, source) == key) return std::nullopt;
      for (const auto& [port, source] : node.in) {
        if (folding_.resolve(source).constant || root_of(graph_, folding_, source) != key) continue;
        const std::optional<uint32_t> one = through(reader, *node.declaration.find(port));
        if (!one) return std::nullopt;
        most = std::max(most, *one);
      }
    }
    return most;
  }

 private:
  std::optional<uint32_t> through(uint32_t reader, const Port& port) const {
    if (!port.reach || port.direction != Direction::in) return std::nullopt;
    if (port.reach_through.empty()) return port.reach;
    const std::optional<uint32_t> further = of({reader, port.reach_through}, false);
    if (!further) return std::nullopt;
    return *port.reach + *further;
  }

  const ResolvedGraph& graph_;
  const Folding& folding_;
  const std::set<uint32_t>& live_;
};

}  // namespace

std::optional<uint32_t> reach_of(const ResolvedGraph& graph, const Folding& folding,
                                 const std::set<uint32_t>& live, const PortKey& key, bool exported) {
  return Reach(graph, folding, live).of(key, exported);
}

}  // namespace gnomon
