// The steps of compile(), each on its own. Positions are indices into Plan::nodes.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/base/format.h"
#include "engine/graph/graph_resolve.h"
#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"

namespace gnomon {

// --- formats (compile_use.cpp) ---
VkImageUsageFlags image_usage_of(Access access);
VkBufferUsageFlags buffer_usage_of(Access access);
VkAccessFlags2 write_access(VkAccessFlags2 access);  // the writing bits
// Bytes of all mips and layers; the largest uint64_t when that overflows.
inline uint64_t bytes_of(const Resource& resource) {
  return resource.is_buffer ? bytes_of(resource.buffer) : bytes_of(resource.image);
}

// --- what is compiled (compile_wanted.cpp) ---
struct Wanted {
  ResolvedGraph graph;
  std::map<std::string, PortKey> outputs, captures;
  SceneFacts facts;              // as passes may rely on them
  std::set<std::string> needed;  // ids of the passes that outputs and captures need when nothing is left out
  std::string why_shadowless;    // why the technique is left out as a whole; empty: it is not
  std::string file;              // for errors

  std::vector<PortKey> roots() const;  // of outputs and captures
};
Wanted find_wanted(const Graph& graph, const Declaration::Setting& setting, const SceneFacts& facts,
                   const CompileOptions& options);

// --- scenes without a visible shadow (compile_shadowless.cpp) ---
// Whether an output can stand in for a technique's visibility (shadow_free.h).
bool is_shadow_free(const Port& port);
// What the output `visibility` shows, and whatever else reads that, becomes what the passes declare to be the
// same without shadows. False, and nothing is changed, where none has one of its shape.
bool leave_technique_out(Wanted& wanted, const Declaration::Setting& setting);

// --- leaving out (compile_fold.cpp) ---
struct Folding {
  // What a port is instead of its own pass' output: a constant (known by `source`, the port it was declared
  // for), or another pass' port.
  struct Instead {
    std::optional<std::array<float, 4>> constant;
    PortKey source;
  };
  std::map<PortKey, Instead> ports;
  std::map<uint32_t, std::string> reasons;  // of passes that said they need not run

  Instead resolve(const PortKey& key) const;
};
Folding fold(const ResolvedGraph& graph, const SceneFacts& facts, const std::string& file);

// --- cull (compile_cull.cpp) ---
// Nodes that outputs and captures need, directly or not.
std::set<uint32_t> live_nodes(const ResolvedGraph& graph, const Folding& folding,
                              const std::vector<PortKey>& roots);
// The port that created the memory which `key` is a value of: the start of a chain of in-place modifications.
PortKey root_of(const ResolvedGraph& graph, const Folding& folding, PortKey key);

// --- what is read of a shadow map (compile_reach.cpp) ---
// How far from receivers' places the texels of an output are read that count, over all of its live readers;
// none: anywhere. `exported`: it is an output or a capture.
std::optional<uint32_t> reach_of(const ResolvedGraph& graph, const Folding& folding,
                                 const std::set<uint32_t>& live, const PortKey& key, bool exported);

// --- uses (compile_epochs.cpp) ---
// Uses that need no barrier between them: one write, or reads in one layout.
struct Epoch {
  uint32_t first = 0, last = 0;  // positions; final transfers are at Plan::nodes.size()
  Use use;
  bool write = false;
  std::vector<uint32_t> positions;
};
struct ResourceUses {
  std::vector<Epoch> current, previous;  // previous: of the copy of the frame before
};
std::vector<ResourceUses> collect_uses(const Plan& plan, const std::string& file);
Use scope_after(const Epoch& epoch);  // what a later use has to wait for

// --- segments and loops (compile_segments.cpp) ---
struct LoopRange {
  std::string id;
  uint32_t first = 0, last = 0;  // [first, last), positions
  uint32_t controller = 0;
  uint32_t max = 1;
};
void cut_segments(Plan& plan, const std::vector<LoopRange>& loops);
void add_host_barriers(Plan& plan, const std::vector<ResourceUses>& uses);

// --- memory (compile_memory.cpp) ---
void find_lifetimes(Plan& plan, const std::vector<LoopRange>& loops);
void place_in_heap(Plan& plan, const CompileOptions& options, const std::string& file);
bool in_heap(const Resource& resource);

// --- barriers (compile_barriers.cpp) ---
void add_barriers(Plan& plan, const std::vector<ResourceUses>& uses, const std::vector<LoopRange>& loops);

}  // namespace gnomon
