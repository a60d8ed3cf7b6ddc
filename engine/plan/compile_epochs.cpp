// Divides each resource's use into epochs between which something has to happen.
#include <algorithm>

#include "engine/base/error.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

struct NodeUse {
  Use use;
  bool write = false;
};
using UseKey = std::pair<uint32_t, bool>;  // resource, of the copy of the frame before

// Appends a use, or joins it to the reads before it when nothing has to happen between them.
void append(std::vector<Epoch>& epochs, uint32_t position, const NodeUse& use) {
  const bool joins =
      !epochs.empty() && !epochs.back().write && !use.write && epochs.back().use.layout == use.use.layout;
  if (!joins) {
    epochs.push_back({position, position, use.use, use.write, {position}});
    return;
  }
  Epoch& epoch = epochs.back();
  epoch.last = position;
  epoch.use.stages |= use.use.stages;
  epoch.use.access |= use.use.access;
  epoch.positions.push_back(position);
}

// What one pass does with each resource, over all of its ports.
std::map<UseKey, NodeUse> uses_of_node(const Plan& plan, const PlanNode& node, const std::string& file) {
  std::map<UseKey, NodeUse> uses;
  for (const auto& [name, index] : node.resources) {
    const Port& port = *node.declaration.find(name);
    if (port.access == Access::host_read) continue;  // no use on the device: see add_host_barriers
    const Resource& resource = plan.resources[index];
    const Use use = use_of(port.access, node.declaration.kind(), resource.is_buffer, resource.image.format);
    const auto [found, fresh] =
        uses.try_emplace({index, node.previous_inputs.contains(name)}, NodeUse{use, false});
    NodeUse& merged = found->second;
    merged.write = merged.write || writes(port.access);
    if (fresh) continue;
    if (merged.use.layout != use.layout)
      fail("'" + node.id + "' uses '" + resource.name + "' in two layouts at once", file, node.id,
           "give the ports the same access");
    merged.use.stages |= use.stages;
    merged.use.access |= use.access;
  }
  return uses;
}

}  // namespace

std::vector<ResourceUses> collect_uses(const Plan& plan, const std::string& file) {
  std::vector<ResourceUses> result(plan.resources.size());
  for (uint32_t position = 0; position < plan.nodes.size(); ++position)
    for (const auto& [key, use] : uses_of_node(plan, plan.nodes[position], file)) {
      ResourceUses& uses = result[key.first];
      append(key.second ? uses.previous : uses.current, position, use);
    }
  for (uint32_t i = 0; i < plan.resources.size(); ++i) {
    const Resource& resource = plan.resources[i];
    if (!resource.exported) continue;
    const Use read =
        use_of(Access::transfer_read, PassKind::compute, resource.is_buffer, resource.image.format);
    append(result[i].current, uint32_t(plan.nodes.size()), {read, false});
  }
  return result;
}

// Reads have to be over, but made nothing that would have to become available.
Use scope_after(const Epoch& epoch) {
  return {epoch.use.stages, epoch.write ? write_access(epoch.use.access) : 0, epoch.use.layout};
}

}  // namespace gnomon
