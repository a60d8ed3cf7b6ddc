// Inputs that connect themselves to what stands behind another input's source.
#include "engine/base/error.h"
#include "engine/graph/graph_resolve_parts.h"

namespace gnomon {

void connect_behind(ResolvedNode& node) {
  for (const Port& port : node.declaration.ports()) {
    if (port.beside.empty()) continue;
    const Port& beside = *node.declaration.find(port.beside);
    const auto offered = beside.behind.find(port.name);
    if (offered != beside.behind.end()) node.in[port.name] = {offered->second.node, offered->second.port};
  }
}

bool check_behind(const ResolvedGraph& graph, const ResolvedNode& node, const Port& port,
                  const std::string& file, Problems& problems) {
  const auto source = node.in.find(port.beside);
  if (port.optional || node.in.contains(port.name) || source == node.in.end()) return true;
  const ResolvedNode& from = graph.nodes[source->second.node];
  if (!from.sound) return true;
  problems.add("'" + from.node->id + "." + source->second.port + "' has no '" + port.name +
                   "' behind it, which '" + node.node->id + "' (" + node.node->type + ") needs",
               file, place_of_input(node, port.beside));
  return false;
}

}  // namespace gnomon
