// Checks a whole graph: unknown passes, ports and parameters, shapes, cycles, loops.
#include <algorithm>
#include <bit>

#include "engine/base/error.h"
#include "engine/base/format.h"
#include "engine/graph/graph_resolve.h"

namespace gnomon {
namespace {

bool reads_host_only(Access access) { return access == Access::host_read; }

// The first thing wrong with a port's access, or nothing.
std::string wrong_access(const Port& port) {
  const bool write = writes(port.access);
  if (uint32_t(port.access) == 0) return "has no access";
  if (port.direction == Direction::in && write) return "is an input that is written: declare it as inout";
  if (port.direction != Direction::in && !write) return "is an output that is never written";
  if (has(port.access, Access::host_read) && !port.is_buffer)
    return "is an image; only buffers are read by the host";
  const bool attachment = has(port.access, Access::color | Access::depth | Access::depth_test);
  if (port.is_buffer && (attachment || has(port.access, Access::sampled)))
    return "is a buffer with an image's access";
  if (!port.is_buffer &&
      has(port.access, Access::vertex | Access::indirect | Access::uniform | Access::host_write))
    return "is an image with a buffer's access";
  if (has(port.access, Access::uniform) &&
      (port.direction != Direction::in || port.access != Access::uniform))
    return "is a uniform block that is not an input read as nothing else";
  if (port.omittable && (port.direction != Direction::out || !attachment))
    return "can be omitted, which only attachments can";
  if (reads_host_only(port.access) && port.direction != Direction::in) return "is written by nobody";
  return {};
}

std::string wrong_image(const Port& port) {
  const ImageShape& image = port.image;
  const uint32_t longest = std::max(image.extent.width, image.extent.height);
  if (image.format == VK_FORMAT_UNDEFINED) return "has no format";
  if (image.extent.width == 0 || image.extent.height == 0 || image.layers == 0) return "has a size of 0";
  if (image.mips == 0 || image.mips > uint32_t(std::bit_width(longest)))
    return "has " + std::to_string(image.mips) + " mip levels at " + std::to_string(longest) +
           " texels a side";
  const bool depth = is_depth(image.format);
  if (depth && has(port.access, Access::color | Access::storage_read | Access::storage_write))
    return "has a depth format, which neither colour attachments nor storage images can have";
  if (!depth && has(port.access, Access::depth | Access::depth_test)) return "needs a depth format";
  return {};
}

std::string wrong_buffer(const Port& port) {
  return port.buffer.count == 0 || port.buffer.stride == 0 ? "has a size of 0" : std::string();
}

}  // namespace

void check_declaration(const ResolvedNode& node, const std::string& file, Problems& problems) {
  for (const Port& port : node.declaration.ports()) {
    std::string wrong = wrong_access(port);
    const bool connected = node.in.contains(port.name) || node.previous.contains(port.name);
    const bool shaped =
        port.direction == Direction::out || port.direction == Direction::transient || connected;
    if (wrong.empty() && shaped) wrong = port.is_buffer ? wrong_buffer(port) : wrong_image(port);
    if (!wrong.empty())
      problems.add("port '" + port.name + "' of '" + node.node->type + "' " + wrong, file, node.node->place);
  }
}

}  // namespace gnomon
