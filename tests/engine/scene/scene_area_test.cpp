// Area lights as files describe them: extras.area_light.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/image/png.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"
#include "tests/engine/scene/gltf_draft.h"

namespace gnomon {
namespace {

using namespace test;
using Json = nlohmann::json;

// A spot light with the given extras.area_light, and a texture "panes" of 2 x 2 texels from the image
// "window".
Draft with_area(const std::string& area) {
  Draft draft;
  const std::vector<uint8_t> panes = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 0, 0, 0, 255};
  const std::string image = png::encode(panes, 2, 2, 4, "window.png");
  const std::string black = png::encode(std::vector<uint8_t>(4, 0), 1, 1, 4, "black.png");
  draft.document.merge_patch(Json::parse(R"({
    "samplers":[{"magFilter":9728}],
    "textures":[{"name":"panes","source":0,"sampler":0},{"source":1},{"source":2}],
    "images":[{"name":"window","bufferView":2,"mimeType":"image/png"},
              {"name":"black","bufferView":3,"mimeType":"image/png"},{"uri":"none.png"},
              {"name":"loose","bufferView":2,"mimeType":"image/png"}],
    "extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","name":"lamp","spot":{}}]}},
    "scenes":[{"nodes":[0,1]}],
    "nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}},"extras":{}}]})"));
  draft.document["nodes"][1]["extras"]["area_light"] = Json::parse(area);
  for (const std::string& bytes : {image, black}) {
    draft.document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", draft.data.size()}, {"byteLength", bytes.size()}});
    draft.data += bytes;
  }
  draft.document["buffers"][0]["byteLength"] = draft.data.size();
  return draft;
}

TEST(SceneArea, AreaLightsOfEveryShape) {
  using Shape = AreaLight::Shape;
  const std::vector<glm::dvec2> outline = {{-1, -0.5}, {0.5, -0.5}, {0, 0.25}};
  const std::pair<const char*, AreaLight> cases[] = {
      {R"({"width":2,"height":1})", {Shape::rectangle, 2, 1, {}, {}}},
      {R"({"shape":"rectangle","width":2,"height":0.5})", {Shape::rectangle, 2, 0.5, {}, {}}},
      {R"({"shape":"disc","radius":0.25})", {Shape::disc, 0.5, 0.5, {}, {}}},
      {R"({"shape":"disc","width":3,"height":3})", {Shape::disc, 3, 3, {}, {}}},
      {R"({"shape":"sphere","radius":1})", {Shape::sphere, 2, 2, {}, {}}},
      {R"({"shape":"polygon","outline":[[-1,-0.5],[0.5,-0.5],[0,0.25]]})",
       {Shape::polygon, 2, 1, outline, {}}},
      {R"({"width":2,"height":1,"emission":0})", {Shape::rectangle, 2, 1, {}, 0}},
      {R"({"width":2,"height":1,"emission":"panes"})", {Shape::rectangle, 2, 1, {}, 0}},
      {R"({"width":2,"height":1,"emission":"window"})", {Shape::rectangle, 2, 1, {}, 0}},
      {R"({"width":2,"height":1,"emission":"loose"})", {Shape::rectangle, 2, 1, {}, 0}},
  };
  for (const auto& [area, expected] : cases) {
    const Scene scene = load(with_area(area));
    ASSERT_TRUE(scene.lights[0].area.has_value()) << area;
    EXPECT_EQ(*scene.lights[0].area, expected) << area;
    EXPECT_FALSE(warns(scene, "area_light")) << area;
    ASSERT_EQ(scene.textures.size(), expected.emission ? 1u : 0u) << area;
    if (!expected.emission) continue;
    EXPECT_EQ(scene.textures[0].width, 2u);
    EXPECT_EQ(scene.textures[0].rgba[5], 255);
    EXPECT_EQ(scene.textures[0].nearest,
              std::string(area).find("loose") == std::string::npos);  // its sampler
  }
}

TEST(SceneArea, AnEmissionTextureIsSharedWithMaterials) {
  Draft draft = with_area(R"({"width":2,"height":1,"emission":"panes"})");
  draft.document["materials"] = Json::parse(R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])");
  const Scene scene = load(draft);
  EXPECT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.lights[0].area->emission, 0u);
}

TEST(SceneArea, BadAreaLightsAreToldAndIgnored) {
  const std::pair<const char*, std::vector<const char*>> cases[] = {
      {R"(3)", {"/nodes/1/extras/area_light: not an object"}},
      {R"({"width":2})", {"needs a width and a height"}},
      {R"({"width":0,"height":1})", {"needs a width and a height"}},
      {R"({"width":"2","height":1})", {"needs a width and a height"}},
      {R"({"shape":"sqare","width":1,"height":1})", {"/area_light/shape", "unknown shape 'sqare'"}},
      {R"({"shape":"dics","radius":1})", {"did you mean 'disc'?"}},
      {R"({"shape":4,"width":1,"height":1})", {"/area_light/shape: not a string"}},
      {R"({"shape":"disc"})", {"needs a radius"}},
      {R"({"shape":"disc","radius":-1})", {"/area_light/radius: not a number above 0"}},
      {R"({"shape":"disc","radius":1,"width":2})", {"has a radius, and a width"}},
      {R"({"shape":"disc","width":1,"height":2})", {"as wide as high"}},
      {R"({"shape":"polygon"})", {"needs an outline"}},
      {R"({"shape":"polygon","outline":7})", {"/area_light/outline: not an array"}},
      {R"({"shape":"polygon","outline":[[0,0],[1,0]]})", {"2 corners"}},
      {R"({"shape":"polygon","outline":[[0,0],[1,0],[1]]})", {"/area_light/outline/2: not a corner"}},
      {R"({"shape":"polygon","outline":[[0,0],[1,0],[1,"a"]]})", {"/area_light/outline/2: not a corner"}},
      {R"({"shape":"polygon","outline":[[-1,-1],[1,1],[1,-1],[-1,1]]})", {"edges 0 and 2"}},
      {R"({"shape":"polygon","outline":[[0,0],[1,0],[2,0]]})", {"turns back"}},
  };
  for (const auto& [area, parts] : cases) {
    const Scene scene = load(with_area(area));
    EXPECT_FALSE(scene.lights[0].area.has_value()) << area;
    EXPECT_TRUE(warns(scene, "draft.glb: /nodes/1/extras/area_light")) << area;
    EXPECT_TRUE(warns(scene, "the area light is ignored")) << area;
    for (const char* part : parts) EXPECT_TRUE(warns(scene, part)) << area << ": " << part;
  }
}

TEST(SceneArea, SuperfluousKeysOfAreaLightsAreTold) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"width":2,"height":1,"widht":3})", "unknown key 'widht', ignored (did you mean 'width'?)"},
      {R"({"width":2,"height":1,"radius":3})", "a rectangle has no 'radius', ignored"},
      {R"({"width":2,"height":1,"outline":[1]})", "a rectangle has no 'outline', ignored"},
      {R"({"shape":"disc","radius":1,"emission":0})", "a disc has no 'emission', ignored"},
      {R"({"shape":"polygon","width":9,"outline":[[0,0],[1,0],[0,1]]})", "a polygon has no 'width', ignored"},
      {R"({"width":2,"height":1,"emission":3})", "an index below 3"},
      {R"({"width":2,"height":1,"emission":-1})", "no such texture, ignored"},
      {R"({"width":2,"height":1,"emission":0.5})", "no such texture, ignored"},
      {R"({"width":2,"height":1,"emission":"panse"})", "did you mean 'panes'?"},
      {R"({"width":2,"height":1,"emission":1})", "the texture is black, ignored"},
      {R"({"width":2,"height":1,"emission":2})", "'none.png' cannot be read; white is used"},
  };
  for (const auto& [area, part] : cases) {
    const Scene scene = load(with_area(area));
    EXPECT_TRUE(warns(scene, part)) << area;
    ASSERT_TRUE(scene.lights[0].area.has_value()) << area;
    EXPECT_FALSE(scene.lights[0].area->emission.has_value()) << area;
    EXPECT_TRUE(scene.textures.empty()) << area;
  }
}

// A light of another type with the given extras.area_light.
Scene lit_by(const char* type, const std::string& area) {
  Draft draft = with_area(area);
  Json& light = draft.document["extensions"]["KHR_lights_punctual"]["lights"][0];
  light["type"] = type;
  if (light["type"] != "spot") light.erase("spot");
  return load(draft);
}

TEST(SceneArea, PointLightsAreSpheres) {
  for (const char* area : {R"({"radius":0.25})", R"({"shape":"sphere","radius":0.25})",
                           R"({"shape":"sphere","width":0.5,"height":0.5})"}) {
    const Scene scene = lit_by("point", area);
    ASSERT_TRUE(scene.lights[0].area.has_value()) << area;
    EXPECT_EQ(*scene.lights[0].area, (AreaLight{AreaLight::Shape::sphere, 0.5, 0.5, {}, {}})) << area;
    EXPECT_TRUE(has_size(scene.lights[0]));
    EXPECT_FALSE(warns(scene, "area_light")) << area;
  }
}

TEST(SceneArea, DirectionalLightsHaveAnAngularDiameter) {
  const Scene scene = lit_by("directional", R"({"angular_diameter":0.53})");
  ASSERT_TRUE(scene.lights[0].area.has_value());
  const AreaLight& disc = *scene.lights[0].area;
  EXPECT_EQ(disc.shape, AreaLight::Shape::disc);
  EXPECT_NEAR(disc.width, 2 * std::tan(0.265 / 180 * 3.14159265358979), 1e-15);
  EXPECT_EQ(disc.width, disc.height);
  EXPECT_NEAR(angular_diameter(disc), 0.53 / 180 * 3.14159265358979, 1e-15);
  EXPECT_TRUE(has_size(scene.lights[0]));
  EXPECT_FALSE(warns(scene, "area_light"));
}

TEST(SceneArea, SizesThatATypeCannotHaveAreTold) {
  struct Case {
    const char *type, *area, *told;
    bool used = false;
  };
  const Case cases[] = {
      {"point", R"({"shape":"disc","radius":1})", "/area_light/shape: a point light's shape is a sphere"},
      {"point", R"({"width":1})", "/area_light: needs a radius"},
      {"point", R"({"radius":0})", "/area_light/radius: not a number above 0"},
      {"point", R"({"radius":1,"angular_diameter":2})", "a sphere has no 'angular_diameter', ignored", true},
      {"point", R"({"radius":1,"outline":2})", "a sphere has no 'outline', ignored", true},
      {"directional", "3", "/area_light: not an object"},
      {"directional", R"({"width":1,"height":1})", "/area_light: a directional light needs an angular_diam"},
      {"directional", R"({"angular_diameter":0})", "/angular_diameter: not a number above 0 and below 180"},
      {"directional", R"({"angular_diameter":180})", "/angular_diameter: not a number above 0 and below 180"},
      {"directional", R"({"angular_diameter":"0.53"})", "not a number above 0 and below 180"},
      {"directional", R"({"angular_diameter":0.5,"radius":1})", "a directional light has no 'radius'", true},
      {"directional", R"({"angular_diameter":0.5,"angle":1})", "unknown key 'angle', ignored", true},
      {"spot", R"({"width":1,"height":1,"angular_diameter":1})", "a rectangle has no 'angular_diam", true}};
  for (const Case& c : cases) {
    const Scene scene = lit_by(c.type, c.area);
    EXPECT_EQ(scene.lights[0].area.has_value(), c.used) << c.type << ' ' << c.area;
    EXPECT_TRUE(warns(scene, "draft.glb: /nodes/1/extras/area_light")) << c.type << ' ' << c.area;
    EXPECT_TRUE(warns(scene, c.told)) << c.type << ' ' << c.area;
  }
}

// Lights of the draft extension, on a node that is scaled by 2, 3 and 0.5, and turned.
Scene with_extension(const std::string& lights, int index = 0) {
  Draft draft;
  draft.document.merge_patch(Json::parse(R"({
    "extensionsRequired":["EXT_lights_area"],"scenes":[{"nodes":[0,1]}],
    "nodes":[{"mesh":0},{"name":"panel","translation":[1,2,3],"rotation":[0,1,0,0],"scale":[2,-3,0.5]}]})"));
  draft.document["extensions"]["EXT_lights_area"]["lights"] = Json::parse(lights);
  draft.document["nodes"][1]["extensions"]["EXT_lights_area"]["light"] = index;
  return load(draft);
}

TEST(SceneArea, LightsOfTheDraftExtension) {
  using Shape = AreaLight::Shape;
  const std::string lights =
      R"([{"type":"rect","size":0.5,"rect":{"aspect":2},"intensity":10,"color":[1,0.5,0]},
                                 {"type":"disk","size":2,"name":"lid"},{"type":"rect"}])";
  const AreaLight areas[] = {
      {Shape::rectangle, 3, 1.5, {}, {}}, {Shape::disc, 6, 6, {}, {}}, {Shape::rectangle, 3, 3, {}, {}}};
  const double candela[] = {10 * 4.5, 1000 * 3.14159265358979 * 9, 1000 * 9.0};
  for (int i = 0; i < 3; ++i) {
    const Scene scene = with_extension(lights, i);
    ASSERT_EQ(scene.lights.size(), 1u);
    const Light& light = scene.lights[0];
    EXPECT_EQ(light.type, LightType::spot);
    EXPECT_EQ(light.name, i == 1 ? "lid" : "panel");
    EXPECT_EQ(*light.area, areas[i]);
    EXPECT_NEAR(light.intensity, candela[i], 1e-9 * candela[i]);
    EXPECT_EQ(glm::dvec3(light.world_from_light[3]), glm::dvec3(1, 2, 3));
    EXPECT_NEAR(light.world_from_light[2].z, -1, 1e-12);
    EXPECT_NEAR(light.outer_cone, 3.14159265358979 / 2, 1e-12);
    EXPECT_FALSE(warns(scene, "EXT_lights_area"));
  }
  EXPECT_EQ(with_extension(lights).lights[0].color, glm::dvec3(1, 0.5, 0));
}

TEST(SceneArea, BadLightsOfTheDraftExtensionAreTold) {
  const std::string place = "/extensions/EXT_lights_area/lights/0/";
  const Scene bad = with_extension(R"([{"type":"rect","size":-1,"rect":{"aspect":0},"intensity":"x"}])");
  EXPECT_TRUE(warns(bad, place + "size: not a number above 0, 1 is used"));
  EXPECT_TRUE(warns(bad, place + "aspect: not a number above 0, 1 is used"));
  EXPECT_TRUE(warns(bad, place + "intensity: not a number above 0, 1000 is used"));
  EXPECT_EQ(*bad.lights[0].area, (AreaLight{AreaLight::Shape::rectangle, 3, 3, {}, {}}));
  EXPECT_TRUE(warns(with_extension(R"([{"type":"disc"}])"), "unknown type 'disc': the light is left out"));
  EXPECT_THROW(with_extension("[]"), Error);
  EXPECT_THROW(with_extension(R"([{"type":"rect"}])", 1), Error);
}

}  // namespace
}  // namespace gnomon
