// Cuts a plan into segments where the host reads a result.
#include <algorithm>

#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

// The host reads `resource`, written at `writer`, before `reader` may be recorded: a wait belongs at the end
// of some position in [writer, reader).
struct HostRead {
  uint32_t writer = 0, reader = 0, resource = 0;
  std::string reason;
};

const LoopRange* loop_around(const std::vector<LoopRange>& loops, uint32_t position) {
  const auto inside = [&](const LoopRange& loop) { return position >= loop.first && position < loop.last; };
  const auto found = std::find_if(loops.begin(), loops.end(), inside);
  return found == loops.end() ? nullptr : &*found;
}

std::vector<HostRead> host_reads(const Plan& plan, const std::vector<LoopRange>& loops) {
  std::vector<HostRead> reads;
  std::map<uint32_t, uint32_t> last_writer;  // by resource
  for (uint32_t position = 0; position < plan.nodes.size(); ++position) {
    const PlanNode& node = plan.nodes[position];
    for (const auto& [name, resource] : node.resources) {
      const Port& port = *node.declaration.find(name);
      const auto written = last_writer.find(resource);
      const bool this_frame = written != last_writer.end() && !node.previous_inputs.contains(name);
      if (port.direction != Direction::in || !has(port.access, Access::host_read) || !this_frame) continue;
      uint32_t writer = written->second;
      const LoopRange* loop = loop_around(loops, writer);
      if (loop && loop != loop_around(loops, position))
        writer = loop->last - 1;  // wait once, not every iteration
      reads.push_back({writer, position, resource,
                       "'" + node.id + "' reads '" + plan.resources[resource].name + "' on the host"});
    }
    for (const auto& [name, resource] : node.resources)
      if (writes(node.declaration.find(name)->access)) last_writer[resource] = position;
  }
  return reads;
}

struct Wait {
  uint32_t writer = 0;  // the host waits after this position
  std::string reason;
};

// The fewest waits that serve every read: a read joins the wait before it when that one can move behind its
// writer.
std::vector<Wait> find_waits(std::vector<HostRead> reads) {
  std::stable_sort(reads.begin(), reads.end(),
                   [](const HostRead& a, const HostRead& b) { return a.reader < b.reader; });
  std::vector<Wait> waits;
  uint32_t earliest_reader = 0;
  for (const HostRead& read : reads) {
    const bool joins = !waits.empty() && read.writer < earliest_reader;
    if (!joins) {
      waits.push_back({read.writer, read.reason});
      earliest_reader = read.reader;
      continue;
    }
    waits.back().writer = std::max(waits.back().writer, read.writer);
    if (waits.back().reason != read.reason) waits.back().reason += "; " + read.reason;
  }
  return waits;
}

// Why the host waits at the end of a loop's iteration: its controller reads what it wrote itself. Empty: it
// does not.
std::string controller_reads(const Plan& plan, const LoopRange& loop) {
  const PlanNode& controller = plan.nodes[loop.controller];
  for (const Port& port : controller.declaration.ports())
    if (port.direction == Direction::out && has(port.access, Access::host_read))
      return "'" + controller.id + "' reads '" + plan.resources[controller.resources.at(port.name)].name +
             "' on the host";
  return {};
}

uint32_t segment_starting_at(const Plan& plan, uint32_t position) {
  const auto found = std::find_if(plan.segments.begin(), plan.segments.end(),
                                  [&](const Segment& segment) { return segment.first >= position; });
  return uint32_t(found - plan.segments.begin());
}

}  // namespace

void cut_segments(Plan& plan, const std::vector<LoopRange>& loops) {
  const uint32_t count = uint32_t(plan.nodes.size());
  std::map<uint32_t, std::string>
      ends;  // position after a segment's last pass -> why the host waits, or nothing
  ends[count];
  for (const LoopRange& loop : loops) {
    ends[loop.first];
    ends[loop.last] = controller_reads(plan, loop);
  }
  for (const Wait& wait : find_waits(host_reads(plan, loops))) {
    std::string& reason = ends[wait.writer + 1];
    reason += (reason.empty() ? "" : "; ") + wait.reason;
  }
  uint32_t first = 0;
  for (const auto& [end, reason] : ends) {
    if (end == first) continue;
    plan.segments.push_back({first, end, !reason.empty(), reason, {}});
    first = end;
  }
  for (const LoopRange& loop : loops)
    plan.loops.push_back({loop.id,
                          segment_starting_at(plan, loop.first),
                          segment_starting_at(plan, loop.last),
                          loop.controller,
                          loop.max,
                          {}});
}

void add_host_barriers(Plan& plan, const std::vector<ResourceUses>& uses) {
  const Use host = use_of(Access::host_read, PassKind::compute, true, VK_FORMAT_UNDEFINED);
  uint32_t waited_until = 0;  // what was written before is visible to the host already
  for (Segment& segment : plan.segments) {
    if (!segment.host_wait) continue;
    for (uint32_t i = 0; i < plan.resources.size(); ++i) {
      if (!plan.resources[i].host_visible) continue;
      const Epoch* last = nullptr;
      bool written = false;
      for (const Epoch& epoch : uses[i].current) {
        if (epoch.first >= segment.last) break;
        last = &epoch;
        written = written || (epoch.write && epoch.first >= waited_until);
      }
      if (written) segment.end_barriers.push_back({i, scope_after(*last), host});
    }
    waited_until = segment.last;
  }
}

}  // namespace gnomon
