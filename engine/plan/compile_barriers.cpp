// Places the barriers of a plan, those of aliased memory included.
#include <algorithm>

#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

// Parts of a heap interval that no earlier occupant covers.
class Uncovered {
 public:
  explicit Uncovered(const Resource& resource) : parts_{{resource.offset, resource.offset + resource.size}} {}
  bool empty() const { return parts_.empty(); }
  // true when `other` lies over a part that was left
  bool cover(const Resource& other) {
    const uint64_t begin = other.offset, end = other.offset + other.size;
    std::vector<std::pair<uint64_t, uint64_t>> left;
    bool touched = false;
    for (const auto& [from, to] : parts_) {
      if (end <= from || begin >= to) {
        left.push_back({from, to});
        continue;
      }
      touched = true;
      if (from < begin) left.push_back({from, begin});
      if (end < to) left.push_back({end, to});
    }
    parts_ = std::move(left);
    return touched;
  }

 private:
  std::vector<std::pair<uint64_t, uint64_t>> parts_;
};

void merge(Use& into, const Use& use) {
  into.stages |= use.stages;
  into.access |= use.access;
}

class Barriers {
 public:
  Barriers(Plan& plan, const std::vector<ResourceUses>& uses, const std::vector<LoopRange>& loops)
      : plan_(plan), uses_(uses), loops_(loops) {}

  void run() {
    find_occupants();
    for (uint32_t i = 0; i < plan_.resources.size(); ++i) {
      set_initial_layout(i);
      first_use(i);
      if (!uses_[i].previous.empty()) first_use_of_previous(i);
      between(i, uses_[i].current, false);
      between(i, uses_[i].previous, true);
      for (uint32_t loop = 0; loop < loops_.size(); ++loop) {
        repeat(i, uses_[i].current, false, loop);
        repeat(i, uses_[i].previous, true, loop);
      }
    }
  }

 private:
  // Heap residents, the one that dies last first: the direct predecessors of a place come first.
  void find_occupants() {
    for (uint32_t i = 0; i < plan_.resources.size(); ++i)
      if (in_heap(plan_.resources[i]) && !uses_[i].current.empty()) occupants_.push_back(i);
    std::stable_sort(occupants_.begin(), occupants_.end(), [&](uint32_t a, uint32_t b) {
      return plan_.resources[a].last > plan_.resources[b].last;
    });
  }

  void put(uint32_t position, const Barrier& barrier) {
    const bool after_all = position >= plan_.nodes.size();
    (after_all ? plan_.final_barriers : plan_.nodes[position].barriers).push_back(barrier);
  }

  const LoopRange* loop_at(uint32_t position) const {
    for (const LoopRange& loop : loops_)
      if (position >= loop.first && position < loop.last) return &loop;
    return nullptr;
  }

  static bool touches(const Epoch& epoch, const LoopRange& loop) {
    return std::any_of(epoch.positions.begin(), epoch.positions.end(),
                       [&](uint32_t position) { return position >= loop.first && position < loop.last; });
  }

  void set_initial_layout(uint32_t i) {
    Resource& resource = plan_.resources[i];
    const bool kept = resource.constant || resource.history || resource.kept;
    if (kept && !resource.is_buffer && !uses_[i].current.empty())
      resource.initial_layout = uses_[i].current.back().use.layout;
  }

  // What the first use in a frame waits for. Frames repeat: the last use is that of the frame before.
  void first_use(uint32_t i) {
    const std::vector<Epoch>& epochs = uses_[i].current;
    if (epochs.empty()) return;
    const Resource& resource = plan_.resources[i];
    if (resource.constant) return first_use_of_constant(i);
    Barrier barrier{i, predecessors(i), epochs.front().use, true};
    if (const LoopRange* loop = loop_at(epochs.front().first)) merge(barrier.before, own_use_in(i, *loop));
    barrier.before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    if (resource.kept) barrier = first_use_of_kept(i);
    put(epochs.front().first, barrier);
  }

  // The frame before left its content in the layout of its last use.
  Barrier first_use_of_kept(uint32_t i) const {
    const std::vector<Epoch>& epochs = uses_[i].current;
    return {i, scope_after(epochs.back()), epochs.front().use, false,
            loop_at(epochs.front().first) != nullptr};
  }

  // The contents stay from frame to frame; only a second layout needs barriers.
  void first_use_of_constant(uint32_t i) {
    const std::vector<Epoch>& epochs = uses_[i].current;
    if (epochs.size() < 2) return;
    put(epochs.front().first,
        {i, scope_after(epochs.back()), epochs.front().use, false, loop_at(epochs.front().first) != nullptr});
  }

  // The copy that was the current one in the frame before.
  void first_use_of_previous(uint32_t i) {
    const std::vector<Epoch>& current = uses_[i].current;
    if (current.empty()) return;
    const Epoch& first = uses_[i].previous.front();
    if (covers(current.back(), first)) return;
    put(first.first,
        {i, scope_after(current.back()), first.use, false, loop_at(first.first) != nullptr, true});
  }

  // Reads that were made visible to at least these stages and accesses, in this layout.
  static bool covers(const Epoch& before, const Epoch& after) {
    return !before.write && before.use.layout == after.use.layout &&
           (after.use.stages & ~before.use.stages) == 0 && (after.use.access & ~before.use.access) == 0;
  }

  Use predecessors(uint32_t i) const {
    const Resource& resource = plan_.resources[i];
    if (resource.history)
      return scope_after(uses_[i].previous.empty() ? uses_[i].current.back() : uses_[i].previous.back());
    if (!in_heap(resource)) return scope_after(uses_[i].current.back());
    Use before;
    Uncovered uncovered(resource);
    for (const uint32_t other : occupants_) {  // of this frame
      if (uncovered.empty()) return before;
      if (plan_.resources[other].last < resource.first && uncovered.cover(plan_.resources[other]))
        merge(before, scope_after(uses_[other].current.back()));
    }
    for (const uint32_t other : occupants_) {  // of the frame before
      if (uncovered.empty()) break;
      const bool later = plan_.resources[other].first > resource.last || other == i;
      if (later && uncovered.cover(plan_.resources[other]))
        merge(before, scope_after(uses_[other].current.back()));
    }
    return before;
  }

  Use own_use_in(uint32_t i, const LoopRange& loop) const {
    Use use;
    for (const Epoch& epoch : uses_[i].current)
      if (touches(epoch, loop)) use = scope_after(epoch);
    return use;
  }

  void between(uint32_t i, const std::vector<Epoch>& epochs, bool previous) {
    for (size_t e = 1; e < epochs.size(); ++e) {
      const uint32_t position = epochs[e].first;
      // from outside into a loop: later iterations come from the loop's own end
      const LoopRange* loop = loop_at(position);
      const bool enters = loop && std::none_of(epochs.begin(), epochs.begin() + std::ptrdiff_t(e),
                                               [&](const Epoch& epoch) { return touches(epoch, *loop); });
      put(position, {i, scope_after(epochs[e - 1]), epochs[e].use, false, enters, previous});
    }
  }

  // From the state at the end of an iteration to that at the start of the next.
  void repeat(uint32_t i, const std::vector<Epoch>& epochs, bool previous, uint32_t loop_index) {
    const LoopRange& loop = loops_[loop_index];
    const Epoch *first = nullptr, *last = nullptr;
    for (const Epoch& epoch : epochs) {
      if (!touches(epoch, loop)) continue;
      if (!first) first = &epoch;
      last = &epoch;
    }
    if (!first || (first == last && !first->write)) return;
    const bool stays = plan_.resources[i].constant || plan_.resources[i].kept;
    const bool made_in_loop = first == &epochs.front() && !previous && !stays;
    if (made_in_loop && first->first >= loop.first) return;  // discarded anew every iteration
    plan_.loops[loop_index].repeat_barriers.push_back(
        {i, scope_after(*last), first->use, false, false, previous});
  }

  Plan& plan_;
  const std::vector<ResourceUses>& uses_;
  const std::vector<LoopRange>& loops_;
  std::vector<uint32_t> occupants_;
};

}  // namespace

void add_barriers(Plan& plan, const std::vector<ResourceUses>& uses, const std::vector<LoopRange>& loops) {
  Barriers(plan, uses, loops).run();
}

}  // namespace gnomon
