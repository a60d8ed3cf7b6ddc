// Collects what a pass declares: its ports and parameters.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/error.h"
#include "engine/graph/pass.h"

namespace gnomon {
namespace {

template <typename List>
bool has_name(const List& list, std::string_view name) {
  return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
}

// A pass that declares a name twice is wrong in itself, whatever the graph says.
template <typename List>
void check_new(const List& list, const std::string& name, const char* what) {
  if (has_name(list, name)) fail(std::string("a pass declares ") + what + " '" + name + "' twice");
}

std::optional<double> as_number(const Value& value) {
  if (const auto* integer = std::get_if<int64_t>(&value)) return double(*integer);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

// 512.0 is an integer too: how a number is spelled does not matter.
std::optional<int64_t> as_integer(const Value& value) {
  if (const auto* integer = std::get_if<int64_t>(&value)) return *integer;
  const auto* number = std::get_if<double>(&value);
  constexpr double exact = 9007199254740992.0;  // 2^53: beyond it a double no longer names one integer
  if (!number || std::trunc(*number) != *number || std::abs(*number) > exact) return std::nullopt;
  return int64_t(*number);
}

std::string shown(const Value& value) {
  if (!std::holds_alternative<std::string>(value)) return to_string(value);
  constexpr size_t longest = 64;
  const auto& text = std::get<std::string>(value);
  return "\"" + (text.size() > longest ? text.substr(0, longest) + "..." : text) + "\"";
}

std::string complaint(const std::string& name, const Value& value, const std::string& must) {
  return "'" + name + "' is " + shown(value) + ": must be " + must;
}

// "1" is the unit of a plain ratio and says nothing to a reader.
std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() || unit == "1" ? text : text + " " + unit;
}

std::string compact(double value) {
  std::string text = to_string(Value(value));
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

std::string one_of(const std::vector<std::string>& choices) {
  std::string text = "one of ";
  for (size_t i = 0; i < choices.size(); ++i) text += (i ? ", \"" : "\"") + choices[i] + "\"";
  return text;
}

template <typename Map>
const typename Map::mapped_type* lookup(const Map& map, std::string_view key) {
  const auto found = map.find(key);
  return found == map.end() ? nullptr : &found->second;
}

Port make_port(std::string name, Direction direction, Access access, bool is_buffer, bool array,
               std::string help) {
  Port port;
  port.name = std::move(name);
  port.direction = direction;
  port.access = access;
  port.is_buffer = is_buffer;
  port.array = array;
  port.help = std::move(help);
  return port;
}

}  // namespace

void Declaration::constant(std::string name, Value value) {
  if (!std::holds_alternative<int64_t>(value) && !std::holds_alternative<double>(value))
    fail("a pass declares a constant '" + name + "' that is no number");
  const auto [at, fresh] = constants_.emplace(std::move(name), value);
  if (!fresh && at->second != value) fail("a pass declares a constant '" + at->first + "' of two values");
}

bool Declaration::flag(std::string name, bool standard, std::string help) {
  check_new(specs_, name, "parameter");
  bool result = standard;
  if (const Value* given = lookup(given_, name)) {
    if (const bool* value = std::get_if<bool>(given)) {
      result = *value;
    } else {
      value_errors_.push_back(complaint(name, *given, "true or false"));
    }
  }
  resolved_[name] = result;
  specs_.push_back({std::move(name), ParamType::flag, standard, 0, 1, {}, {}, std::move(help)});
  return result;
}

int64_t Declaration::integer(std::string name, int64_t standard, int64_t min, int64_t max, std::string unit,
                             std::string help) {
  check_new(specs_, name, "parameter");
  int64_t result = standard;
  if (const Value* given = lookup(given_, name)) {
    const std::string range = with_unit(std::to_string(min) + ".." + std::to_string(max), unit);
    const std::optional<int64_t> value = as_integer(*given);
    if (!value) {
      value_errors_.push_back(complaint(name, *given, "an integer in " + range));
    } else if (*value < min || *value > max) {
      value_errors_.push_back(complaint(name, *given, "in " + range));
    } else {
      result = *value;
    }
  }
  resolved_[name] = result;
  specs_.push_back({std::move(name),
                    ParamType::integer,
                    standard,
                    double(min),
                    double(max),
                    {},
                    std::move(unit),
                    std::move(help)});
  return result;
}

double Declaration::number(std::string name, double standard, double min, double max, std::string unit,
                           std::string help) {
  check_new(specs_, name, "parameter");
  double result = standard;
  if (const Value* given = lookup(given_, name)) {
    const std::string range = with_unit(compact(min) + ".." + compact(max), unit);
    const std::optional<double> value = as_number(*given);
    if (!value) {
      value_errors_.push_back(complaint(name, *given, "a number in " + range));
    } else if (!(*value >= min && *value <= max)) {  // so that NaN is out of range
      value_errors_.push_back(complaint(name, *given, "in " + range));
    } else {
      result = *value;
    }
  }
  resolved_[name] = result;
  specs_.push_back(
      {std::move(name), ParamType::number, standard, min, max, {}, std::move(unit), std::move(help)});
  return result;
}

std::string Declaration::choice(std::string name, std::string standard, std::vector<std::string> choices,
                                std::string help) {
  check_new(specs_, name, "parameter");
  if (std::find(choices.begin(), choices.end(), standard) == choices.end())
    fail("a pass declares choice '" + name + "' with default '" + standard +
         "', which is none of its choices");
  std::string result = standard;
  if (const Value* given = lookup(given_, name)) {
    const std::string* value = std::get_if<std::string>(given);
    if (value && std::find(choices.begin(), choices.end(), *value) != choices.end()) {
      result = *value;
    } else {
      value_errors_.push_back(complaint(name, *given, one_of(choices)));
    }
  }
  resolved_[name] = result;
  ParamSpec spec{std::move(name), ParamType::choice, standard, 0, 0, std::move(choices), {}, std::move(help)};
  specs_.push_back(std::move(spec));
  return result;
}

void Declaration::refuse(std::string_view name, std::string_view must_be) {
  const Value* value = lookup(resolved_, name);
  if (!value) fail("a pass refuses parameter '" + std::string(name) + "', which it does not declare");
  value_errors_.push_back(complaint(std::string(name), *value, std::string(must_be)));
}

ImageShape Declaration::input(std::string name, Access access, bool array, std::string help) {
  check_new(ports_, name, "port");
  Port port = make_port(std::move(name), Direction::in, access, false, array, std::move(help));
  if (const Connected* connected = lookup(inputs_, port.name)) {
    port.image = connected->image.value_or(ImageShape{});
    port.traits = connected->traits;
    port.behind = connected->behind;
  }
  ports_.push_back(std::move(port));
  return ports_.back().image;
}

std::optional<ImageShape> Declaration::optional_input(std::string name, Access access, bool array,
                                                      std::string help) {
  const Connected* connected = lookup(inputs_, name);
  const bool present = connected && connected->image;
  input(std::move(name), access, array, std::move(help));
  ports_.back().optional = true;
  return present ? std::optional(ports_.back().image) : std::nullopt;
}

ImageShape Declaration::inout(std::string name, Access access, bool array, std::string help) {
  const ImageShape shape = input(std::move(name), access, array, std::move(help));
  ports_.back().direction = Direction::inout;
  return shape;
}

void Declaration::output(std::string name, Access access, bool array, ImageShape shape, std::string help) {
  check_new(ports_, name, "port");
  ports_.push_back(make_port(std::move(name), Direction::out, access, false, array, std::move(help)));
  ports_.back().image = shape;
  if (const Offers* offered = lookup(offers_, ports_.back().name)) ports_.back().behind = *offered;
}

void Declaration::transient(std::string name, Access access, bool array, ImageShape shape, std::string help) {
  output(std::move(name), access, array, shape, std::move(help));
  ports_.back().direction = Direction::transient;
}

void Declaration::keep(std::string_view name) {
  for (Port& port : ports_)
    if (port.name == name) port.kept = true;
}

void Declaration::omit_unread(std::string_view name) {
  for (Port& port : ports_)
    if (port.name == name) port.omittable = true;
}

void Declaration::reads_around(std::string_view input, uint32_t texels, std::string_view through) {
  for (Port& port : ports_)
    if (port.name == input) port.reach = texels, port.reach_through = through;
}

void Declaration::offer_behind(std::string_view input, std::string_view output) {
  const Connected* connected = lookup(inputs_, input);
  if (!connected) return;
  Offers& offered = offers_[std::string(output)];
  offered.insert(connected->behind.begin(), connected->behind.end());
  if (connected->buffer) offered[std::string(input)] = {connected->node, connected->port, *connected->buffer};
  for (Port& port : ports_)
    if (port.name == output) port.behind = offered;
}

BufferShape Declaration::input_buffer(std::string name, Access access, std::string help) {
  check_new(ports_, name, "port");
  Port port = make_port(std::move(name), Direction::in, access, true, false, std::move(help));
  if (const Connected* connected = lookup(inputs_, port.name)) {
    port.buffer = connected->buffer.value_or(BufferShape{});
    port.traits = connected->traits;
  }
  ports_.push_back(std::move(port));
  return ports_.back().buffer;
}

std::optional<BufferShape> Declaration::optional_input_buffer(std::string name, Access access,
                                                              std::string help) {
  const Connected* connected = lookup(inputs_, name);
  const bool present = connected && connected->buffer;
  input_buffer(std::move(name), access, std::move(help));
  Port& port = ports_.back();
  port.optional = true;
  if (!present) port.buffer.count = 0;
  return present ? std::optional(port.buffer) : std::nullopt;
}

BufferShape Declaration::input_behind(std::string name, std::string_view beside, Access access,
                                      std::string help) {
  if (!has_name(ports_, beside))
    fail("a pass asks for '" + name + "' behind '" + std::string(beside) + "', which it does not declare");
  const Behind* offered = nullptr;
  if (const Connected* connected = lookup(inputs_, beside)) offered = lookup(connected->behind, name);
  input_buffer(std::move(name), access, std::move(help));
  Port& port = ports_.back();
  port.beside = beside;
  if (offered) port.buffer = offered->shape;
  return port.buffer;
}

std::optional<BufferShape> Declaration::optional_input_behind(std::string name, std::string_view beside,
                                                              Access access, std::string help) {
  const Connected* connected = lookup(inputs_, beside);
  const bool offered = connected && connected->behind.contains(name);
  input_behind(std::move(name), beside, access, std::move(help));
  Port& port = ports_.back();
  port.optional = true;
  if (!offered) port.buffer.count = 0;
  return offered ? std::optional(port.buffer) : std::nullopt;
}

BufferShape Declaration::inout_buffer(std::string name, Access access, std::string help) {
  BufferShape shape = input_buffer(std::move(name), access, std::move(help));
  ports_.back().direction = Direction::inout;
  return shape;
}

void Declaration::output_buffer(std::string name, Access access, BufferShape shape, std::string help) {
  check_new(ports_, name, "port");
  ports_.push_back(make_port(std::move(name), Direction::out, access, true, false, std::move(help)));
  ports_.back().buffer = std::move(shape);
}

void Declaration::transient_buffer(std::string name, Access access, BufferShape shape, std::string help) {
  output_buffer(std::move(name), access, std::move(shape), std::move(help));
  ports_.back().direction = Direction::transient;
}

const Port* Declaration::find(std::string_view port) const {
  const auto found =
      std::find_if(ports_.begin(), ports_.end(), [&](const Port& p) { return p.name == port; });
  return found == ports_.end() ? nullptr : &*found;
}

std::vector<std::string> Declaration::undeclared() const {
  std::vector<std::string> names;
  const auto settable = [&](const std::string& name) {
    return std::any_of(specs_.begin(), specs_.end(),
                       [&](const ParamSpec& spec) { return spec.name == name && spec.from.empty(); });
  };
  for (const auto& [name, value] : given_)
    if (!settable(name)) names.push_back(name);
  return names;
}

Params Declaration::params() const { return Params(specs_, resolved_); }

PassRegistry& PassRegistry::instance() {
  static PassRegistry registry;
  return registry;
}

bool PassRegistry::add(std::string type, Make make) { return makers_.emplace(std::move(type), make).second; }

std::unique_ptr<Pass> PassRegistry::make(std::string_view type) const {
  const auto found = makers_.find(type);
  return found == makers_.end() ? nullptr : found->second();
}

std::vector<std::string> PassRegistry::types() const {
  std::vector<std::string> names;
  for (const auto& [name, make] : makers_) names.push_back(name);
  return names;
}

}  // namespace gnomon
