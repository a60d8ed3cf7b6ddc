// Small glTF files, each with some of what the loader reads; packed by the libraries' own encoders.
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <memory>

#include "engine/image/png.h"
#include "tests/engine/scene/gltf_packed.h"
#include "tests/fuzz/seeds.h"
#include "tools/scene_generate.h"

namespace gnomon::fuzz {
namespace {

using Json = nlohmann::json;
using test::draco_square;
using test::Draft;
using test::packed_square;
using test::packed_vertices;
using test::raw;
using test::square;

const std::vector<uint8_t> kTexels = {255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 128, 9, 8, 7, 255};  // 2 x 2
const std::vector<float> kCorners = {0, 0, 1, 0, 1, 1, 0, 1};  // u, v of the square's vertices

size_t add_accessor(Draft& draft, const std::string& bytes, int component, size_t count, const char* type) {
  const size_t view = draft.add_view(bytes);
  draft.document["accessors"].push_back(
      {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  return draft.document["accessors"].size() - 1;
}

void animate(Draft& draft, const Json& target, const std::vector<float>& values, const std::string& type,
             size_t components, const char* interpolation = "LINEAR") {
  draft.document["animations"].push_back({{"channels", {{{"sampler", 0}, {"target", target}}}},
                                          {"samplers",
                                           {{{"input", draft.add_floats({0, 1}, "SCALAR", 1)},
                                             {"output", draft.add_floats(values, type, components)},
                                             {"interpolation", interpolation}}}}});
}

Json pointer(const std::string& to) {
  return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", to}}}}}};
}

// A masked texture with all that changes its coordinates, and colours of vertices.
Draft material() {
  Draft draft;
  const size_t view = draft.add_view(png::encode(kTexels, 2, 2, 4, "mask.png"));
  Json& attributes = draft.primitive()["attributes"];
  attributes["TEXCOORD_0"] = draft.add_floats(kCorners, "VEC2", 2);
  attributes["TEXCOORD_1"] = add_accessor(draft, raw<uint8_t>({0, 0, 9, 0, 9, 9, 0, 9}), 5121, 4, "VEC2");
  draft.document["accessors"].back()["normalized"] = true;
  attributes["COLOR_0"] = draft.add_floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC3", 3);
  draft.primitive()["material"] = 0;
  draft.document["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}, {"name", "mask"}}};
  draft.document["samplers"] = {{{"wrapS", 33648}, {"wrapT", 33071}, {"magFilter", 9728}}};
  draft.document["textures"] = {{{"source", 0}, {"sampler", 0}}};
  draft.document["materials"] = Json::parse(R"([{"alphaMode":"MASK","alphaCutoff":0.4,"doubleSided":true,
    "pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.2,1],"baseColorTexture":{"index":0,"texCoord":1,
      "extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.5,"scale":[0.5,2],"texCoord":0}}}}},
    {"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[1,1,0,1],
      "diffuseTexture":{"index":0}}}}])");
  draft.document["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_pbrSpecularGlossiness",
                                      "KHR_materials_unlit"};
  return draft;
}

Draft webp() {
  uint8_t* encoded = nullptr;
  const size_t size = WebPEncodeLosslessRGBA(kTexels.data(), 2, 2, 8, &encoded);
  const std::unique_ptr<uint8_t, void (*)(void*)> owner(encoded, WebPFree);
  Draft draft = material();
  draft.document["images"].push_back(
      {{"bufferView", draft.add_view({reinterpret_cast<const char*>(encoded), size})},
       {"mimeType", "image/webp"}});
  draft.document["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  return draft;
}

// Joints, morph targets and all that an animation can reach.
Draft animated() {
  Draft draft;
  draft.document["nodes"] = Json::parse(R"([
    {"mesh":0,"skin":0,"weights":[0.5]},{"translation":[0,1,0],"children":[2,3,4]},{"translation":[1,0,0]},
    {"camera":0,"rotation":[0,0,0,1]},{"extensions":{"KHR_lights_punctual":{"light":0},
      "KHR_node_visibility":{"visible":true}}}])");
  draft.document["scenes"][0]["nodes"] = {0, 1};
  draft.document["cameras"] = Json::parse(R"([{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])");
  draft.document["extensions"]["KHR_lights_punctual"]["lights"] =
      Json::parse(R"([{"type":"point","intensity":8,"color":[1,1,0.5],"range":40}])");
  draft.document["materials"] = Json::parse(R"([{"alphaMode":"MASK"}])");
  draft.primitive()["material"] = 0;
  Json& attributes = draft.primitive()["attributes"];
  attributes["NORMAL"] = draft.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  attributes["JOINTS_0"] =
      add_accessor(draft, raw<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}), 5121, 4, "VEC4");
  attributes["WEIGHTS_0"] = draft.add_floats({1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
  draft.document["skins"] = {
      {{"joints", {1, 2}},
       {"skeleton", 1},
       {"inverseBindMatrices",
        add_accessor(draft, raw<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}),
                     5126, 2, "MAT4")}}};
  draft.primitive()["targets"] = {
      {{"POSITION", draft.add_floats({0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0}, "VEC3", 3)}}};
  draft.document["meshes"][0]["weights"] = {0.5};
  animate(draft, {{"node", 0}, {"path", "weights"}}, {0, 1}, "SCALAR", 1);
  animate(draft, {{"node", 2}, {"path", "rotation"}}, {0, 0, 0, 1, 0, 0, 1, 0}, "VEC4", 4);
  animate(draft, {{"node", 1}, {"path", "translation"}},
          {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0}, "VEC3", 3, "CUBICSPLINE");
  animate(draft, {{"node", 1}, {"path", "scale"}}, {1, 1, 1, 0, 2, 1}, "VEC3", 3, "STEP");
  animate(draft, pointer("/nodes/4/extensions/KHR_node_visibility/visible"), {1, 0}, "SCALAR", 1, "STEP");
  animate(draft, pointer("/extensions/KHR_lights_punctual/lights/0/intensity"), {1, 4}, "SCALAR", 1);
  animate(draft, pointer("/materials/0/pbrMetallicRoughness/baseColorFactor"), {1, 1, 1, 1, 0, 0, 1, 1},
          "VEC4", 4);
  animate(draft, pointer("/materials/0/alphaCutoff"), {0, 1}, "SCALAR", 1);
  draft.document["extensionsUsed"] = {"KHR_animation_pointer", "KHR_node_visibility", "KHR_lights_punctual"};
  return draft;
}

// Lights of every kind and shape, cameras of both, and instances.
Draft lights() {
  Draft draft;
  draft.document["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([
    {"type":"spot","intensity":20,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.6}},
    {"type":"point","range":9},{"type":"directional","color":[1,1,0.9]}])");
  draft.document["extensions"]["EXT_lights_area"]["lights"] = Json::parse(R"([
    {"type":"area","shape":"rect","width":0.5,"height":1},{"type":"area","shape":"disk","width":0.5}])");
  draft.document["nodes"] = Json::parse(R"([
    {"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,3,0,0,1]},
    {"translation":[0,0,4],"extensions":{"KHR_lights_punctual":{"light":0}},
      "extras":{"light":{"fovy_deg":60},"area_light":{"shape":"rectangle","width":1.6,"height":0.8}}},
    {"translation":[0,0,5],"extensions":{"KHR_lights_punctual":{"light":0}},
      "extras":{"area_light":{"shape":"polygon","outline":[[-0.7,-0.5],[0.7,-0.5],[0,0.7]]}}},
    {"translation":[2,0,4],"extensions":{"KHR_lights_punctual":{"light":1}},
      "extras":{"area_light":{"radius":0.2}}},
    {"extensions":{"KHR_lights_punctual":{"light":2}},"extras":{"area_light":{"angular_diameter":0.53}}},
    {"translation":[1,0,6],"extensions":{"EXT_lights_area":{"light":0}}},
    {"translation":[0,0,9],"camera":0},{"translation":[0,0,9],"camera":1},
    {"scale":[2,2,2],"rotation":[0,0.6,0,0.8],"mesh":0}])");
  draft.document["nodes"][8]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", draft.add_floats({0, 0, 0, 0, 1, 0, 0, 2, 0}, "VEC3", 3)},
      {"ROTATION", draft.add_floats({0, 0, 0, 1, 0, 0, 0.6f, 0.8f, 0, 0, 0, 1}, "VEC4", 4)},
      {"SCALE", draft.add_floats({1, 1, 1, 2, 2, 2, -1, 1, 1}, "VEC3", 3)}};
  draft.document["cameras"] = Json::parse(R"([
    {"type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"zfar":50,"aspectRatio":1.5}},
    {"type":"orthographic","orthographic":{"xmag":2,"ymag":1,"znear":0,"zfar":20}}])");
  draft.document["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  draft.document["scenes"][0]["extras"] = {{"area_light", {{"shape", "disc"}, {"radius", 0.6}}}};
  draft.document["extensionsUsed"] = {"KHR_lights_punctual", "EXT_lights_area", "EXT_mesh_gpu_instancing"};
  return draft;
}

// Accessors of every kind: sparse, normalised, with a stride, without a view; strips and fans.
Draft accessors() {
  Draft draft;
  draft.document["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", draft.add_view(raw<uint16_t>({1}))}, {"componentType", 5123}}},
      {"values", {{"bufferView", draft.add_view(raw<float>({2, 0, 0}))}}}};
  draft.primitive()["attributes"]["NORMAL"] = add_accessor(
      draft, raw<int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}), 5120, 4, "VEC3");
  draft.document["accessors"].back()["normalized"] = true;
  draft.document["bufferViews"].back()["byteStride"] = 4;
  const size_t whole =
      add_accessor(draft, raw<int16_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0}), 5122, 4, "VEC3");
  draft.document["bufferViews"].back()["byteStride"] = 8;
  const size_t order = add_accessor(draft, raw<uint32_t>({0, 1, 3, 2}), 5125, 4, "SCALAR");
  Json& primitives = draft.document["meshes"][0]["primitives"];
  primitives.push_back({{"attributes", {{"POSITION", whole}}}, {"indices", order}, {"mode", 5}});
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 6}});
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  draft.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  return draft;
}

// With a filter where the indices are a sequence.
Draft meshopt(const char* name, bool sequence) {
  if (!sequence) return packed_square(name);
  std::vector<float> bits = square;
  meshopt_encodeFilterExp(bits.data(), 4, 12, 20, square.data());
  Draft draft = packed_square(name, true, packed_vertices(bits.data(), 4, 12));
  draft.document["bufferViews"][0]["extensions"][name]["filter"] = "EXPONENTIAL";
  return draft;
}

// A document without a container, its buffer in a data URI.
std::string text_document() {
  Draft draft;
  draft.document["buffers"][0]["uri"] =
      "data:application/octet-stream;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA";
  return draft.document.dump();
}

}  // namespace

Seeds scene_seeds() {
  Seeds all = {{"square", Draft{}.bytes()},
               {"material", material().bytes()},
               {"webp", webp().bytes()},
               {"animated", animated().bytes()},
               {"lights", lights().bytes()},
               {"accessors", accessors().bytes()},
               {"meshopt", meshopt("EXT_meshopt_compression", false).bytes()},
               {"meshopt_sequence", meshopt("KHR_meshopt_compression", true).bytes()},
               {"draco", draco_square().bytes()},
               {"text", text_document()}};
  for (const char* name : {"square_plane", "area_shapes", "sun_and_lamp", "pendulum"})
    all[name] = scene_bytes(name);
  return all;
}

}  // namespace gnomon::fuzz
