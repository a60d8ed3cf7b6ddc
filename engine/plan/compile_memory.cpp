// Places transient resources in one heap, so that those never live together share memory.
#include <algorithm>
#include <numeric>

#include "engine/base/error.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

uint64_t align_up(uint64_t value, uint64_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

MemoryNeed counted(const Resource& resource) { return {bytes_of(resource), 256}; }

bool live_together(const Resource& a, const Resource& b) { return a.first <= b.last && b.first <= a.last; }

void extend(Resource& resource, bool& used, uint32_t first, uint32_t last) {
  resource.first = used ? std::min(resource.first, first) : first;
  resource.last = used ? std::max(resource.last, last) : last;
  used = true;
}

// The lowest place where nothing lies that is live at the same time.
uint64_t first_fit(const std::vector<const Resource*>& neighbours, const MemoryNeed& need) {
  uint64_t offset = 0;
  for (const Resource* other : neighbours) {  // by offset
    if (offset + need.size <= other->offset) break;
    offset = std::max(offset, align_up(other->offset + other->size, need.alignment));
  }
  return offset;
}

class Heap {
 public:
  Heap(Plan& plan, const CompileOptions& options, const std::string& file)
      : plan_(plan), options_(options), file_(file), needs_(plan.resources.size()) {}

  void run() {
    std::vector<uint32_t> transients;
    for (uint32_t i = 0; i < plan_.resources.size(); ++i)
      if (in_heap_kind(plan_.resources[i])) transients.push_back(i);
    for (const uint32_t i : transients) needs_[i] = need_of(plan_.resources[i]);
    if (options_.alias)
      std::stable_sort(transients.begin(), transients.end(),
                       [&](uint32_t a, uint32_t b) { return needs_[a].size > needs_[b].size; });
    for (const uint32_t i : transients) place(i);
  }

  static bool in_heap_kind(const Resource& resource) {
    return !resource.exported && !resource.history && !resource.kept && !resource.host_visible &&
           !resource.host_written && !resource.constant;
  }

 private:
  MemoryNeed need_of(const Resource& resource) const {
    constexpr uint64_t most = uint64_t{1} << 40;
    const uint64_t bytes = bytes_of(resource);
    if (bytes > most) fail("'" + resource.name + "' would take more than 1 TiB", file_);
    MemoryNeed need = options_.memory ? options_.memory(resource) : counted(resource);
    need.size = std::max<uint64_t>(need.size, 1);
    need.alignment = std::max<uint64_t>(need.alignment, 1);
    return need;
  }

  void place(uint32_t index) {
    Resource& resource = plan_.resources[index];
    const MemoryNeed& need = needs_[index];
    std::vector<const Resource*> neighbours;
    for (const Resource* other : placed_)
      if (!options_.alias || live_together(resource, *other)) neighbours.push_back(other);
    resource.offset = first_fit(neighbours, need);
    resource.size = need.size;
    const auto by_offset = [](const Resource* a, const Resource* b) { return a->offset < b->offset; };
    placed_.insert(std::upper_bound(placed_.begin(), placed_.end(), &resource, by_offset), &resource);
    plan_.heap_bytes = std::max(plan_.heap_bytes, resource.offset + resource.size);
    plan_.heap_bytes_without_aliasing =
        align_up(plan_.heap_bytes_without_aliasing, need.alignment) + resource.size;
  }

  Plan& plan_;
  const CompileOptions& options_;
  const std::string& file_;
  std::vector<MemoryNeed> needs_;
  std::vector<const Resource*> placed_;  // by offset
};

}  // namespace

bool in_heap(const Resource& resource) { return resource.size > 0; }

// In a loop everything is live from the first pass to the last: the next iteration may read it again.
void find_lifetimes(Plan& plan, const std::vector<LoopRange>& loops) {
  std::vector<char> used(plan.resources.size(), 0);
  for (uint32_t position = 0; position < plan.nodes.size(); ++position) {
    uint32_t first = position, last = position;
    for (const LoopRange& loop : loops)
      if (position >= loop.first && position < loop.last) {
        first = loop.first;
        last = loop.last - 1;
      }
    for (const auto& [port, resource] : plan.nodes[position].resources) {
      bool known = used[resource];
      extend(plan.resources[resource], known, first, last);
      used[resource] = known;
    }
  }
}

void place_in_heap(Plan& plan, const CompileOptions& options, const std::string& file) {
  Heap(plan, options, file).run();
}

}  // namespace gnomon
