// GLSL generated from a declaration: bindings, accessors of folded inputs, defines and the parameter block.
#include "engine/render/preamble.h"

#include <gtest/gtest.h>

#include <cstring>

#include "engine/base/error.h"
#include "engine/scene/scene.h"
#include "engine/vulkan/shader.h"

namespace gnomon {
namespace {

constexpr ImageShape image(VkFormat format, uint32_t layers = 1) { return {{8, 8}, layers, 1, format}; }

// Every kind of port that shaders see, with some between them that they do not.
Declaration fake(bool connected_extra = true) {
  Declaration::Inputs inputs;
  inputs["depth"].image = image(VK_FORMAT_D32_SFLOAT);
  inputs["shadow_map"].image = image(VK_FORMAT_D32_SFLOAT, 6);
  inputs["ids"].image = image(VK_FORMAT_R32_UINT);
  inputs["list"].buffer = BufferShape{100, 4, "uint"};
  if (connected_extra) inputs["extra"].image = image(VK_FORMAT_R16_SFLOAT);
  Declaration d({}, {{"mode", Value(std::string("second way"))}, {"steps", Value(int64_t{7})}}, inputs);
  d.input("depth", Access::sampled, false, "camera depth");
  d.input("test_depth", Access::depth_test, false, "not seen by shaders");
  d.input("shadow_map", Access::sampled, true, "array");
  d.input("ids", Access::sampled, false, "integers");
  d.optional_input("extra", Access::sampled, false, "may be missing");
  d.input_buffer("list", Access::storage_read, "read only");
  d.output("target", Access::color, false, image(VK_FORMAT_R8_UNORM), "not seen by shaders");
  d.output("result", Access::storage_write, false, image(VK_FORMAT_R8_UNORM), "written");
  d.transient("work", Access::storage_read | Access::storage_write, true, image(VK_FORMAT_R16G16_SINT, 2),
              "both");
  d.output_buffer("counts", Access::storage_write | Access::host_read, {4, 4, "uint"}, "written");
  d.flag("wide", true, "a flag");
  d.integer("steps", 4, 1, 16, "texels", "an integer");
  d.choice("mode", "first", {"first", "second way"}, "a choice");
  d.number("epsilon", 0.25, 0, 1, "1", "a number");
  return d;
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
}

TEST(Preamble, ports_that_shaders_see_are_numbered_in_order) {
  const Declaration d = fake();
  const auto shown = shader_ports(d);
  const std::vector<std::string> names{"depth", "shadow_map", "ids",  "extra",
                                       "list",  "result",     "work", "counts"};
  ASSERT_EQ(shown.size(), names.size());
  for (size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(shown[i].port->name, names[i]);
    EXPECT_EQ(shown[i].binding, i);
  }
}

TEST(Preamble, declares_each_port_with_its_type_format_and_access) {
  const std::string text = preamble(fake(), {});
  expect_contains(text, "layout(set = 1, binding = 0) uniform sampler2D depth;");
  expect_contains(text, "layout(set = 1, binding = 1) uniform sampler2DArray shadow_map;");
  expect_contains(text, "layout(set = 1, binding = 2) uniform usampler2D ids;");
  expect_contains(text, "layout(set = 1, binding = 3) uniform sampler2D extra;");
  expect_contains(text, "layout(set = 1, binding = 4, std430) readonly buffer list_block { uint list[]; };");
  expect_contains(text, "layout(set = 1, binding = 5, r8) uniform writeonly image2D result;");
  expect_contains(text, "layout(set = 1, binding = 6, rg16i) uniform iimage2DArray work;");
  expect_contains(text,
                  "layout(set = 1, binding = 7, std430) writeonly buffer counts_block { uint counts[]; };");
  EXPECT_EQ(text.find("test_depth"), std::string::npos);
  EXPECT_EQ(text.find("target"), std::string::npos);
}

TEST(Preamble, sampled_images_have_accessors_that_read_a_folded_input_at_its_only_texel) {
  const std::string running = preamble(fake(), {});
  expect_contains(running, "vec4 depth_at(ivec2 p) { return texelFetch(depth, p, 0); }");
  expect_contains(running, "uvec4 ids_at(ivec2 p) { return texelFetch(ids, p, 0); }");
  expect_contains(
      running,
      "vec4 shadow_map_at(ivec2 p, int layer) { return texelFetch(shadow_map, ivec3(p, layer), 0); }");
  const std::string folded = preamble(fake(), {{"depth", true}, {"shadow_map", true}, {"ids", false}});
  expect_contains(folded, "depth_at(ivec2 p) { return texelFetch(depth, ivec2(0), 0); }");
  expect_contains(folded, "return texelFetch(shadow_map, ivec3(ivec2(0), 0), 0);");
  expect_contains(folded, "ids_at(ivec2 p) { return texelFetch(ids, p, 0); }");
}

TEST(Preamble, optional_inputs_left_open_are_left_out) {
  expect_contains(preamble(fake(), {}), "#define HAS_EXTRA 1");
  const std::string text = preamble(fake(false), {});
  EXPECT_EQ(text.find("extra"), std::string::npos);
  EXPECT_EQ(text.find("HAS_EXTRA"), std::string::npos);
  expect_contains(text, "binding = 3, std430) readonly buffer list_block");  // numbers close up
}

TEST(Preamble, parameter_block_follows_the_last_port) {
  expect_contains(preamble(fake(), {}),
                  "layout(set = 1, binding = 8, std140) uniform Params {\n  int steps;  // texels\n  float "
                  "epsilon;  // 1\n} params;");
  const Params params = fake().params();
  const auto block = parameter_block(params);
  ASSERT_EQ(block.size(), 8u);
  int32_t steps = 0;
  float epsilon = 0;
  std::memcpy(&steps, block.data(), 4), std::memcpy(&epsilon, block.data() + 4, 4);
  EXPECT_EQ(steps, 7);
  EXPECT_EQ(epsilon, 0.25f);
}

TEST(Preamble, flags_and_choices_are_defines) {
  const Params params = fake().params();
  const Defines defines = parameter_defines(params);
  const Defines expected{{"WIDE", "1"}, {"MODE_FIRST", "0"}, {"MODE_SECOND_WAY", "1"}, {"MODE", "1"}};
  EXPECT_EQ(defines, expected);
  parameter_block(params);
  // Shown to the shaders; whether anyone uses them is another question.
  EXPECT_EQ(params.never_read().size(), params.specs().size());
}

TEST(Preamble, lights_of_one_kind_are_told) {
  std::vector<Light> lights(2);
  EXPECT_EQ(light_kind_text({}), "");
  EXPECT_EQ(light_kind_text(lights), "#define NO_DIRECTIONAL_LIGHTS 1\n");
  lights[1].type = LightType::directional;
  EXPECT_EQ(light_kind_text(lights), "");
  lights[0].type = LightType::directional;
  EXPECT_EQ(light_kind_text(lights), "#define ALL_DIRECTIONAL_LIGHTS 1\n");
}

TEST(Preamble, buffers_that_are_read_have_their_number_of_elements_and_uniform_ones_their_struct) {
  Declaration::Inputs inputs;
  inputs["views"].buffer = BufferShape{3, 144, "LightView", "lib/light_view.glsl"};
  inputs["list"].buffer = BufferShape{100, 4, "uint"};
  Declaration d({}, {}, inputs);
  d.input_buffer("views", Access::uniform, "read as a block");
  d.input_buffer("list", Access::storage_read, "read as a buffer");
  d.output_buffer("written", Access::storage_write, {7, 4, "uint"}, "has no number that a reader needs");
  const std::string text = preamble(d, {});
  expect_contains(text,
                  "#define VIEWS_COUNT 3\n#include \"lib/light_view.glsl\"\n"
                  "layout(set = 1, binding = 0, std140) uniform views_block { LightView views[3]; };");
  expect_contains(text, "#define LIST_COUNT 100\n");
  EXPECT_EQ(text.find("WRITTEN_COUNT"), std::string::npos);
}

TEST(Preamble, without_ports_and_parameters_tells_the_setting_alone) {
  const Declaration d({{64, 32}, 2}, {}, {});
  EXPECT_EQ(preamble(d, {}), "#define LIGHT_COUNT 2\n");
  EXPECT_TRUE(parameter_block(d.params()).empty());
  EXPECT_TRUE(parameter_defines(d.params()).empty());
}

}  // namespace
TEST(Preamble, constants_are_typed_and_declared_once) {
  Declaration d;
  d.constant("TILE", int64_t{16});
  d.constant("LIMIT", 20.0);
  d.constant("TILE", int64_t{16});
  const std::string text = preamble(d, {});
  expect_contains(text, "const int TILE = 16;\n");
  expect_contains(text, "const float LIMIT = 20.0;\n");
  EXPECT_EQ(text.find("TILE"), text.rfind("TILE"));
  EXPECT_THROW(d.constant("TILE", int64_t{8}), Error);
  EXPECT_THROW(d.constant("NAME", std::string("text")), Error);
}

}  // namespace gnomon
