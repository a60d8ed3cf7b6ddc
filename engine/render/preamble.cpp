// Generates the GLSL text of a pass' bindings, parameter block and defines.
#include "engine/render/preamble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "engine/base/error.h"

namespace gnomon {
namespace {

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return std::isalnum(c) ? char(std::toupper(c)) : '_'; });
  return text;
}

// Prefix of image and sampler types, and the layout qualifier of storage images.
struct GlslFormat {
  const char* prefix;
  const char* qualifier;
};
GlslFormat glsl_format(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
      return {"", "r8"};
    case VK_FORMAT_R8G8B8A8_UNORM:
      return {"", "rgba8"};
    case VK_FORMAT_R16_SFLOAT:
      return {"", "r16f"};
    case VK_FORMAT_R16G16_SNORM:
      return {"", "rg16_snorm"};
    case VK_FORMAT_R16G16_SFLOAT:
      return {"", "rg16f"};
    case VK_FORMAT_R16G16_SINT:
      return {"i", "rg16i"};
    case VK_FORMAT_R16G16_UINT:
      return {"u", "rg16ui"};
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return {"", "rgba16f"};
    case VK_FORMAT_R16G16B16A16_UNORM:
      return {"", "rgba16"};
    case VK_FORMAT_R32_UINT:
      return {"u", "r32ui"};
    case VK_FORMAT_R32G32_UINT:
      return {"u", "rg32ui"};
    case VK_FORMAT_R32G32B32A32_UINT:
      return {"u", "rgba32ui"};
    case VK_FORMAT_R32_SFLOAT:
      return {"", "r32f"};
    case VK_FORMAT_R32G32_SFLOAT:
      return {"", "rg32f"};
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return {"", "rgba32f"};
    default:
      return {"", ""};  // depth formats: sampled only
  }
}

std::string sampled_text(const ShaderPort& shown, bool constant) {
  const Port& p = *shown.port;
  const GlslFormat f = glsl_format(p.image.format);
  std::string text = fmt::format("layout(set = 1, binding = {}) uniform {}sampler2D{} {};\n", shown.binding,
                                 f.prefix, p.array ? "Array" : "", p.name);
  const char* pixel = constant ? "ivec2(0)" : "p";
  const char* layer = constant ? "0" : "layer";
  if (p.array)
    text += fmt::format("{}vec4 {}_at(ivec2 p, int layer) {{ return texelFetch({}, ivec3({}, {}), 0); }}\n",
                        f.prefix, p.name, p.name, pixel, layer);
  else
    text += fmt::format("{}vec4 {}_at(ivec2 p) {{ return texelFetch({}, {}, 0); }}\n", f.prefix, p.name,
                        p.name, pixel);
  if (p.array && p.image.mips > 1)
    text += fmt::format(
        "{}vec4 {}_at(ivec2 p, int layer, int level) {{ return texelFetch({}, ivec3({}, {}), {}); }}\n",
        f.prefix, p.name, p.name, pixel, layer, constant ? "0" : "level");
  return text;
}

std::string storage_text(const ShaderPort& shown) {
  const Port& p = *shown.port;
  const bool reads = has(p.access, Access::storage_read), writes = has(p.access, Access::storage_write);
  const char* qualifier = reads && writes ? "" : reads ? "readonly " : "writeonly ";
  if (has(p.access, Access::uniform))
    return fmt::format("layout(set = 1, binding = {}, std140) uniform {}_block {{ {} {}[{}]; }};\n",
                       shown.binding, p.name, p.buffer.glsl, p.name, p.buffer.count);
  if (p.is_buffer)
    return fmt::format("layout(set = 1, binding = {}, std430) {}buffer {}_block {{ {} {}[]; }};\n",
                       shown.binding, qualifier, p.name, p.buffer.glsl, p.name);
  const GlslFormat f = glsl_format(p.image.format);
  const uint32_t levels = storage_levels(p);
  const std::string number = levels > 1 ? fmt::format("[{}]", levels) : std::string();
  return fmt::format("layout(set = 1, binding = {}, {}) uniform {}{}image2D{} {}{};\n", shown.binding,
                     f.qualifier, qualifier, f.prefix, p.array ? "Array" : "", p.name, number);
}

bool in_block(const ParamSpec& spec) {
  return spec.type == ParamType::integer || spec.type == ParamType::number;
}

}  // namespace

uint32_t storage_levels(const Port& port) {
  const bool both = has(port.access, Access::storage_read) && has(port.access, Access::storage_write);
  return both && !port.is_buffer ? port.image.mips : 1;
}

std::vector<ShaderPort> shader_ports(const Declaration& declaration) {
  std::vector<ShaderPort> shown;
  for (const Port& port : declaration.ports()) {
    constexpr Access kShown =
        Access::sampled | Access::uniform | Access::storage_read | Access::storage_write;
    const bool connected =
        !port.optional || (port.is_buffer ? port.buffer.count > 0 : port.image.format != VK_FORMAT_UNDEFINED);
    if (has(port.access, kShown) && connected) shown.push_back({&port, uint32_t(shown.size())});
  }
  return shown;
}

std::string light_kind_text(const std::vector<Light>& lights) {
  const auto directional = std::count_if(
      lights.begin(), lights.end(), [](const Light& light) { return light.type == LightType::directional; });
  if (lights.empty() || (directional != 0 && directional != std::ssize(lights))) return {};
  return directional == 0 ? "#define NO_DIRECTIONAL_LIGHTS 1\n" : "#define ALL_DIRECTIONAL_LIGHTS 1\n";
}

std::string camera_kind_text(const Camera& camera) {
  return camera.span ? "#define ORTHOGRAPHIC_CAMERA 1\n" : "";
}

std::string preamble(const Declaration& declaration, const std::map<std::string, bool>& constant_inputs) {
  // Constants rather than loads: drivers unroll loops over them and keep loads in those loops uniform.
  std::string text = fmt::format("#define LIGHT_COUNT {}\n", declaration.setting().lights);
  for (const auto& [name, value] : declaration.constants())
    text += fmt::format("const {} {} = {};\n", std::holds_alternative<double>(value) ? "float" : "int", name,
                        to_string(value));
  const auto shown = shader_ports(declaration);
  for (const ShaderPort& port : shown) {
    text += fmt::format("#define HAS_{} 1\n", upper(port.port->name));
    const bool input = port.port->direction == Direction::in || port.port->direction == Direction::inout;
    if (port.port->is_buffer && input)
      text += fmt::format("#define {}_COUNT {}\n", upper(port.port->name), port.port->buffer.count);
    if (port.port->is_buffer && !port.port->buffer.glsl_file.empty())
      text += fmt::format("#include \"{}\"\n", port.port->buffer.glsl_file);
    const auto constant = constant_inputs.find(port.port->name);
    text += has(port.port->access, Access::sampled)
                ? sampled_text(port, constant != constant_inputs.end() && constant->second)
                : storage_text(port);
  }
  std::string members;
  for (const ParamSpec& spec : declaration.param_specs())
    if (in_block(spec))
      members += fmt::format("  {} {};  // {}\n", spec.type == ParamType::integer ? "int" : "float",
                             spec.name, spec.unit);
  if (!members.empty())
    text += fmt::format("layout(set = 1, binding = {}, std140) uniform Params {{\n{}}} params;\n",
                        shown.size(), members);
  return text;
}

// Here and below: a copy, because showing every parameter to the shaders is no look-up of the pass
// (never_read).
Defines parameter_defines(const Params& of_pass) {
  const Params params = of_pass;
  Defines defines;
  for (const ParamSpec& spec : params.specs()) {
    if (spec.type == ParamType::flag)
      defines.emplace_back(upper(spec.name), params.flag(spec.name) ? "1" : "0");
    if (spec.type != ParamType::choice) continue;
    for (size_t i = 0; i < spec.choices.size(); ++i)
      defines.emplace_back(upper(spec.name + "_" + spec.choices[i]), std::to_string(i));
    defines.emplace_back(upper(spec.name), std::to_string(params.choice_index(spec.name)));
  }
  return defines;
}

std::vector<std::byte> parameter_block(const Params& of_pass) {
  const Params params = of_pass;
  std::vector<std::byte> block;
  for (const ParamSpec& spec : params.specs()) {
    if (!in_block(spec)) continue;
    std::byte scalar[4];
    const auto i = spec.type == ParamType::integer ? int32_t(params.integer(spec.name)) : 0;
    const auto f = spec.type == ParamType::number ? float(params.number(spec.name)) : 0.0f;
    std::memcpy(scalar, spec.type == ParamType::integer ? static_cast<const void*>(&i) : &f, 4);
    block.insert(block.end(), scalar, scalar + 4);
  }
  return block;
}

}  // namespace gnomon
