// Loading scenes: what is read, and every kind of broken file.
#include "engine/scene/scene.h"
#include "engine/base/resource_root.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/scene/mesh_clean.h"
#include "tests/engine/scene/gltf_draft.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;

using test::Draft;
using test::error_of;
using test::Folder;
using test::glb;
using test::load;
using test::raw;
using test::square;
using test::square_indices;
using test::warns;

TEST(SceneLoad, SquareGetsFlatNormalsDefaultCameraAndLight) {
  const Scene scene = load(Draft{});
  EXPECT_EQ(scene.name, "draft");
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.triangles(), 2u);
  EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());
  for (const glm::vec3& n : mesh.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.bounds.min, glm::dvec3(0, 0, 0));
  EXPECT_EQ(scene.bounds.max, glm::dvec3(1, 1, 0));
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_TRUE(warns(scene, "no camera, a default one"));
  EXPECT_TRUE(warns(scene, "no light"));
}

// Both default views hold every corner of the scene's box.
TEST(SceneLoad, DefaultCameraAndLightFrameTheScene) {
  const Scene scene = load(Draft{});
  const auto inside = [&](const glm::dmat4& placed, double tangent) {
    for (const glm::vec3& p : scene.meshes[0].positions) {
      const glm::dvec3 v(glm::inverse(placed) * glm::dvec4(glm::dvec3(p), 1.0));
      EXPECT_LT(std::max(std::abs(v.x), std::abs(v.y)), -v.z * tangent);
    }
  };
  inside(scene.cameras[0].world_from_camera, std::tan(0.5 * scene.cameras[0].fov_y));
  inside(scene.lights[0].world_from_light, std::tan(0.5 * scene.lights[0].map_fov));
}

TEST(SceneLoad, BadInputNamesFileAndPlace) {
  struct Case {
    const char* patch;  // JSON patch (RFC 6902) on the draft
    std::vector<std::string> parts;
  };
  const Case cases[] = {
      {R"([{"op":"replace","path":"/asset/version","value":"1.0"}])", {"version", "/asset/version"}},
      {R"([{"op":"remove","path":"/asset"}])", {"not a glTF file"}},
      {R"([{"op":"replace","path":"/meshes/0/primitives/0/indices","value":7}])", {"accessor"}},
      {R"([{"op":"replace","path":"/meshes/0/primitives/0/attributes/POSITION","value":9}])",
       {"no accessor 9", "/meshes/0/primitives/0/attributes/POSITION"}},
      {R"([{"op":"replace","path":"/accessors/0/count","value":5}])",
       {"do not fit", "/meshes/0/primitives/0/attributes/POSITION"}},
      {R"([{"op":"replace","path":"/accessors/0/count","value":3}])",
       {"index 3", "/meshes/0/primitives/0/indices"}},
      {R"([{"op":"replace","path":"/accessors/1/count","value":4000000000}])",
       {"do not fit", "/meshes/0/primitives/0/indices"}},
      {R"([{"op":"add","path":"/accessors/0/byteOffset","value":4}])", {"do not fit"}},
      {R"([{"op":"replace","path":"/accessors/0/type","value":"VEC2"}])", {"components"}},
      {R"([{"op":"replace","path":"/accessors/1/componentType","value":5126}])", {"unsigned scalars"}},
      {R"([{"op":"replace","path":"/bufferViews/0/byteLength","value":61}])",
       {"not inside buffer 0", "/bufferViews/0"}},
      {R"([{"op":"replace","path":"/bufferViews/1/byteOffset","value":-4}])",
       {"whole number", "/bufferViews/1/byteOffset"}},
      {R"([{"op":"replace","path":"/bufferViews/1/buffer","value":2}])",
       {"no buffer 2", "/bufferViews/1/buffer"}},
      {R"([{"op":"replace","path":"/buffers/0/byteLength","value":64000}])", {"byteLength"}},
      {R"([{"op":"replace","path":"/buffers/0/byteLength","value":0}])",
       {"0 bytes", "/buffers/0/byteLength"}},
      {R"([{"op":"add","path":"/buffers/0/uri","value":"gone.bin"}])",
       {"'gone.bin'", "no such file", "/buffers/0/uri"}},
      {R"([{"op":"replace","path":"/nodes/0/mesh","value":3}])", {"no mesh 3", "/nodes/0/mesh"}},
      {R"([{"op":"remove","path":"/nodes/0/mesh"}])", {"no triangles"}},
      {R"([{"op":"add","path":"/nodes/0/children","value":[0]}])", {"not a tree", "/nodes/0"}},
      {R"([{"op":"add","path":"/nodes/0/children","value":[5]}])", {"no node 5", "/nodes/0/children"}},
      {R"([{"op":"add","path":"/nodes/0/translation","value":[1,2]}])",
       {"3 numbers", "/nodes/0/translation"}},
      {R"([{"op":"add","path":"/nodes/0/scale","value":[1,1e300,1]}])", {"not finite", "/nodes/0/scale"}},
      {R"([{"op":"replace","path":"/scene","value":4}])", {"no scene 4", "/scene"}},
      {R"([{"op":"add","path":"/meshes/0/primitives/0/mode","value":9}])",
       {"mode 9", "/meshes/0/primitives/0/mode"}},
      {R"([{"op":"add","path":"/meshes/0/primitives/0/material","value":1}])",
       {"no material 1", "/meshes/0/primitives/0/material"}},
      {R"([{"op":"add","path":"/meshes/0/primitives/0/attributes/NORMAL","value":1}])",
       {"/attributes/NORMAL"}},
      {R"([{"op":"add","path":"/extensionsRequired","value":["EXT_unheard_of"]}])",
       {"EXT_unheard_of", "/extensionsRequired/0"}},
      {R"([{"op":"add","path":"/asset/minVersion","value":"2.1"}])", {"2.1", "/asset/minVersion"}},
      {R"([{"op":"add","path":"/nodes/0/camera","value":0}])", {"no camera 0", "/nodes/0/camera"}},
      {R"([{"op":"add","path":"/nodes/0/extensions","value":{"KHR_lights_punctual":{"light":0}}}])",
       {"no light 0"}},
      {R"([{"op":"replace","path":"/meshes","value":{}}])", {"array", "/meshes"}},
      {R"([{"op":"replace","path":"/nodes/0","value":3}])", {"object", "/nodes/0"}},
  };
  for (const Case& c : cases) {
    Draft draft;
    draft.document = draft.document.patch(Json::parse(c.patch));
    const std::string message = error_of("bad.glb", draft.bytes());
    EXPECT_NE(message.find("bad.glb"), std::string::npos) << c.patch << "\n" << message;
    for (const std::string& part : c.parts)
      EXPECT_NE(message.find(part), std::string::npos) << c.patch << "\n" << message;
  }
}

TEST(SceneLoad, BrokenContainersAreErrors) {
  const std::string good = Draft{}.bytes();
  EXPECT_NE(error_of("a.glb", "").find("empty"), std::string::npos);
  EXPECT_NE(error_of("a.glb", "hello").find("not a glTF file"), std::string::npos);
  EXPECT_NE(error_of("a.glb", good.substr(0, 15)).find("header"), std::string::npos);
  EXPECT_NE(error_of("a.glb", good.substr(0, good.size() - 4)).find("truncated"), std::string::npos);
  std::string longer = good;  // a binary chunk that claims 8 bytes more than there are
  const size_t at = good.find("BIN");
  longer[at - 4] = static_cast<char>(longer[at - 4] + 8);
  EXPECT_NE(error_of("a.glb", longer).find("binary chunk"), std::string::npos);
  std::string deep =
      R"({"asset":{"version":"2.0","extras":)" + std::string(100000, '[') + std::string(100000, ']') + "}}";
  EXPECT_NE(error_of("deep.gltf", deep).find("nested"), std::string::npos);
  try {
    load_scene("/nowhere/missing.glb");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("missing.glb"), std::string::npos);
  }
}

TEST(SceneLoad, BadTrianglesAreDroppedAndCounted) {
  Draft draft;
  std::vector<float> positions = square;
  positions[9] = std::numeric_limits<float>::quiet_NaN();
  draft.data = raw(positions) + raw(std::vector<uint16_t>{0, 1, 2, 0, 2, 3});
  Scene scene = load(draft);
  EXPECT_EQ(scene.warnings.nonfinite_triangles, 1u);
  EXPECT_EQ(scene.triangles(), 1u);
  for (const glm::vec3& p : scene.meshes[0].positions) EXPECT_TRUE(std::isfinite(p.x));
  draft.data = raw(square) + raw(std::vector<uint16_t>{0, 1, 2, 0, 0, 3});
  scene = load(draft);
  EXPECT_EQ(scene.warnings.degenerate_triangles, 1u);
  EXPECT_EQ(scene.triangles(), 1u);
  positions = {0, 0, 0, 1, 1, 1, 3, 3, 3, 0, 1, 0};  // the first three are collinear
  draft.data = raw(positions) + raw(square_indices);
  EXPECT_EQ(load(draft).warnings.degenerate_triangles, 1u);
}

TEST(SceneLoad, StripsFansAndListsAgree) {
  const auto normals = [](int mode, const std::vector<uint16_t>& indices) {
    Draft draft;
    draft.document["meshes"][0]["primitives"][0]["mode"] = mode;
    draft.document["accessors"][1]["count"] = indices.size();
    draft.data = raw(square) + raw(indices);
    draft.data.resize(60, '\0');
    const Scene scene = load(draft);
    EXPECT_EQ(scene.triangles(), 2u);
    for (const glm::vec3& n : scene.meshes[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1)) << mode;
  };
  normals(4, {0, 1, 2, 0, 2, 3});
  normals(5, {0, 1, 3, 2});
  normals(6, {0, 1, 2, 3});
}

TEST(SceneLoad, NonIndexedTriangles) {
  Draft draft;
  draft.document["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_EQ(load(draft).triangles(), 1u);  // 4 vertices: one whole triangle
  EXPECT_TRUE(warns(load(draft), "not whole triangles"));
}

TEST(SceneLoad, MirroringTransformsKeepTheFrontOutside) {
  Draft draft;
  draft.document["nodes"][0]["scale"] = {-2.0, 1.0, 1.0};
  const Scene scene = load(draft);
  const Instance& instance = scene.instances[0];
  EXPECT_GT(glm::determinant(glm::dmat3(instance.world_from_object)), 0.0);
  EXPECT_EQ(scene.bounds.min, glm::dvec3(-2, 0, 0));
  EXPECT_EQ(scene.bounds.max, glm::dvec3(0, 1, 0));
  const Mesh& mesh = scene.meshes[instance.mesh];
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto world = [&](size_t k) {
      return glm::dvec3(instance.world_from_object *
                        glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[i + k]]), 1.0));
    };
    EXPECT_GT(glm::cross(world(1) - world(0), world(2) - world(0)).z, 0.0);
  }
}

TEST(SceneLoad, FlatteningTransformsAreBaked) {
  Draft draft;
  draft.document["nodes"][0]["scale"] = {1.0, 1.0, 0.0};
  draft.document["nodes"][0]["translation"] = {0.0, 0.0, 5.0};
  const Scene scene = load(draft);
  EXPECT_EQ(scene.triangles(), 2u);
  EXPECT_EQ(scene.bounds.max, glm::dvec3(1, 1, 5));
  EXPECT_NEAR(glm::determinant(glm::dmat3(scene.instances[0].world_from_object)), 1.0, 1e-15);
  draft.document["nodes"][0]["scale"] = {1.0, 0.0, 1.0};
  EXPECT_NE(error_of("flat.glb", draft.bytes()).find("no triangles"), std::string::npos);
}

TEST(SceneLoad, TransformsAreDoubleAlongTheTree) {
  Draft draft;
  draft.document["nodes"] = Json::parse(R"([{"translation":[6400000.25,0,0],"children":[1]},
    {"mesh":0,"translation":[0.0625,0,0],"rotation":[0,0,0.7071067811865476,0.7071067811865476]}])");
  const Scene scene = load(draft);
  EXPECT_EQ(scene.instances[0].world_from_object[3].x, 6400000.3125);
  EXPECT_NEAR(scene.bounds.min.x, 6400000.3125 - 1, 1e-9);  // a quarter turn: (0, 1) -> (-1, 0)
}

TEST(SceneLoad, CamerasAndLights) {
  Draft draft;
  draft.document.merge_patch(Json::parse(R"({
    "cameras":[{"type":"perspective","perspective":{"yfov":0.9,"znear":0.25,"aspectRatio":2}},
               {"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0.1,"zfar":10}}],
    "extensions":{"KHR_lights_punctual":{"lights":[
      {"type":"point","name":"lamp","color":[1,0.5,0.25],"intensity":7},
      {"type":"spot","spot":{"innerConeAngle":0.2,"outerConeAngle":0.5},"range":30},
      {"type":"directional","intensity":3},
      {"type":"spot","spot":{"outerConeAngle":1.5}}]}},
    "scenes":[{"nodes":[0,1,2,3,4,5,6],"extras":{"area_light":{"width":2,"height":3},"light":{"fovy_deg":50}}}],
    "nodes":[{"mesh":0},{"camera":0,"translation":[0,0,9],"scale":[3,3,3]},{"camera":1},
      {"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[1,2,3]},
      {"extensions":{"KHR_lights_punctual":{"light":1}}},
      {"extensions":{"KHR_lights_punctual":{"light":2}},"extras":{"area_light":{"width":-1,"height":1}}},
      {"extensions":{"KHR_lights_punctual":{"light":3}}}]})"));
  const Scene scene = load(draft);
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[1].span, glm::dvec2(1, 1));
  EXPECT_EQ(scene.cameras[1].far, 10);
  EXPECT_EQ(scene.cameras[0].fov_y, 0.9);
  EXPECT_EQ(scene.cameras[0].near, 0.25);
  EXPECT_EQ(scene.cameras[0].aspect, 2.0);
  EXPECT_NEAR(glm::determinant(glm::dmat3(scene.cameras[0].world_from_camera)), 1.0, 1e-12);
  EXPECT_FALSE(warns(scene, "orthographic"));
  ASSERT_EQ(scene.lights.size(), 4u);
  EXPECT_EQ(scene.lights[0].type, LightType::point);
  EXPECT_EQ(scene.lights[0].color, glm::dvec3(1, 0.5, 0.25));
  EXPECT_FALSE(scene.lights[0].area.has_value());
  ASSERT_TRUE(scene.lights[1].area.has_value());  // the scene's, for the first spot
  EXPECT_EQ(*scene.lights[1].area, (AreaLight{AreaLight::Shape::rectangle, 2, 3, {}, {}}));
  EXPECT_EQ(scene.lights[1].range, 30.0);
  EXPECT_NEAR(scene.lights[1].map_fov, 50.0 / 180 * 3.14159265358979,
              1e-12);  // the scene's, for the first spot
  EXPECT_EQ(scene.lights[2].type, LightType::directional);
  EXPECT_FALSE(scene.lights[2].area.has_value());
  EXPECT_TRUE(warns(scene, "/nodes/5/extras/area_light: a directional light needs an angular_diameter"));
  EXPECT_LT(scene.lights[3].map_fov, 170.0 / 180 * 3.14159265358979);
}

TEST(SceneLoad, MaterialsVertexColoursAndSparseAccessors) {
  Draft draft;
  draft.document.merge_patch(Json::parse(R"({
    "materials":[{"doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.75],
                  "baseColorTexture":{"index":0}}}],
    "textures":[{"source":0}],"images":[{"uri":"none.png"}]})"));
  Json& primitive = draft.document["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["attributes"]["COLOR_0"] = 2;
  draft.document["accessors"].push_back(
      {{"bufferView", 2}, {"componentType", 5121}, {"normalized", true}, {"count", 4}, {"type", "VEC4"}});
  draft.document["accessors"][0]["sparse"] = Json::parse(
      R"({"count":1,"indices":{"bufferView":3,"componentType":5121},"values":{"bufferView":0,"byteOffset":24}})");
  draft.document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 16}});
  draft.document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 76}, {"byteLength", 1}});
  draft.document["buffers"][0]["byteLength"] = 77;
  draft.data += std::string(16, '\x33') + std::string(1, '\x01');  // vertex 1 becomes vertex 2's (1, 1, 0)
  const Scene scene = load(draft);
  const Material& material = scene.materials[scene.meshes[0].material];
  EXPECT_TRUE(material.double_sided);
  EXPECT_TRUE(material.alpha_masked);
  EXPECT_EQ(material.alpha_cutoff, 0.25f);
  EXPECT_EQ(material.base_color, glm::vec4(0.5f, 0.25f, 1.0f, 0.75f));
  EXPECT_FALSE(material.base_color_texture.has_value());
  EXPECT_TRUE(warns(scene, "none.png"));
  ASSERT_FALSE(scene.meshes[0].colors.empty());
  EXPECT_EQ(scene.meshes[0].colors[0], glm::vec4(0.2f));
  EXPECT_EQ(scene.warnings.degenerate_triangles, 1u);
}

TEST(SceneLoad, LightInsideASolidIsTold) {
  const std::filesystem::path file = resource_root() / "assets/scenes/sphere_plane.glb";
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::string old = R"("translation":[2.0,10.0,-1.0])", fresh = R"("translation":[0.0,2.50,0.20])";
  ASSERT_EQ(old.size(), fresh.size());
  const size_t place = bytes.find(old);
  ASSERT_NE(place, std::string::npos);
  bytes.replace(place, old.size(), fresh);
  const Folder folder;
  EXPECT_TRUE(warns(load_scene(folder.write("inside.glb", bytes)), "is inside 'sphere'"));
}

TEST(MeshClean, WatertightNeedsTwoOppositeHalfEdges) {
  const std::vector<glm::vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  EXPECT_TRUE(is_watertight(p, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}));
  EXPECT_TRUE(is_watertight(p, {4, 2, 1, 0, 1, 3, 4, 3, 2, 1, 2, 3}));            // vertex 4 repeats vertex 0
  EXPECT_FALSE(is_watertight(p, {0, 2, 1, 0, 1, 3, 0, 3, 2}));                    // a hole
  EXPECT_FALSE(is_watertight(p, {0, 1, 2, 0, 1, 3, 0, 3, 2, 1, 2, 3}));           // one face turned
  EXPECT_FALSE(is_watertight(p, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 0, 2, 1}));  // an edge of three faces
  EXPECT_FALSE(is_watertight(p, {}));
}

// Deterministic mutations of whole files: bytes changed, cut, and JSON numbers replaced. Nothing but Error
// may come.
TEST(SceneLoad, MutatedFilesNeverCrash) {
  uint64_t state = 12345;
  const auto random = [&](uint64_t n) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return (state >> 33) % n;
  };
  std::ifstream in(resource_root() / "assets/scenes/square_plane.glb", std::ios::binary);
  const std::string small{std::istreambuf_iterator<char>(in), {}};
  std::ifstream textured(resource_root() / "assets/scenes/foliage.glb", std::ios::binary);
  const std::string large{std::istreambuf_iterator<char>(textured), {}};
  const Folder folder;
  int loaded = 0, refused = 0;
  const auto attempt = [&](const std::string& bytes) {
    try {
      const Scene scene = load_scene(folder.write("fuzz.glb", bytes));
      for (const LightView& face : light_views(scene, 256, 4)) EXPECT_GT(face.near, 0.0);
      scene_facts(scene, scene.cameras[0], 1.0);
      ++loaded;
    } catch (const Error&) {
      ++refused;
    }
  };
  const char* const numbers[] = {"-1",   "0",     "1e308", "4294967295", "99999999999999999999",
                                 "null", "\"x\"", "[]",    "{}",         "2147483648"};
  for (int i = 0; i < 900; ++i) {
    std::string bytes = i % 10 == 0 ? large : small;
    const size_t json_end =
        20 + static_cast<unsigned char>(bytes[12]) + 256u * static_cast<unsigned char>(bytes[13]);
    if (i % 3 == 0) {  // any bytes
      for (uint64_t k = 0; k <= random(8); ++k) bytes[random(bytes.size())] = static_cast<char>(random(256));
    } else if (i % 3 == 1) {  // bytes of the header and the document
      for (uint64_t k = 0; k <= random(3); ++k) bytes[random(json_end)] = static_cast<char>(random(96) + 32);
    } else {  // one number of the document
      Json document = Json::parse(bytes.substr(20, json_end - 20)).flatten();
      auto member = document.begin();
      std::advance(member, static_cast<std::ptrdiff_t>(random(document.size())));
      *member = Json::parse(numbers[random(std::size(numbers))], nullptr, false);
      try {
        bytes = glb(document.unflatten(), bytes.substr(json_end + 8));
      } catch (const Json::exception&) {
        continue;
      }
    }
    if (random(20) == 0) bytes.resize(random(bytes.size()));
    attempt(bytes);
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(loaded, 50);
}

std::filesystem::path real_scenes() {
  if (const char* folder = std::getenv("GNOMON_SCENES")) return folder;
  return resource_root() / ".." / "shared" / "scenes";
}

struct RealScene {
  const char* name;
  uint64_t triangles, degenerate;  // in the file; of these, with two corners in the same place
  bool watertight_occluder;
};

// Counts and watertightness as their README states them; a mesh is two-sided exactly when it is not
// watertight.
TEST(SceneLoad, RealScenes) {
  const RealScene scenes[] = {{"dragon", 100004, 0, true}, {"dragon_grounded", 100002, 0, true},
                              {"teapot", 15706, 0, true},  {"raptor", 4153, 0, false},
                              {"bunny", 69453, 0, false},  {"foliage", 201550, 0, false},
                              {"room", 23388, 4168, false}};
  if (!std::filesystem::exists(real_scenes() / "dragon.glb")) {
    std::cout << "real scenes not found in " << real_scenes()
              << "; the generated ones are used in the other tests\n";
    return;
  }
  for (const RealScene& expected : scenes) {
    const Scene scene = load_scene(real_scenes() / (std::string(expected.name) + ".glb"));
    EXPECT_EQ(scene.triangles(), expected.triangles - expected.degenerate) << expected.name;
    EXPECT_EQ(scene.warnings.degenerate_triangles, expected.degenerate) << expected.name;
    EXPECT_EQ(scene.warnings.nonfinite_triangles, 0u) << expected.name;
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_NEAR(scene.lights[0].map_fov, 0.25 * 3.14159265358979, 1e-9) << expected.name;
    EXPECT_TRUE(scene.lights[0].area.has_value());
    EXPECT_NEAR(scene.cameras[0].fov_y, 0.25 * 3.14159265358979, 1e-5);
    if (std::string(expected.name) != "room") {
      EXPECT_EQ(scene.meshes[0].watertight, expected.watertight_occluder) << expected.name;
    }
    for (const Mesh& mesh : scene.meshes)
      EXPECT_EQ(mesh.watertight, !scene.materials[mesh.material].double_sided)
          << expected.name << " " << mesh.name;
    EXPECT_EQ(scene_facts(scene, scene.cameras[0], 16.0 / 9).shadowless[0], "");
  }
}

}  // namespace
}  // namespace gnomon
