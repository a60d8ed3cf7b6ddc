// Folds passes that yield a constant or an input untouched.
#include <algorithm>

#include "engine/base/error.h"
#include "engine/light/scene_facts.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

class Folder {
 public:
  Folder(const ResolvedGraph& graph, const SceneFacts& facts, const std::string& file)
      : graph_(graph), facts_(facts), file_(file) {}

  Folding run() {
    for (const uint32_t i : graph_.order) ask(i);
    return std::move(folding_);
  }

 private:
  void ask(uint32_t index) {
    const ResolvedNode& node = graph_.nodes[index];
    const Need need = node.pass->need(facts_, node.declaration.params());
    if (need.kind == Need::Kind::run) return;
    folding_.reasons[index] = need.reason;
    for (const auto& [port, value] : need.constants) {
      const PortKey key = output(index, port);
      if (takes_constant(key)) folding_.ports[key] = {{{value[0], value[1], value[2], value[3]}}, key};
    }
    for (const auto& [out, in] : need.bypasses) bypass(index, out, in);
  }

  PortKey output(uint32_t index, const std::string& port) const {
    Problems problems;
    readable_port(graph_.nodes[index], port, file_, graph_.nodes[index].node->place, problems);
    problems.raise();
    return {index, port};
  }

  // nullptr: nobody uses it
  const PortUsers* users_of(const PortKey& key) const {
    const auto found = graph_.users.find(key);
    return found == graph_.users.end() ? nullptr : &found->second;
  }

  const Port& port_of(const PortKey& key) const { return *graph_.nodes[key.node].declaration.find(key.port); }

  // Memory that is modified in place, or kept for the next frame, must be the port's own.
  bool is_only_read(const PortKey& key) const {
    const PortUsers* users = users_of(key);
    return !users || (users->modifiers.empty() && !users->previous);
  }

  template <typename Check>
  bool every_reader(const PortKey& key, Check&& check) const {
    const PortUsers* users = users_of(key);
    if (!users) return true;
    return std::all_of(users->readers.begin(), users->readers.end(), [&](uint32_t reader) {
      const ResolvedNode& node = graph_.nodes[reader];
      return std::all_of(node.in.begin(), node.in.end(), [&](const auto& in) {
        return in.second != key || check(*node.declaration.find(in.first));
      });
    });
  }

  // A 1x1 image can stand for an image that is only sampled.
  bool takes_constant(const PortKey& key) const {
    return !port_of(key).is_buffer && is_only_read(key) &&
           every_reader(key, [](const Port& reader) { return reader.access == Access::sampled; });
  }

  void bypass(uint32_t index, const std::string& out, const std::string& in) {
    const PortKey key = output(index, out);
    const ResolvedNode& node = graph_.nodes[index];
    const Port* input = node.declaration.find(in);
    if (!input)
      fail("'" + node.node->type + "' bypasses its unknown input '" + in + "'", file_, node.node->place);
    const auto source = node.in.find(in);
    if (source == node.in.end()) return;  // unconnected or history: it has to run
    if (!same_shape(*input, port_of(key)))
      fail("'" + node.node->type + "' bypasses '" + out + "' with '" + in + "', which has another shape",
           file_, node.node->place);
    const Folding::Instead instead = folding_.resolve(source->second);
    const bool fits = instead.constant ? takes_constant(key) : can_stand_for(instead.source, key, index);
    if (fits) folding_.ports[key] = instead;
  }

  static bool same_shape(const Port& a, const Port& b) {
    return a.is_buffer == b.is_buffer && (a.is_buffer ? a.buffer == b.buffer : a.image == b.image);
  }

  bool can_stand_for(const PortKey& source, const PortKey& key, uint32_t index) const {
    if (!is_only_read(key)) return false;
    const PortUsers* users = users_of(source);
    const bool others_modify = users && std::any_of(users->modifiers.begin(), users->modifiers.end(),
                                                    [&](uint32_t modifier) { return modifier != index; });
    if (others_modify) return false;  // readers that come later would see the modified value
    const bool host = has(port_of(source).access, Access::host_read);
    return every_reader(key,
                        [&](const Port& reader) { return host || !has(reader.access, Access::host_read); });
  }

  const ResolvedGraph& graph_;
  const SceneFacts& facts_;
  const std::string& file_;
  Folding folding_;
};

}  // namespace

Folding::Instead Folding::resolve(const PortKey& key) const {
  const auto found = ports.find(key);
  return found == ports.end() ? Instead{std::nullopt, key} : found->second;
}

Folding fold(const ResolvedGraph& graph, const SceneFacts& facts, const std::string& file) {
  return Folder(graph, facts, file).run();
}

}  // namespace gnomon
