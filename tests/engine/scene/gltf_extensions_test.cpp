// What glTF extensions add to a scene: instances, visibility, texture coordinates, older materials; and what
// is said of the others.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "engine/image/png.h"
#include "engine/scene/animation.h"
#include "engine/scene/surface.h"
#include "tests/engine/scene/gltf_draft.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;
using test::Draft;
using test::error_of;
using test::Folder;
using test::load;
using test::warns;

const std::vector<float> corners = {0, 0, 1, 0, 1, 1, 0, 1};  // u, v of the square's vertices

// The square with a masked material of a 2 x 2 texture, whose first texel alone is opaque.
Draft masked_square() {
  Draft draft;
  const std::vector<uint8_t> texels = {255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 0, 255, 255, 255, 0};
  const size_t view = draft.add_view(png::encode(texels, 2, 2, 4, "mask.png"));
  draft.primitive()["attributes"]["TEXCOORD_0"] = draft.add_floats(corners, "VEC2", 2);
  draft.primitive()["material"] = 0;
  draft.document["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  draft.document["textures"] = {{{"source", 0}}};
  draft.document["materials"] = Json::array(
      {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  return draft;
}

Json& base_texture(Draft& draft) {
  return draft.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
}

// Coordinates of the square's corners, in their order.
std::vector<glm::vec2> coordinates(const Scene& scene) {
  std::vector<glm::vec2> found(4);
  const Mesh& mesh = scene.meshes.at(0);
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    for (size_t k = 0; k < 4; ++k)
      if (mesh.positions[i] == glm::vec3(corners[2 * k], corners[2 * k + 1], 0)) found[k] = mesh.uvs[i];
  return found;
}

TEST(TextureTransform, OffsetScaleAndRotationAreApplied) {
  Draft draft = masked_square();
  base_texture(draft)["extensions"]["KHR_texture_transform"] = {{"offset", {0.125, 0.25}},
                                                                {"scale", {0.5, 2}}};
  const std::vector<glm::vec2> scaled = coordinates(load(draft));
  EXPECT_EQ(scaled[0], glm::vec2(0.125, 0.25));
  EXPECT_EQ(scaled[2], glm::vec2(0.625, 2.25));
  // A quarter turn, counter-clockwise in an image whose rows run down: the extension's own example, which
  // shows the lower left quadrant.
  base_texture(draft)["extensions"]["KHR_texture_transform"] = {
      {"offset", {0, 1}}, {"rotation", glm::half_pi<double>()}, {"scale", {0.5, 0.5}}};
  const std::vector<glm::vec2> turned = coordinates(load(draft));
  const glm::vec2 expected[] = {{0, 1}, {0, 0.5}, {0.5, 0.5}, {0.5, 1}};
  for (size_t k = 0; k < 4; ++k) EXPECT_LT(glm::distance(turned[k], expected[k]), 1e-6f) << k;
  EXPECT_FALSE(warns(load(draft), "KHR_texture_transform"));
}

TEST(TextureTransform, ASecondSetOfCoordinatesIsRead) {
  Draft draft = masked_square();
  draft.primitive()["attributes"]["TEXCOORD_1"] =
      draft.add_floats({0.25, 0.75, 0.25, 0.75, 0.25, 0.75, 0.25, 0.75}, "VEC2", 2);
  base_texture(draft)["texCoord"] = 1;
  for (const glm::vec2& uv : coordinates(load(draft))) EXPECT_EQ(uv, glm::vec2(0.25, 0.75));
  // The transform's own set overrides the texture's.
  base_texture(draft)["extensions"]["KHR_texture_transform"] = {{"texCoord", 0}};
  EXPECT_EQ(coordinates(load(draft))[2], glm::vec2(1, 1));
  base_texture(draft) = {{"index", 0}, {"texCoord", 3}};
  EXPECT_TRUE(warns(load(draft), "TEXCOORD_3"));
}

TEST(TextureWrap, MirroredRepeatTurnsEverySecondCopy) {
  Draft draft = masked_square();
  draft.document["samplers"] = {{{"wrapS", 33648}, {"wrapT", 33071}, {"magFilter", 9728}}};
  draft.document["textures"][0]["sampler"] = 0;
  Scene scene = load(draft);
  EXPECT_EQ(scene.textures[0].wrap_u, Wrap::mirror);
  EXPECT_EQ(scene.textures[0].wrap_v, Wrap::clamp);
  // Column 0 is opaque, column 1 not: along u the columns are 0 1 | 1 0 | 0 1, and 1 0 below 0.
  Mesh& mesh = scene.meshes[0];
  const bool opaque[] = {false, true, true, false, false, true, true, false};
  for (int i = 0; i < 8; ++i) {
    mesh.uvs.assign(mesh.uvs.size(), {-1 + 0.25f + 0.5f * float(i), 0.25f});
    EXPECT_EQ(base_alpha(scene, mesh, 0, {1, 0, 0}) > 0.5f, opaque[i]) << i;
    EXPECT_EQ(base_color(scene, mesh, 0, {1, 0, 0}).r > 0.5f, opaque[i]) << i;
  }
  // Filtered: an edge of the texture is its own neighbour.
  scene.textures[0].nearest = false;
  mesh.uvs.assign(mesh.uvs.size(), {2.0f, 0.0f});
  EXPECT_FLOAT_EQ(base_alpha(scene, mesh, 0, {1, 0, 0}), 1.0f);
}

TEST(SpecularGlossiness, DiffuseColourAndAlphaAreTheBaseColour) {
  Draft draft = masked_square();
  draft.document["materials"][0] = {
      {"alphaMode", "MASK"},
      {"extensions",
       {{"KHR_materials_pbrSpecularGlossiness",
         {{"diffuseFactor", {1.0, 0.5, 0.25, 0.75}}, {"diffuseTexture", {{"index", 0}}}}}}}};
  draft.document["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  const Scene scene = load(draft);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1.0f, 0.5f, 0.25f, 0.75f));
  ASSERT_TRUE(scene.materials[0].base_color_texture.has_value());
  EXPECT_EQ(scene.textures[0].rgba[3], 255);
  EXPECT_EQ(coordinates(scene)[2], glm::vec2(1, 1));
  EXPECT_FALSE(warns(scene, "pbrSpecularGlossiness"));
}

TEST(GpuInstancing, EveryInstanceIsPlaced) {
  Draft draft;
  const float half = std::sqrt(0.5f);
  draft.document["nodes"][0]["translation"] = {10, 0, 0};
  draft.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", draft.add_floats({0, 0, 0, 0, 1, 0, 0, 2, 0}, "VEC3", 3)},
      {"ROTATION", draft.add_floats({0, 0, 0, 1, 0, 0, half, half, 0, 0, 0, 1}, "VEC4", 4)},
      {"SCALE", draft.add_floats({1, 1, 1, 2, 2, 2, -1, 1, 1}, "VEC3", 3)}};
  draft.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = load(draft);
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.meshes.size(), 2u);  // the last one mirrors
  EXPECT_EQ(scene.triangles(), 6u);
  const glm::dvec4 corner(1, 0, 0, 1);
  const auto placed = [&](size_t i) { return glm::dvec3(scene.instances[i].world_from_object * corner); };
  EXPECT_EQ(placed(0), glm::dvec3(11, 0, 0));
  EXPECT_LT(glm::distance(placed(1), glm::dvec3(10, 3, 0)), 1e-6);
  EXPECT_NEAR(scene.bounds.min.x, 8, 1e-6);  // the second, turned, reaches from 8 to 10; the third from 9
  EXPECT_GT(glm::determinant(glm::dmat3(scene.instances[2].world_from_object)), 0);
}

TEST(GpuInstancing, BrokenAttributesAreErrors) {
  Draft draft;
  Json& extension = draft.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"];
  extension["attributes"] = {{"_ID", 0}};
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("how many instances"), std::string::npos);
  extension["attributes"] = {{"TRANSLATION", draft.add_floats({0, 0, 0, 1, 1, 1}, "VEC3", 3)},
                             {"SCALE", draft.add_floats({1, 1, 1}, "VEC3", 3)}};
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("1 values for 2 instances"), std::string::npos);
  extension["attributes"] = {{"TRANSLATION", 99}};
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("no accessor 99"), std::string::npos);
}

TEST(NodeVisibility, HidesMeshesAndLightsBelowButNoCamera) {
  Draft draft;
  draft.document["nodes"] = Json::parse(R"([
    {"mesh":0},
    {"children":[2,3,4],"extensions":{"KHR_node_visibility":{"visible":false}}},
    {"mesh":0,"extensions":{"KHR_node_visibility":{"visible":true}}},
    {"camera":0},
    {"extensions":{"KHR_lights_punctual":{"light":0}}}])");
  draft.document["cameras"] = Json::parse(R"([{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])");
  draft.document["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type":"point"}])");
  draft.document["scenes"][0]["nodes"] = {0, 1};
  draft.document["extensionsUsed"] = {"KHR_node_visibility"};
  const Scene scene = load(draft);
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(warns(scene, "no light"));
  EXPECT_FALSE(warns(scene, "no camera, a default one"));
  EXPECT_FALSE(warns(scene, "KHR_node_visibility"));
  draft.document["scenes"][0]["nodes"] = {1};
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("hidden by KHR_node_visibility"), std::string::npos);
}

TEST(Extensions, OneLineEachForWhatIsIgnored) {
  Draft draft;
  draft.document["extensionsUsed"] = {"KHR_materials_unlit", "KHR_materials_transmission", "EXT_unheard_of",
                                      "KHR_mesh_quantization"};
  draft.document["extensionsRequired"] = {"KHR_materials_unlit"};
  const Scene scene = load(draft);
  EXPECT_TRUE(warns(scene, "'KHR_materials_unlit' is ignored: a surface's look; shadows stay the same"));
  EXPECT_TRUE(warns(scene, "'KHR_materials_transmission' is ignored: light that passes"));
  EXPECT_TRUE(warns(scene, "/extensionsUsed/2: extension 'EXT_unheard_of' is not known"));
  EXPECT_FALSE(warns(scene, "KHR_mesh_quantization"));
  size_t lines = 0;
  for (const std::string& message : scene.warnings.messages)
    lines += message.find("unlit") != std::string::npos;
  EXPECT_EQ(lines, 1u);
}

TEST(Extensions, AnImageThatCannotBeReadIsRefusedWhereItDecidesCoverage) {
  Draft draft = masked_square();
  draft.document["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  draft.document["extensionsRequired"] = {"KHR_texture_basisu"};
  const std::string error = error_of("a.glb", draft.bytes());
  EXPECT_NE(error.find("/textures/0: the mask is an image of KHR_texture_basisu"), std::string::npos)
      << error;
  draft.document["materials"][0]["alphaMode"] = "OPAQUE";
  EXPECT_TRUE(warns(load(draft), "images of KHR_texture_basisu are not read"));
  // With a fallback there is nothing to refuse.
  draft.document["materials"][0]["alphaMode"] = "MASK";
  draft.document["textures"][0]["source"] = 0;
  EXPECT_EQ(load(draft).textures.size(), 1u);
}

}  // namespace
}  // namespace gnomon
