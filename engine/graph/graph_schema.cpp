// Makes the JSON Schema of graph files from what the passes declare.
#include <nlohmann/json.hpp>

#include "engine/graph/graph.h"

namespace gnomon {
namespace {

using nlohmann::json;

constexpr const char* kNamePattern = "^[A-Za-z0-9_-]+$";
constexpr const char* kPortPattern = "^[A-Za-z0-9_-]+\\.[^.@]+(@previous)?$";

json text(const char* description) { return {{"type", "string"}, {"description", description}}; }

json value_schema(const ParamSpec& spec) {
  switch (spec.type) {
    case ParamType::flag:
      return {{"type", "boolean"}};
    case ParamType::integer:
      return {{"type", "integer"}, {"minimum", int64_t(spec.min)}, {"maximum", int64_t(spec.max)}};
    case ParamType::number:
      return {{"type", "number"}, {"minimum", spec.min}, {"maximum", spec.max}};
    case ParamType::choice:
      return {{"enum", spec.choices}};
  }
  return json::object();
}

json standard_of(const ParamSpec& spec) {
  return std::visit([](const auto& value) { return json(value); }, spec.default_value);
}

// Every parameter may be a variable instead.
json param_schema(const ParamSpec& spec) {
  std::string description = spec.help;
  if (!spec.unit.empty()) description += (description.empty() ? "unit: " : "; unit: ") + spec.unit;
  return {{"description", description},
          {"default", standard_of(spec)},
          {"anyOf", json::array({value_schema(spec), json{{"$ref", "#/$defs/variable"}}})}};
}

// Which ports there are may depend on flags and choices: one declaration for each of their values, and the
// defaults.
std::vector<Declaration> variants(const Pass& pass) {
  std::vector<Declaration> result(1);
  pass.declare(result.front());
  const std::vector<ParamSpec> specs = result.front().param_specs();
  const auto add = [&](const std::string& name, Value value) {
    result.emplace_back(Declaration::Setting{}, Values{{name, std::move(value)}}, Declaration::Inputs{});
    pass.declare(result.back());
  };
  for (const ParamSpec& spec : specs) {
    if (!spec.from.empty()) continue;
    if (spec.type == ParamType::flag) add(spec.name, !std::get<bool>(spec.default_value));
    for (const std::string& choice : spec.choices) add(spec.name, choice);
  }
  return result;
}

// Of an input: not one that connects itself.
bool is_connected_by_file(const Port& port) {
  return port.beside.empty() && (port.direction == Direction::in || port.direction == Direction::inout);
}

json inputs_schema(const std::vector<Declaration>& variants) {
  json ports = json::object();
  for (const Declaration& declaration : variants)
    for (const Port& port : declaration.ports())
      if (is_connected_by_file(port))
        ports[port.name] = {{"description", port.help}, {"$ref", "#/$defs/port"}};
  return {{"type", "object"}, {"properties", ports}, {"additionalProperties", false}};
}

// Inputs that every variant asks for.
json required_inputs(const std::vector<Declaration>& variants) {
  std::map<std::string, size_t> asked;
  for (const Declaration& declaration : variants)
    for (const Port& port : declaration.ports())
      if (is_connected_by_file(port) && !port.optional) ++asked[port.name];
  json required = json::array();
  for (const auto& [name, count] : asked)
    if (count == variants.size()) required.push_back(name);
  return required;
}

json params_schema(const std::vector<Declaration>& variants) {
  json params = json::object();
  for (const Declaration& declaration : variants)
    for (const ParamSpec& spec : declaration.param_specs())
      if (spec.from.empty() && !params.contains(spec.name)) params[spec.name] = param_schema(spec);
  return {{"type", "object"}, {"properties", params}, {"additionalProperties", false}};
}

// A name, or several, each of `names`.
json name_list(const json& names, const char* description) {
  const json one = names.is_null() ? json{{"type", "string"}} : json{{"enum", names}};
  return {{"description", description},
          {"anyOf", json::array({one, json{{"type", "array"}, {"items", one}, {"uniqueItems", true}}})}};
}

// { "if": the type is this one, "then": these inputs and parameters }
json type_rule(const std::string& type, const Pass& pass) {
  const std::vector<Declaration> declarations = variants(pass);
  const json params = params_schema(declarations);
  json names = json::array();
  for (const auto& [name, param] : params["properties"].items()) names.push_back(name);
  json then{{"description", declarations.front().summary()},
            {"properties", {{"in", inputs_schema(declarations)}, {"params", params}}}};
  if (!names.empty())
    then["properties"]["vars"] = name_list(names, "parameters that are the variables of the same names");
  const json required = required_inputs(declarations);
  if (!required.empty())  // one by one, or by the names of those who give them
    then["anyOf"] =
        json::array({json{{"required", {"from"}}},
                     json{{"required", {"in"}}, {"properties", {{"in", {{"required", required}}}}}}});
  return {{"if", {{"properties", {{"type", {{"const", type}}}}}}}, {"then", then}};
}

json loop_rule() {
  json then{{"description", "repeats its passes until the controller says done"},
            {"properties",
             {{"controller", text("id of the pass of the body that decides")},
              {"max",
               {{"anyOf", json::array({json{{"type", "integer"}, {"minimum", 1}, {"maximum", 65536}},
                                       json{{"$ref", "#/$defs/variable"}}})},
                {"description", "most iterations"}}},
              {"passes", {{"$ref", "#/$defs/passes"}}}}},
            {"required", {"controller", "max", "passes"}}};
  return {{"if", {{"properties", {{"type", {{"const", "loop"}}}}}}}, {"then", then}};
}

json pass_schema() {
  const PassRegistry& registry = PassRegistry::instance();
  json types = registry.types();
  json rules = json::array();
  for (const std::string& type : registry.types()) rules.push_back(type_rule(type, *registry.make(type)));
  types.push_back("loop");
  rules.push_back(loop_rule());
  return {{"type", "object"},
          {"required", {"id", "type"}},
          {"properties",
           {{"id", {{"type", "string"}, {"pattern", kNamePattern}}},
            {"type", {{"enum", types}}},
            {"in", {{"type", "object"}}},
            {"from", name_list(nullptr, "passes whose outputs feed the inputs of the same names")},
            {"vars", json::object()},
            {"params", {{"type", "object"}}},
            {"comment", json::object()}}},
          {"allOf", rules},
          {"unevaluatedProperties", false}};
}

}  // namespace

nlohmann::json graph_schema() {
  const json variable_values{{"type", {"boolean", "number", "string"}}};
  return {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", "Gnomon graph file"},
      {"type", "object"},
      {"required", {"schema", "name", "passes", "outputs"}},
      {"additionalProperties", false},
      {"properties",
       {{"$schema", {{"type", "string"}}},
        {"schema", {{"const", 1}}},
        {"name", text("name of the technique")},
        {"cite", text("where the technique is described")},
        {"comment", json::object()},
        {"vars", {{"type", "object"}, {"additionalProperties", variable_values}}},
        {"passes", {{"$ref", "#/$defs/passes"}}},
        {"outputs",
         {{"type", "object"}, {"minProperties", 1}, {"additionalProperties", {{"$ref", "#/$defs/port"}}}}}}},
      {"$defs",
       {{"variable", {{"type", "string"}, {"pattern", "^\\$."}, {"description", "a variable: \"$name\""}}},
        {"port", {{"type", "string"}, {"pattern", kPortPattern}}},
        {"passes", {{"type", "array"}, {"minItems", 1}, {"items", {{"$ref", "#/$defs/pass"}}}}},
        {"pass", pass_schema()}}}};
}

}  // namespace gnomon
