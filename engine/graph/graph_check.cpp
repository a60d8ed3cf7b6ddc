// What is wrong with a node: its parameters, what is connected to it, and its declaration in itself.
#include <algorithm>
#include <bit>

#include "engine/base/error.h"
#include "engine/base/format.h"
#include "engine/base/json_text.h"
#include "engine/graph/graph_resolve_parts.h"

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

class NodeCheck {
 public:
  NodeCheck(ResolvedGraph& graph, ResolvedNode& node, const Complaints& complaints)
      : graph_(graph), node_(node), complaints_(complaints) {}

  void run() {
    check_params();
    for (const auto& [input, ref] : node_.node->in) check_input(input);
    for (const auto& [input, source] : node_.in)
      if (!node_.node->in.contains(input)) check_source(*node_.declaration.find(input));
    for (const auto& [input, why] : node_.declaration.source_errors()) refuse_source(input, why);
    check_required();
    if (!node_.sound) return;
    const size_t before = complaints_.problems.all().size();
    check_declaration(node_, complaints_.file, complaints_.problems);
    node_.sound = complaints_.problems.all().size() == before;
  }

 private:
  void unsound(std::string what, std::string place, std::string hint = {}) {
    complaints_.add(node_, std::move(what), std::move(place), std::move(hint));
  }

  void check_params() {
    for (const std::string& name : node_.declaration.undeclared()) undeclared(name, place_of_param(name));
    for (const std::string& sentence : node_.declaration.value_errors()) {
      const std::string name = sentence.substr(1, sentence.find('\'', 1) - 1);  // "'size' is 0: must be ..."
      unsound(sentence, place_of_param(name));
    }
  }

  std::string place_of_param(const std::string& name) const {
    const std::vector<std::string>& vars = node_.node->vars;
    if (std::find(vars.begin(), vars.end(), name) != vars.end()) return pointer_to(node_.node->place, "vars");
    return pointer_to(pointer_to(node_.node->place, "params"), name);
  }

  void undeclared(const std::string& name, const std::string& place) {
    std::vector<std::string> names;
    for (const ParamSpec& spec : node_.declaration.param_specs()) {
      if (spec.from.empty()) names.push_back(spec.name);
      if (!spec.from.empty() && spec.name == name)
        return unsound("'" + name + "' of '" + node_.node->type + "' is not set here: it comes with input '" +
                           spec.from + "'",
                       place, "set it where what is read is made");
    }
    unsound("unknown parameter " + in_quotes(name) + " of '" + node_.node->type + "'", place,
            did_you_mean(name, names));
  }

  void check_input(const std::string& name) {
    const Port* port = node_.declaration.find(name);
    const std::string place = place_of_input(node_, name);
    if (!port || port->direction == Direction::transient) {
      std::vector<std::string> names;
      for (const Port& p : node_.declaration.ports())
        if (p.beside.empty() && (p.direction == Direction::in || p.direction == Direction::inout))
          names.push_back(p.name);
      return unsound("unknown input " + in_quotes(name) + " of '" + node_.node->type + "'", place,
                     did_you_mean(name, names));
    }
    if (!port->beside.empty())
      return unsound("'" + name + "' of '" + node_.node->type + "' is not connected here: it comes with '" +
                         port->beside + "'",
                     place);
    if (port->direction == Direction::out)
      return unsound("'" + name + "' is an output of '" + node_.node->type + "', not an input", place);
    check_source(*port);
  }

  void check_source(const Port& port) {
    const bool history = node_.previous.contains(port.name);
    const auto& sources = history ? node_.previous : node_.in;
    const auto source = sources.find(port.name);
    if (source == sources.end()) return;  // reported when it was connected
    const ResolvedNode& from = graph_.nodes[source->second.node];
    if (!from.pass) return;
    const std::string place = place_of_input(node_, port.name);
    const Port* given =
        readable_port(from, source->second.port, complaints_.file, place, complaints_.problems);
    if (!given) {
      node_.sound = false;
      return;
    }
    if (history && port.direction == Direction::inout)
      return unsound("'" + port.name + "' is modified in place and cannot be history", place);
    compare(port, from, *given, place);
  }

  void compare(const Port& port, const ResolvedNode& from, const Port& given, const std::string& place) {
    const std::string ref = in_quotes(from.node->id + "." + given.name);
    if (given.is_buffer != port.is_buffer)
      return unsound(ref + (given.is_buffer ? " is a buffer, and '" : " is an image, and '") + port.name +
                         (port.is_buffer ? "' takes a buffer" : "' takes an image"),
                     place);
    if (!given.is_buffer && !port.array && given.image.layers > 1 && from.sound)
      unsound(ref + " has " + std::to_string(given.image.layers) + " layers, and '" + port.name +
                  "' takes a single one",
              place);
    if (has(port.access, Access::host_read) && !has(given.access, Access::host_read))
      unsound("'" + port.name + "' is read by the host, and " + ref + " is not host-readable", place);
  }

  // The pass cannot use what is connected, though its shape would do.
  void refuse_source(const std::string& input, const std::string& why) {
    const auto& sources = node_.previous.contains(input) ? node_.previous : node_.in;
    const auto source = sources.find(input);
    if (source == sources.end()) return;
    const ResolvedNode& from = graph_.nodes[source->second.node];
    if (!from.sound) return;
    unsound(who(node_) + " cannot read '" + source->second.port + "' of " + who(from) + ": it " + why,
            place_of_input(node_, input), "'" + from.node->id + "' is at " + from.node->place);
  }

  void check_required() {
    const bool unknown = node_.from.size() != node_.node->from.size();  // reported when it was connected
    const bool reported = unknown || std::any_of(node_.from.begin(), node_.from.end(), [&](uint32_t source) {
                            return !graph_.nodes[source].sound;
                          });
    for (const Port& port : node_.declaration.ports()) {
      const bool input = port.direction == Direction::in || port.direction == Direction::inout;
      const bool by_itself = !port.beside.empty();
      if (by_itself && !check_behind(graph_, node_, port, complaints_.file, complaints_.problems))
        node_.sound = false;
      const bool connected = node_.node->in.contains(port.name) || node_.in.contains(port.name);
      if (input && !by_itself && !port.optional && !connected && !reported)
        unsound("required input '" + port.name + "' of '" + node_.node->type + "' is not connected",
                pointer_to(node_.node->place, "in"));
    }
  }

  ResolvedGraph& graph_;
  ResolvedNode& node_;
  const Complaints& complaints_;
};

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

const Port* readable_port(const ResolvedNode& node, const std::string& port, const std::string& file,
                          const std::string& place, Problems& problems) {
  const Port* found = node.declaration.find(port);
  if (found && (found->direction == Direction::out || found->direction == Direction::inout)) return found;
  std::vector<std::string> names;
  for (const Port& p : node.declaration.ports())
    if (p.direction == Direction::out || p.direction == Direction::inout) names.push_back(p.name);
  const std::string hint = did_you_mean(port, names);
  if (!found) {
    problems.add("unknown output " + in_quotes(port) + " of " + who(node), file, place, hint);
  } else if (found->direction == Direction::in) {
    problems.add("'" + port + "' is an input of " + who(node) + ", not an output", file, place, hint);
  } else {
    problems.add("'" + port + "' is internal to " + who(node), file, place, hint);
  }
  return nullptr;
}

void check_node(ResolvedGraph& graph, uint32_t index, const Complaints& complaints) {
  NodeCheck(graph, graph.nodes[index], complaints).run();
}

}  // namespace gnomon
