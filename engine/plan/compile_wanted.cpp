// What is wanted of a graph, and the facts that it is compiled for.
#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/json_text.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

class Finder {
 public:
  Finder(const Graph& graph, const CompileOptions& options, Wanted& wanted, Problems& problems)
      : graph_(graph), options_(options), wanted_(wanted), problems_(problems), file_(graph.file.string()) {}

  void run() {
    for (const auto& [name, ref] : graph_.outputs)
      wanted_.outputs[name] = {wanted_.graph.index.at(ref.node), ref.port};
    for (const std::string& capture : options_.captures) find_capture(capture);
  }

 private:
  void find_capture(const std::string& capture) {
    const std::string place = "capture " + in_quotes(capture);
    const size_t dot = capture.find('.');
    const auto node = wanted_.graph.index.find(capture.substr(0, dot));
    if (dot == std::string::npos || node == wanted_.graph.index.end()) {
      std::vector<std::string> ids;
      for (const auto& [id, index] : wanted_.graph.index) ids.push_back(id);
      problems_.add(
          dot == std::string::npos ? "must name a port" : "unknown pass", file_, place,
          dot == std::string::npos ? "write \"pass.port\"" : did_you_mean(capture.substr(0, dot), ids));
      return;
    }
    const std::string port = capture.substr(dot + 1);
    if (const auto key = captured_port(node->second, port, place)) wanted_.captures[capture] = *key;
  }

  // An input's capture is what is connected to it.
  std::optional<PortKey> captured_port(uint32_t index, const std::string& name,
                                       const std::string& place) const {
    const ResolvedNode& node = wanted_.graph.nodes[index];
    const Port* port = node.declaration.find(name);
    PortKey key{index, name};
    if (!port) {
      std::vector<std::string> names;
      for (const Port& p : node.declaration.ports()) names.push_back(p.name);
      problems_.add("unknown port " + in_quotes(name), file_, place, did_you_mean(name, names));
      return std::nullopt;
    }
    if (port->direction == Direction::in) {
      const auto source = node.in.find(name);
      if (source == node.in.end()) {
        problems_.add("nothing of this frame is connected to it", file_, place);
        return std::nullopt;
      }
      key = source->second;
    }
    const auto users = wanted_.graph.users.find(key);
    if (users != wanted_.graph.users.end() && !users->second.modifiers.empty()) {
      const std::string& modifier = wanted_.graph.nodes[users->second.modifiers.front()].node->id;
      problems_.add("is modified in place by '" + modifier + "'", file_, place,
                    "capture what that one gives out");
      return std::nullopt;
    }
    return key;
  }

  const Graph& graph_;
  const CompileOptions& options_;
  Wanted& wanted_;
  Problems& problems_;
  const std::string file_;
};

// Where a pass darkens lit surfaces, a light without casters is one with shadows.
void keep_own_errors(Wanted& wanted) {
  const auto& nodes = wanted.graph.nodes;
  const bool darkens = std::any_of(nodes.begin(), nodes.end(),
                                   [](const ResolvedNode& node) { return node.declaration.darkens(); });
  if (!darkens) return;
  for (std::string& why : wanted.facts.shadowless)
    if (why == SceneFacts::no_caster) why.clear();
}

}  // namespace

std::vector<PortKey> Wanted::roots() const {
  std::vector<PortKey> keys;
  for (const auto& [name, key] : outputs) keys.push_back(key);
  for (const auto& [name, key] : captures) keys.push_back(key);
  return keys;
}

Wanted find_wanted(const Graph& graph, const Declaration::Setting& setting, const SceneFacts& facts,
                   const CompileOptions& options) {
  Wanted wanted;
  wanted.facts = facts;
  wanted.file = graph.file.string();
  Problems problems;
  wanted.graph = resolve_graph(graph, setting, problems);
  if (problems.empty()) Finder(graph, options, wanted, problems).run();
  problems.raise();
  keep_own_errors(wanted);
  for (const uint32_t index : live_nodes(wanted.graph, Folding{}, wanted.roots()))
    wanted.needed.insert(wanted.graph.nodes[index].node->id);
  const std::string why = wanted.facts.no_shadow();
  if (!options.keep_all && !why.empty() && leave_technique_out(wanted, setting)) wanted.why_shadowless = why;
  return wanted;
}

}  // namespace gnomon
