// Reads a graph file and puts in the values of its variables.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/base/input_file.h"
#include "engine/base/json_text.h"
#include "engine/graph/graph.h"
#include "engine/graph/graph_resolve.h"

namespace gnomon {
namespace {

using nlohmann::json;

// "name" of "$name"; nothing for any other value.
std::optional<std::string> variable_in(const json& value) {
  const auto* text = value.get_ptr<const std::string*>();
  if (!text || text->empty() || text->front() != '$') return std::nullopt;
  return text->substr(1);
}

// "$name" -> the variable's value; knows which variables are used.
class Variables {
 public:
  Variables(const std::string& file, Problems& problems) : file_(file), problems_(problems) {}

  void read(const json* vars, const Values& set) {
    if (vars && !vars->is_object()) {
      problems_.add("'vars' is " + shown(*vars) + ": must be an object", file_, "/vars");
    } else if (vars) {
      for (const auto& [name, value] : vars->items())
        values_[name] = to_value(value, file_, pointer_to("/vars", name), problems_);
    }
    for (const auto& [name, value] : set) {
      if (!values_.contains(name))
        problems_.add("unknown variable " + in_quotes(name), file_, "/vars", did_you_mean(name, names()));
      values_[name] = value;
      if (!known(vars, name)) used_.insert(name);  // one complaint is enough
    }
  }

  // nullopt, and a problem: no such variable.
  std::optional<Value> resolve(const json& value, const std::string& place) {
    const auto variable = variable_in(value);
    if (!variable) return to_value(value, file_, place, problems_);
    const std::string& name = *variable;
    used_.insert(name);
    const auto found = values_.find(name);
    if (found != values_.end()) return found->second;
    problems_.add("unknown variable " + in_quotes(name), file_, place, did_you_mean(name, names()));
    return std::nullopt;
  }

  void report_unused() {
    for (const auto& [name, value] : values_)
      if (!used_.contains(name))
        problems_.add("variable " + in_quotes(name) + " is never used", file_, pointer_to("/vars", name),
                      "write \"$" + name + "\" as a parameter's value, or remove it");
  }

  const Values& values() const { return values_; }

 private:
  static bool known(const json* vars, const std::string& name) {
    return vars && vars->is_object() && vars->contains(name);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& [name, value] : values_) result.push_back(name);
    return result;
  }

  const std::string& file_;
  Problems& problems_;
  Values values_;
  std::set<std::string> used_;
};

class Loader {
 public:
  Loader(const std::string& file, Problems& problems)
      : file_(file), problems_(problems), vars_(file, problems) {}

  Graph load(const json& document, const Values& set) {
    Graph graph;
    graph.file = file_;
    ObjectReader reader(document, file_, "", problems_);
    check_schema(reader);
    graph.name = reader.required_text("name");
    graph.cite = reader.text("cite", "");
    vars_.read(reader.find("vars"), set);
    graph.nodes = nodes(required(reader, "passes", "/passes"), "/passes");
    graph.outputs = refs(required(reader, "outputs", "/outputs"), "/outputs");
    reader.find("comment");
    reader.find("$schema");
    reader.finish();
    vars_.report_unused();
    graph.vars = vars_.values();
    return graph;
  }

 private:
  void check_schema(ObjectReader& reader) {
    const json* schema = reader.find("schema");
    if (!schema) return problems_.add("'schema' is missing", file_, "", "add \"schema\": 1");
    if (!schema->is_number() || *schema != 1)
      problems_.add("'schema' is " + shown(*schema) + ": must be 1", file_, "/schema");
  }

  const json* required(ObjectReader& reader, const std::string& key, const std::string& place) {
    const json* value = reader.find(key);
    if (!value) problems_.add("'" + key + "' is missing", file_, place);
    return value;
  }

  std::vector<GraphNode> nodes(const json* list, const std::string& place) {
    std::vector<GraphNode> result;
    if (!list) return result;
    if (!list->is_array()) {
      problems_.add("is " + shown(*list) + ": must be an array of passes", file_, place);
      return result;
    }
    if (list->empty()) problems_.add("there are no passes", file_, place);
    for (size_t i = 0; i < list->size(); ++i) result.push_back(node((*list)[i], pointer_to(place, i)));
    return result;
  }

  GraphNode node(const json& object, const std::string& place) {
    GraphNode result;
    result.place = place;
    ObjectReader reader(object, file_, place, problems_);
    result.id = reader.required_text("id");
    result.type = reader.required_text("type");
    reader.find("comment");
    if (result.type == "loop") {
      result.controller = reader.required_text("controller");
      result.max = max_turns(required(reader, "max", pointer_to(place, "max")), pointer_to(place, "max"));
      const std::string body = pointer_to(place, "passes");
      result.body = nodes(required(reader, "passes", body), body);
    } else {
      result.in = refs(reader.find("in"), pointer_to(place, "in"));
      result.from = names(reader.find("from"), pointer_to(place, "from"));
      add_params(reader.find("params"), pointer_to(place, "params"), result);
      add_variables(reader.find("vars"), pointer_to(place, "vars"), result);
    }
    reader.finish();
    return result;
  }

  uint32_t max_turns(const json* value, const std::string& place) {
    constexpr int64_t most = 65536;
    if (!value) return 1;
    const std::optional<Value> iterations = vars_.resolve(*value, place);
    if (!iterations) return 1;
    const auto* integer = std::get_if<int64_t>(&*iterations);
    const auto* number = std::get_if<double>(&*iterations);
    const double count = integer ? double(*integer) : number ? *number : 0;
    if (count >= 1 && count <= double(most) && std::trunc(count) == count) return uint32_t(count);
    problems_.add(
        "'max' is " + shown(*value) + ": must be an integer in 1.." + std::to_string(most) + " iterations",
        file_, place);
    return 1;
  }

  void add_params(const json* object, const std::string& place, GraphNode& node) {
    if (!object) return;
    if (!object->is_object())
      return problems_.add("is " + shown(*object) + ": must be an object", file_, place);
    for (const auto& [name, value] : object->items()) {
      auto resolved = vars_.resolve(value, pointer_to(place, name));
      if (!resolved) continue;
      node.params[name] = *std::move(resolved);
      if (const auto variable = variable_in(value)) node.variables[name] = *variable;
    }
  }

  // Parameters that are the variables of the same names.
  void add_variables(const json* list, const std::string& place, GraphNode& node) {
    for (const std::string& name : names(list, place)) {
      auto resolved = vars_.resolve("$" + name, place);
      if (!resolved) continue;
      if (node.params.contains(name))
        problems_.add("parameter " + in_quotes(name) + " is set twice", file_, place,
                      "name it under \"params\" or under \"vars\"");
      node.params[name] = *std::move(resolved);
      node.variables[name] = name;
      node.vars.push_back(name);
    }
  }

  // A name, or a list of names; none twice.
  std::vector<std::string> names(const json* value, const std::string& place) {
    if (!value) return {};
    std::vector<std::string> result;
    const json list = value->is_array() ? *value : json::array({*value});
    for (const json& name : list) {
      if (!name.is_string()) {
        problems_.add("is " + shown(name) + ": must be a name", file_, place, "or a list of names");
      } else if (std::find(result.begin(), result.end(), name.get<std::string>()) != result.end()) {
        problems_.add("names " + in_quotes(name.get<std::string>()) + " twice", file_, place);
      } else {
        result.push_back(name.get<std::string>());
      }
    }
    return result;
  }

  std::map<std::string, PortRef> refs(const json* object, const std::string& place) {
    std::map<std::string, PortRef> result;
    if (!object) return result;
    if (!object->is_object()) {
      problems_.add("is " + shown(*object) + ": must be an object", file_, place);
      return result;
    }
    for (const auto& [name, value] : object->items())
      if (const auto ref = parse_ref(value, pointer_to(place, name))) result[name] = *ref;
    return result;
  }

  std::optional<PortRef> parse_ref(const json& value, const std::string& place) {
    static const std::string history = "@previous";
    if (value.is_string()) {
      PortRef ref;
      std::string text = value.get<std::string>();
      ref.previous = text.ends_with(history);
      if (ref.previous) text.resize(text.size() - history.size());
      const size_t dot = text.find('.');
      const bool one_dot = dot != std::string::npos && text.find('.', dot + 1) == std::string::npos;
      if (one_dot && dot > 0 && dot + 1 < text.size()) {
        ref.node = text.substr(0, dot);
        ref.port = text.substr(dot + 1);
        return ref;
      }
    }
    problems_.add("is " + shown(value) + ": must name a port", file_, place,
                  "write \"pass.port\", or \"pass.port@previous\" for the frame before");
    return std::nullopt;
  }

  const std::string& file_;
  Problems& problems_;
  Variables vars_;
};

}  // namespace

Graph parse_graph(const std::string& text, const std::string& file_for_errors, const Values& set) {
  const json document = parse_json(text, file_for_errors);
  if (!document.is_object()) fail("is " + shown(document) + ": must be an object", file_for_errors);
  Problems problems;
  Graph graph = Loader(file_for_errors, problems).load(document, set);
  const bool readable = document.contains("passes") && document.contains("outputs");
  if (readable) resolve_graph(graph, Declaration::Setting{}, problems);
  problems.raise();
  return graph;
}

Graph load_graph(const std::filesystem::path& file, const Values& set) {
  return parse_graph(read_input_file(file), file.string(), set);
}

}  // namespace gnomon
