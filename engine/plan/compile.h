// From a graph to a plan: what runs, in which order, with which resources, memory and barriers. Pure: no
// device, so that a plan can be tested as text.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/graph/graph.h"
#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"

namespace gnomon {

// Synchronisation scope of one use. Layout is undefined for buffers.
struct Use {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  bool operator==(const Use&) const = default;
};
Use use_of(Access access, PassKind kind, bool is_buffer, VkFormat format);

struct Resource {
  std::string name;  // "node.port" of its first writer
  bool is_buffer = false;
  ImageShape image;
  BufferShape buffer;
  VkImageUsageFlags image_usage = 0;
  VkBufferUsageFlags buffer_usage = 0;
  bool host_visible = false;  // read by the host
  bool host_written = false;  // written by the host
  bool history = false;       // two copies, swapped every frame; never aliased
  bool kept = false;          // one copy, with what the frame before left in it; never aliased
  bool exported = false;      // graph output or capture: never aliased
  std::optional<std::array<float, 4>> constant;  // folded: 1x1 (layers kept), filled once
  // of constants and of both copies of history: to be in before frame 0
  VkImageLayout initial_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  // plan positions of first and last use (a loop's whole range when inside one)
  uint32_t first = 0, last = 0;
  uint64_t offset = 0, size = 0;  // place in the transient heap; size 0: has memory of its own
};

struct Barrier {
  uint32_t resource = 0;
  Use before, after;
  bool discard = false;   // contents undefined before (first use of aliased or transient memory)
  bool once = false;      // in a loop's body: only in the first iteration (later ones: repeat_barriers)
  bool previous = false;  // of the copy of the frame before (Resource::history)
};

struct PlanNode {
  std::string id, type;
  std::shared_ptr<Pass> pass;
  Declaration declaration;
  Params params;
  std::map<std::string, uint32_t> resources;    // port -> index into Plan::resources
  std::map<std::string, bool> constant_inputs;  // inputs that are folded constants
  std::map<std::string, bool> previous_inputs;  // inputs that read the copy of the frame before (history)
  std::map<std::string, std::optional<uint32_t>> reach;  // of outputs: Environment::reach
  std::vector<Barrier> barriers;                         // one batch, before the pass
};

// [first, last) of Plan::nodes, submitted together; the host waits at its end when `host_wait`.
struct Segment {
  uint32_t first = 0, last = 0;
  bool host_wait = false;
  std::string reason;                 // which host read cuts here
  std::vector<Barrier> end_barriers;  // after its last pass: makes what the host reads visible to it
};

struct LoopPlan {
  std::string id;
  uint32_t first_segment = 0, last_segment = 0;  // [first, last) of Plan::segments
  uint32_t controller = 0;                       // index into Plan::nodes
  uint32_t max = 1;
  // Before the second and later iterations; the body's own barriers are then recorded again, except those
  // marked once.
  std::vector<Barrier> repeat_barriers;
};

struct LeftOut {
  std::string id, type, reason;
};

struct Plan {
  std::vector<PlanNode> nodes;  // in execution order
  std::vector<Resource> resources;
  std::vector<Segment> segments;
  std::vector<LoopPlan> loops;
  std::vector<Barrier> final_barriers;       // outputs to transfer_read for capture
  std::map<std::string, uint32_t> outputs;   // graph output -> resource
  std::map<std::string, uint32_t> captures;  // "node.port" -> resource
  std::vector<LeftOut> left_out;
  SceneFacts facts;  // as passes may rely on them
  uint64_t heap_bytes = 0, heap_bytes_without_aliasing = 0;
};

struct MemoryNeed {
  uint64_t size = 0, alignment = 1;
};
struct CompileOptions {
  bool alias = true;
  bool keep_all = false;              // leave nothing out but what no output reaches
  std::vector<std::string> captures;  // "node.port" kept and readable
  // Memory a resource takes on the device; the default counts texels (tests, `gnomon check`).
  std::function<MemoryNeed(const Resource&)> memory;
};

// Throws Error (file, place) for what does not fit together: shapes, formats, accesses, cycles.
Plan compile(const Graph& graph, const Declaration::Setting& setting, const SceneFacts& facts,
             const CompileOptions& options = {});

// Ids of the passes that are the technique's own: those that a scene without a visible shadow does without.
// None where the graph has nothing to put in their place.
std::set<std::string> technique_passes(const Graph& graph, const Declaration::Setting& setting);

// The plan as stable, readable text: the tests' and `gnomon explain`'s view.
std::string to_text(const Plan& plan);

}  // namespace gnomon
