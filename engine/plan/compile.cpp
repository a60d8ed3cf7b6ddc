// Compiles a graph to a plan, step by step.
#include "engine/plan/compile.h"

#include <algorithm>

#include "engine/base/error.h"
#include "engine/light/scene_facts.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

class Compiler {
 public:
  Compiler(const Wanted& wanted, const CompileOptions& options)
      : wanted_(wanted), resolved_(wanted.graph), options_(options) {}

  Plan run() {
    if (!options_.keep_all) folding_ = fold(resolved_, wanted_.facts, wanted_.file);
    live_ = live_nodes(resolved_, folding_, wanted_.roots());
    add_nodes();
    name_results();
    find_loops();
    find_lifetimes(plan_, loops_);
    place_in_heap(plan_, options_, wanted_.file);
    cut_segments(plan_, loops_);
    const std::vector<ResourceUses> uses = collect_uses(plan_, wanted_.file);
    add_barriers(plan_, uses, loops_);
    add_host_barriers(plan_, uses);
    tell_left_out();
    plan_.facts = wanted_.facts;
    return std::move(plan_);
  }

 private:
  // --- nodes and resources ---
  void add_nodes() {
    for (const uint32_t index : resolved_.order)
      if (live_.contains(index)) own_resources(index);
    for (const uint32_t index : resolved_.order)
      if (live_.contains(index)) add_node(index);
  }

  void own_resources(uint32_t index) {
    const ResolvedNode& node = resolved_.nodes[index];
    for (const Port& port : node.declaration.ports()) {
      if (port.direction != Direction::out && port.direction != Direction::transient) continue;
      const bool omittable = port.omittable && (!options_.keep_all || is_shadow_free(port));
      if (omittable && !is_read({index, port.name})) continue;
      Resource resource;
      resource.name = node.node->id + "." + port.name;
      resource.is_buffer = port.is_buffer;
      resource.image = port.image;
      resource.buffer = port.buffer;
      resource.kept = port.kept;
      add_resource({index, port.name}, std::move(resource));
    }
  }

  bool is_exported(const PortKey& key) const {
    const std::vector<PortKey> all = wanted_.roots();
    return std::any_of(all.begin(), all.end(),
                       [&](const PortKey& root) { return root_of(resolved_, folding_, root) == key; });
  }

  bool is_read(const PortKey& key) const {
    if (is_exported(key)) return true;
    for (const uint32_t reader : live_) {
      const ResolvedNode& node = resolved_.nodes[reader];
      for (const auto* inputs : {&node.in, &node.previous})
        for (const auto& [port, source] : *inputs)
          if (root_of(resolved_, folding_, source) == key) return true;
    }
    return false;
  }

  uint32_t add_resource(const PortKey& key, Resource resource) {
    const uint32_t number = uint32_t(plan_.resources.size());
    resource_of_[key] = number;
    plan_.resources.push_back(std::move(resource));
    return number;
  }

  uint32_t constant_resource(const PortKey& source, const std::array<float, 4>& value) {
    const auto found = resource_of_.find(source);
    if (found != resource_of_.end() && plan_.resources[found->second].constant) return found->second;
    const auto known = constants_.find(source);
    if (known != constants_.end()) return known->second;
    const ResolvedNode& node = resolved_.nodes[source.node];
    Resource resource;
    resource.name = node.node->id + "." + source.port;
    resource.image = node.declaration.find(source.port)->image;
    resource.image.extent = {1, 1};  // layers stay, so that a reader's layer index does
    resource.image.mips = 1;
    resource.image_usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    resource.constant = value;
    const uint32_t number = uint32_t(plan_.resources.size());
    plan_.resources.push_back(std::move(resource));
    return constants_[source] = number;
  }

  uint32_t resource_of(const PortKey& key) {
    const Folding::Instead instead = folding_.resolve(key);
    if (instead.constant) return constant_resource(instead.source, *instead.constant);
    return resource_of_.at(root_of(resolved_, folding_, instead.source));
  }

  void add_node(uint32_t index) {
    const ResolvedNode& resolved = resolved_.nodes[index];
    PlanNode node;
    node.id = resolved.node->id;
    node.type = resolved.node->type;
    node.pass = resolved.pass;
    node.declaration = resolved.declaration;
    node.params = resolved.declaration.params();
    for (const Port& port : resolved.declaration.ports()) {
      connect(index, port, node);
      if (port.direction == Direction::out && !port.is_buffer)
        node.reach[port.name] = reach({index, port.name});
    }
    position_[index] = uint32_t(plan_.nodes.size());
    plan_.nodes.push_back(std::move(node));
  }

  std::optional<uint32_t> reach(const PortKey& key) const {
    if (options_.keep_all) return std::nullopt;
    return reach_of(resolved_, folding_, live_, key, is_exported(key));
  }

  void connect(uint32_t index, const Port& port, PlanNode& node) {
    const ResolvedNode& resolved = resolved_.nodes[index];
    std::optional<uint32_t> number;
    if (port.direction == Direction::out || port.direction == Direction::transient) {
      const auto own = resource_of_.find({index, port.name});
      if (own != resource_of_.end()) number = own->second;  // else: an output that nobody reads
    } else if (const auto history = resolved.previous.find(port.name); history != resolved.previous.end()) {
      number = resource_of(history->second);
      node.previous_inputs[port.name] = true;
      plan_.resources[*number].history = true;
      plan_.resources[*number].image_usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;  // cleared before frame 0
      plan_.resources[*number].buffer_usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    } else if (const auto source = resolved.in.find(port.name); source != resolved.in.end()) {
      number = resource_of(source->second);
      if (plan_.resources[*number].constant) node.constant_inputs[port.name] = true;
    }
    if (!number) return;  // an optional input
    node.resources[port.name] = *number;
    Resource& resource = plan_.resources[*number];
    (resource.is_buffer ? resource.buffer_usage : resource.image_usage) |=
        resource.is_buffer ? buffer_usage_of(port.access) : image_usage_of(port.access);
    resource.host_visible = resource.host_visible || has(port.access, Access::host_read);
    resource.host_written = resource.host_written || has(port.access, Access::host_write);
  }

  void name_results() {
    for (const auto& [name, key] : wanted_.outputs) plan_.outputs[name] = exported(key);
    for (const auto& [name, key] : wanted_.captures) plan_.captures[name] = exported(key);
  }

  uint32_t exported(const PortKey& key) {
    const uint32_t number = resource_of(key);
    Resource& resource = plan_.resources[number];
    resource.exported = true;
    if (resource.is_buffer) {
      resource.buffer_usage |= VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    } else {
      resource.image_usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    }
    return number;
  }

  // --- loops ---
  void find_loops() {
    for (const ResolvedLoop& loop : resolved_.loops) {
      if (!live_.contains(loop.controller)) continue;  // then none of its passes is live
      LoopRange range{loop.node->id, uint32_t(plan_.nodes.size()), 0, position_.at(loop.controller),
                      loop.node->max};
      for (uint32_t i = loop.first; i < loop.last; ++i) {
        if (!live_.contains(i)) continue;
        range.first = std::min(range.first, position_.at(i));
        range.last = std::max(range.last, position_.at(i) + 1);
      }
      loops_.push_back(range);
    }
    std::sort(loops_.begin(), loops_.end(),
              [](const LoopRange& a, const LoopRange& b) { return a.first < b.first; });
  }

  // --- what does not run ---
  void tell_left_out() {
    for (const uint32_t index : resolved_.order) {
      if (live_.contains(index)) continue;
      const GraphNode& node = *resolved_.nodes[index].node;
      plan_.left_out.push_back({node.id, node.type, reason(index, wanted_.needed.contains(node.id))});
    }
  }

  std::string reason(uint32_t index, bool needed) const {
    if (!needed) return "no output or capture needs it";
    if (!wanted_.why_shadowless.empty()) return wanted_.why_shadowless;
    const auto said = folding_.reasons.find(index);
    if (said != folding_.reasons.end()) return said->second;
    return "only passes that are left out read it";
  }

  const Wanted& wanted_;
  const ResolvedGraph& resolved_;  // wanted_'s
  const CompileOptions& options_;
  Folding folding_;
  std::set<uint32_t> live_;
  std::map<PortKey, uint32_t> resource_of_, constants_;  // of a port that creates memory; of a folded port
  std::map<uint32_t, uint32_t> position_;                // of a live node
  std::vector<LoopRange> loops_;
  Plan plan_;
};

}  // namespace

Plan compile(const Graph& graph, const Declaration::Setting& setting, const SceneFacts& facts,
             const CompileOptions& options) {
  const Wanted wanted = find_wanted(graph, setting, facts, options);
  return Compiler(wanted, options).run();
}

std::set<std::string> technique_passes(const Graph& graph, const Declaration::Setting& setting) {
  SceneFacts nothing;
  nothing.lights = setting.lights;
  nothing.shadowless.assign(setting.lights, "it is asked what does without shadows");
  const Wanted wanted = find_wanted(graph, setting, nothing, {});
  std::set<std::string> own = wanted.needed;
  if (wanted.why_shadowless.empty()) return {};
  for (const uint32_t index : live_nodes(wanted.graph, Folding{}, wanted.roots()))
    own.erase(wanted.graph.nodes[index].node->id);
  return own;
}

}  // namespace gnomon
