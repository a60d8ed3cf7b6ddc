// What passes say of their outputs, and what others take from it.
#include <algorithm>

#include "engine/base/error.h"
#include "engine/graph/pass.h"

namespace gnomon {

// A pass that names no port of its own is wrong in itself, whatever the graph says.
Port& Declaration::declared(std::string_view port) {
  const auto found =
      std::find_if(ports_.begin(), ports_.end(), [&](const Port& p) { return p.name == port; });
  if (found == ports_.end()) fail("a pass speaks of port '" + std::string(port) + "' before it declares it");
  return *found;
}

void Declaration::set_trait(std::string_view output, std::string key, Value value) {
  declared(output).traits.insert_or_assign(std::move(key), std::move(value));
}

void Declaration::carry_traits(std::string_view input, std::string_view output) {
  const Values& carried = declared(input).traits;
  Port& to = declared(output);
  for (const auto& [key, value] : carried) to.traits.insert_or_assign(key, value);
  offer_behind(input, output);
}

const Value* Declaration::trait(std::string_view input, std::string_view key) const {
  const Port* port = find(input);
  if (!port) fail("a pass asks port '" + std::string(input) + "', which it has not declared, for traits");
  const auto found = port->traits.find(key);
  return found == port->traits.end() ? nullptr : &found->second;
}

bool Declaration::is_connected(std::string_view input) const { return inputs_.contains(input); }

void Declaration::refuse_source(std::string_view input, std::string why) {
  source_errors_.push_back({declared(input).name, std::move(why)});
}

void Declaration::derived(std::string_view input, ParamSpec spec) {
  for (const ParamSpec& other : specs_)
    if (other.name == spec.name) fail("a pass declares parameter '" + spec.name + "' twice");
  spec.from = declared(input).name;
  resolved_[spec.name] = spec.default_value;
  specs_.push_back(std::move(spec));
}

}  // namespace gnomon
