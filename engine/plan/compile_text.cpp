// Writes a plan as text.
#include <algorithm>
#include <iterator>
#include <span>

#include "engine/plan/compile.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

struct Flag {
  uint64_t bit;
  const char* name;
};

constexpr Flag kStageNames[] = {
    {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "indirect"},
    {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "vertex_input"},
    {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
    {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "early_tests"},
    {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "late_tests"},
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color_output"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"},
    {VK_PIPELINE_STAGE_2_HOST_BIT, "host"},
};

constexpr Flag kAccessNames[] = {
    {VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sampled_read"},
    {VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "storage_read"},
    {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "storage_write"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "color_read"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "color_write"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "depth_read"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depth_write"},
    {VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, "vertex_read"},
    {VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, "indirect_read"},
    {VK_ACCESS_2_TRANSFER_READ_BIT, "transfer_read"},
    {VK_ACCESS_2_TRANSFER_WRITE_BIT, "transfer_write"},
    {VK_ACCESS_2_HOST_READ_BIT, "host_read"},
    {VK_ACCESS_2_HOST_WRITE_BIT, "host_write"},
    {VK_ACCESS_2_UNIFORM_READ_BIT, "uniform_read"},
};

std::string flags_text(uint64_t bits, std::span<const Flag> names) {
  std::string text;
  for (const Flag& flag : names)
    if (bits & flag.bit) text += (text.empty() ? "" : "|") + std::string(flag.name);
  return text.empty() ? "none" : text;
}

const char* layout_name(VkImageLayout layout) {
  switch (layout) {
    case VK_IMAGE_LAYOUT_UNDEFINED:
      return "undefined";
    case VK_IMAGE_LAYOUT_GENERAL:
      return "general";
    case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
      return "color_attachment";
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL:
      return "depth_attachment";
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL:
      return "depth_read_only";
    case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
      return "read_only";
    case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
      return "transfer_source";
    case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
      return "transfer_target";
    default:
      return "another layout";
  }
}

class Writer {
 public:
  explicit Writer(const Plan& plan) : plan_(plan) {}

  std::string run() {
    passes();
    segments();
    loops();
    barriers("final", plan_.final_barriers, "  ");
    resources();
    results("outputs", plan_.outputs);
    results("captures", plan_.captures);
    left_out();
    line("heap " + std::to_string(plan_.heap_bytes) + " bytes, " +
         std::to_string(plan_.heap_bytes_without_aliasing) + " without aliasing");
    return std::move(text_);
  }

 private:
  void line(const std::string& text) { text_ += text + "\n"; }
  std::string resource(uint32_t index) const {
    return "#" + std::to_string(index) + " " + plan_.resources[index].name;
  }

  std::string use(const Use& use, bool is_buffer) const {
    std::string text = flags_text(use.stages, kStageNames) + "/" + flags_text(use.access, kAccessNames);
    return is_buffer ? text : text + "/" + layout_name(use.layout);
  }

  void barriers(const std::string& title, const std::vector<Barrier>& list, const std::string& indent) {
    if (list.empty()) return;
    if (!title.empty()) line(title);
    for (const Barrier& barrier : list) {
      const bool is_buffer = plan_.resources[barrier.resource].is_buffer;
      line(indent + "barrier " + resource(barrier.resource) + (barrier.previous ? "@previous" : "") + ": " +
           use(barrier.before, is_buffer) + " -> " + use(barrier.after, is_buffer) +
           (barrier.discard ? " discard" : "") + (barrier.once ? " once" : ""));
    }
  }

  void passes() {
    line("passes");
    for (size_t i = 0; i < plan_.nodes.size(); ++i) {
      const PlanNode& node = plan_.nodes[i];
      line("  " + std::to_string(i) + " " + node.id + " (" + node.type + ")");
      for (const Port& port : node.declaration.ports()) this->port(node, port);
      barriers("", node.barriers, "    ");
    }
  }

  void port(const PlanNode& node, const Port& port) {
    static constexpr const char* directions[] = {"in", "out", "inout", "transient"};
    const auto found = node.resources.find(port.name);
    if (found == node.resources.end()) return;
    std::string text = std::string("    ") + directions[int(port.direction)] + " " + port.name + " = " +
                       resource(found->second);
    if (node.previous_inputs.contains(port.name)) text += "@previous";
    if (node.constant_inputs.contains(port.name)) text += " (constant)";
    line(text);
  }

  void segments() {
    line("segments");
    for (size_t i = 0; i < plan_.segments.size(); ++i) {
      const Segment& segment = plan_.segments[i];
      line("  " + std::to_string(i) + " passes " + range(segment.first, segment.last) +
           (segment.host_wait ? ", then the host waits: " + segment.reason : ""));
      barriers("", segment.end_barriers, "    ");
    }
  }

  static std::string range(uint32_t first, uint32_t last) {
    return std::to_string(first) + ".." + std::to_string(last - 1);
  }

  void loops() {
    if (!plan_.loops.empty()) line("loops");
    for (const LoopPlan& loop : plan_.loops) {
      line("  " + loop.id + " segments " + range(loop.first_segment, loop.last_segment) + ", controller " +
           plan_.nodes[loop.controller].id + ", at most " + std::to_string(loop.max) + " iterations");
      barriers("", loop.repeat_barriers, "    ");
    }
  }

  void resources() {
    line("resources");
    for (uint32_t i = 0; i < plan_.resources.size(); ++i)
      line("  " + resource(i) + ": " + shape(plan_.resources[i]) + ", passes " +
           range(plan_.resources[i].first, plan_.resources[i].last + 1) + ", " + place(plan_.resources[i]));
  }

  static std::string shape(const Resource& resource) {
    if (resource.is_buffer)
      return std::to_string(resource.buffer.count) + " x " + resource.buffer.glsl + " (" +
             std::to_string(resource.buffer.stride) + " bytes)";
    const ImageShape& image = resource.image;
    std::string text = std::to_string(image.extent.width) + "x" + std::to_string(image.extent.height);
    if (image.layers > 1) text += "x" + std::to_string(image.layers);
    if (image.mips > 1) text += " " + std::to_string(image.mips) + " mips";
    return text + " " + format_name(image.format);
  }

  static std::string place(const Resource& resource) {
    if (in_heap(resource))
      return "heap " + std::to_string(resource.offset) + " + " + std::to_string(resource.size);
    std::string text = "own memory";
    if (resource.constant) text += ", constant";
    if (resource.constant)
      for (const float value : *resource.constant) text += " " + number(value);
    if (resource.history) text += ", history";
    if (resource.kept) text += ", kept";
    if (resource.host_visible) text += ", host visible";
    if (resource.host_written) text += ", host written";
    if (resource.exported) text += ", exported";
    return text;
  }

  static std::string number(float value) {
    std::string text = to_string(Value(double(value)));
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text;
  }

  void results(const std::string& title, const std::map<std::string, uint32_t>& list) {
    if (!list.empty()) line(title);
    for (const auto& [name, index] : list) line("  " + name + " = " + resource(index));
  }

  void left_out() {
    if (!plan_.left_out.empty()) line("left out");
    for (const LeftOut& pass : plan_.left_out) line("  " + pass.id + " (" + pass.type + "): " + pass.reason);
  }

  const Plan& plan_;
  std::string text_;
};

}  // namespace

std::string to_text(const Plan& plan) { return Writer(plan).run(); }

}  // namespace gnomon
