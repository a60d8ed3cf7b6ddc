// Skins, morph targets and KHR_animation_pointer: shapes and values against those worked out by hand.
#include "engine/scene/deformation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/animation.h"
#include "tests/engine/scene/gltf_draft.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;
using test::Draft;
using test::error_of;
using test::load;
using test::raw;
using test::warns;

// Where the vertex that was at `corner` of the unit square is in the world; vertices keep their order.
glm::dvec3 placed(const Scene& scene, size_t vertex) {
  const Instance& instance = scene.instances.at(0);
  return glm::dvec3(instance.world_from_object *
                    glm::dvec4(glm::dvec3(scene.meshes[instance.mesh].positions.at(vertex)), 1.0));
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-6) << "component " << i;
}

void add_normals(Draft& draft) {
  draft.primitive()["attributes"]["NORMAL"] =
      draft.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
}

// The square hangs on two joints, its left side on the first at (0, 1, 0), its right on the second, a child
// one unit further along x. The node of the mesh has a transform of its own, which skins ignore.
Draft skinned() {
  Draft draft;
  add_normals(draft);
  draft.document["nodes"] = Json::parse(R"([
    {"mesh":0,"skin":0,"scale":[100,100,100],"translation":[7,7,7]},
    {"translation":[0,1,0],"children":[2]},{"translation":[1,0,0]}])");
  draft.document["scenes"][0]["nodes"] = {0, 1};
  draft.primitive()["attributes"]["JOINTS_0"] = [&] {
    const size_t view = draft.add_view(raw<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}));
    draft.document["accessors"].push_back(
        {{"bufferView", view}, {"componentType", 5121}, {"count", 4}, {"type", "VEC4"}});
    return draft.document["accessors"].size() - 1;
  }();
  draft.primitive()["attributes"]["WEIGHTS_0"] =
      draft.add_floats({1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
  const size_t view = draft.add_view(raw<float>(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}));
  draft.document["accessors"].push_back(
      {{"bufferView", view}, {"componentType", 5126}, {"count", 2}, {"type", "MAT4"}});
  draft.document["skins"] = {
      {{"joints", {1, 2}}, {"inverseBindMatrices", draft.document["accessors"].size() - 1}}};
  return draft;
}

void animate(Draft& draft, const Json& target, const std::vector<float>& times,
             const std::vector<float>& values, const std::string& type, size_t components,
             const char* interpolation = "LINEAR") {
  draft.document["animations"].push_back({{"channels", {{{"sampler", 0}, {"target", target}}}},
                                          {"samplers",
                                           {{{"input", draft.add_floats(times, "SCALAR", 1)},
                                             {"output", draft.add_floats(values, type, components)},
                                             {"interpolation", interpolation}}}}});
}

Json pointer(const std::string& to) {
  return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", to}}}}}};
}

TEST(Skin, StandsWhereItsJointsAre) {
  const Scene scene = load(skinned());
  EXPECT_FALSE(scene.animation);
  EXPECT_FALSE(scene.instances[0].moving);
  expect_near(placed(scene, 0), {0, 1, 0});
  expect_near(placed(scene, 1), {1, 1, 0});
  expect_near(placed(scene, 2), {1, 2, 0});
  expect_near(placed(scene, 3), {0, 2, 0});  // without weights: on the first joint
  EXPECT_EQ(scene.bounds.min, glm::dvec3(0, 1, 0));
  EXPECT_FALSE(warns(scene, "bind pose"));
}

TEST(Skin, FollowsItsJoints) {
  Draft draft = skinned();
  const float half = std::sqrt(0.5f);
  // The second joint turns a quarter about y: the right side's normals turn to x.
  animate(draft, {{"node", 2}, {"path", "rotation"}}, {0, 1}, {0, 0, 0, 1, 0, half, 0, half}, "VEC4", 4);
  // The first moves up.
  animate(draft, {{"node", 1}, {"path", "translation"}}, {0, 1}, {0, 1, 0, 0, 3, 0}, "VEC3", 3);
  const Scene scene = load(draft);
  ASSERT_TRUE(scene.animation);
  EXPECT_TRUE(scene.instances[0].moving);
  EXPECT_TRUE(scene.animation->instances.empty());
  EXPECT_EQ(duration(*scene.animation), 1);
  expect_near(placed(scene, 2), {1, 2, 0});
  const Scene later = posed(scene, 1);
  expect_near(placed(later, 0), {0, 3, 0});
  expect_near(placed(later, 1), {1, 3, 0});
  expect_near(placed(later, 2), {1, 4, 0});
  expect_near(glm::dvec3(later.meshes[0].normals[0]), {0, 0, 1});
  expect_near(glm::dvec3(later.meshes[0].normals[1]), {1, 0, 0});
  EXPECT_EQ(later.meshes[0].bounds.max.y, 3);  // about the first joint at time 0
}

// A skin stands still while its node is shown and hidden.
TEST(Skin, IsShownAndHiddenWithItsNode) {
  Draft draft = skinned();
  animate(draft, pointer("/nodes/0/extensions/KHR_node_visibility/visible"), {0, 1}, {1, 0}, "SCALAR", 1,
          "STEP");
  const Scene scene = load(draft);
  ASSERT_TRUE(scene.animation);
  EXPECT_TRUE(scene.instances[0].visible);
  const Scene later = posed(scene, 1);
  EXPECT_FALSE(later.instances[0].visible);
  EXPECT_EQ(later.instances[0].world_from_object, scene.instances[0].world_from_object);
}

TEST(Skin, JointsOutsideTheSceneAreTold) {
  Draft draft = skinned();
  draft.document["scenes"][0]["nodes"] = {0};
  const Scene scene = load(draft);
  EXPECT_TRUE(warns(scene, "/skins/0/joints/0: node 1 is not in the scene: the mesh stays in its bind pose"));
  expect_near(placed(scene, 1), {107, 7, 7});
  draft = skinned();
  draft.document["skins"][0]["joints"] = {1};
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("out of range; there are 1"), std::string::npos);
  draft = skinned();
  draft.document["nodes"][0]["skin"] = 3;
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("/nodes/0/skin: no skin 3"), std::string::npos);
}

// One target lifts the corner at (1, 1), the other moves everything along x.
Draft morphed() {
  Draft draft;
  draft.primitive()["targets"] = {
      {{"POSITION", draft.add_floats({0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0}, "VEC3", 3)}},
      {{"POSITION", draft.add_floats({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3", 3)}}};
  draft.document["meshes"][0]["weights"] = {0.5, 0};
  return draft;
}

// Flat shading splits the square's vertices: 0 1 2, 0 2 3.
TEST(MorphTargets, WeightsOfNodeOrMeshShapeIt) {
  Draft draft = morphed();
  const Scene scene = load(draft);
  expect_near(placed(scene, 2), {1, 1, 1});
  expect_near(placed(scene, 0), {0, 0, 0});
  expect_near(glm::dvec3(scene.meshes[0].normals[0]), glm::normalize(glm::dvec3(0, -1, 1)));
  draft.document["nodes"][0]["weights"] = {0, 3};
  expect_near(placed(load(draft), 2), {4, 1, 0});
  draft.document["nodes"][0]["scale"] = {-1, 1, 1};  // mirrors
  expect_near(placed(load(draft), 0), {-3, 0, 0});
}

TEST(MorphTargets, WeightsAreAnimated) {
  for (const bool by_pointer : {false, true}) {
    Draft draft = morphed();
    const Json target = by_pointer ? pointer("/nodes/0/weights") : Json{{"node", 0}, {"path", "weights"}};
    animate(draft, target, {0, 2}, {0, 0, 1, 4}, "SCALAR", 1);
    const Scene scene = load(draft);
    ASSERT_TRUE(scene.animation);
    EXPECT_TRUE(scene.instances[0].moving);
    expect_near(placed(scene, 2), {1, 1, 0});
    const Scene later = posed(scene, 1);
    expect_near(placed(later, 2), {3, 1, 1});
    expect_near(placed(later, 1), {3, 0, 0});
    expect_near(glm::dvec3(later.meshes[0].normals[0]), glm::normalize(glm::dvec3(0, -1, 1)));
    EXPECT_EQ(later.meshes[0].bounds.max, glm::dvec3(3, 1, 1));
  }
}

// Meshes that only mirrored instances use are dropped: those that change keep their place.
TEST(MorphTargets, OtherMeshesMayBeDropped) {
  Draft draft = morphed();
  draft.document["meshes"].push_back(draft.document["meshes"][0]);
  draft.document["meshes"][1]["primitives"][0].erase("targets");
  draft.document["nodes"] = Json::parse(R"([{"mesh":1,"scale":[-1,1,1]},{"mesh":0}])");
  draft.document["scenes"][0]["nodes"] = {0, 1};
  animate(draft, {{"node", 1}, {"path", "weights"}}, {0, 1}, {0, 0, 1, 4}, "SCALAR", 1);
  const Scene scene = load(draft);
  ASSERT_EQ(scene.meshes.size(), 2u);
  ASSERT_EQ(scene.animation->deformations.size(), 1u);
  EXPECT_EQ(scene.animation->deformations[0].mesh, scene.instances[1].mesh);
  const Scene later = posed(scene, 1);
  EXPECT_EQ(later.meshes[scene.instances[1].mesh].bounds.max, glm::dvec3(5, 1, 2));
  EXPECT_EQ(later.meshes[scene.instances[0].mesh].bounds.max, glm::dvec3(0, 1, 0));
}

// A shape that grows out of nothing is kept.
TEST(MorphTargets, TrianglesThatOpenLaterAreKept) {
  Draft draft = morphed();
  const std::vector<float> flat = {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0};
  draft.data.replace(0, 48, raw(flat));
  animate(draft, {{"node", 0}, {"path", "weights"}}, {0, 1}, {0, 0, 1, 0}, "SCALAR", 1);
  const Scene scene = load(draft);
  EXPECT_EQ(scene.meshes[0].triangles(), 2u);
  expect_near(placed(posed(scene, 1), 2), {1, 0, 2});
}

TEST(WeightTrack, CubicSplineIsHermite) {
  // One weight from 0 to 1 in 2 s, leaving at 3 per second, arriving at -1 per second; the other stays at 5.
  const WeightTrack track{Interpolation::cubic_spline, {1, 3}, {9, 0, 0, 5, 3, 0, -1, 0, 1, 5, 9, 0}, 2};
  EXPECT_EQ(weights_at(track, 0), (std::vector<double>{0, 5}));
  EXPECT_EQ(weights_at(track, 9), (std::vector<double>{1, 5}));
  // At half: 1/2 + 2 * (3 / 8 + 1 / 8).
  EXPECT_NEAR(weights_at(track, 2)[0], 1.5, 1e-12);
  EXPECT_NEAR(weights_at(track, 2)[1], 5, 1e-12);
}

Draft lit() {
  Draft draft;
  draft.document["nodes"] = Json::parse(R"([
    {"mesh":0},{"children":[2,3]},{"mesh":0,"translation":[0,0,1]},
    {"extensions":{"KHR_lights_punctual":{"light":0}}}])");
  draft.document["scenes"][0]["nodes"] = {0, 1};
  draft.document["extensions"]["KHR_lights_punctual"]["lights"] =
      Json::parse(R"([{"type":"point","intensity":8}])");
  draft.document["materials"] = Json::parse(R"([{"alphaMode":"MASK"}])");
  draft.document["extensionsUsed"] = {"KHR_animation_pointer"};
  draft.primitive()["material"] = 0;
  return draft;
}

TEST(AnimationPointer, NodesAreMoved) {
  Draft draft = lit();
  animate(draft, pointer("/nodes/2/translation"), {0, 1}, {0, 0, 1, 0, 0, 5}, "VEC3", 3);
  const Scene scene = load(draft);
  ASSERT_TRUE(scene.animation);
  EXPECT_EQ(posed(scene, 0.5).instances[1].world_from_object[3].z, 3);
  EXPECT_FALSE(warns(scene, "KHR_animation_pointer"));
}

TEST(AnimationPointer, NodesAreShownAndHidden) {
  Draft draft = lit();
  draft.document["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  animate(draft, pointer("/nodes/1/extensions/KHR_node_visibility/visible"), {0, 1, 2}, {0, 1, 0}, "SCALAR",
          1, "STEP");
  const Scene scene = load(draft);
  ASSERT_TRUE(scene.animation);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_TRUE(scene.instances[0].visible);
  EXPECT_FALSE(scene.instances[1].visible);
  EXPECT_TRUE(scene.instances[1].moving);
  EXPECT_EQ(scene.bounds.max.z, 0);
  EXPECT_EQ(scene.lights.at(0).intensity, 0);
  const Scene shown = posed(scene, 1.5);
  EXPECT_TRUE(shown.instances[1].visible);
  EXPECT_EQ(shown.lights[0].intensity, 8);
  EXPECT_FALSE(posed(shown, 2).instances[1].visible);
}

TEST(AnimationPointer, LightsAndMaterialsChange) {
  Draft draft = lit();
  animate(draft, pointer("/extensions/KHR_lights_punctual/lights/0/intensity"), {0, 1}, {2, 4}, "SCALAR", 1);
  animate(draft, pointer("/materials/0/pbrMetallicRoughness/baseColorFactor"), {0, 1},
          {1, 1, 1, 1, 1, 0, 1, 0}, "VEC4", 4);
  const Scene scene = load(draft);
  ASSERT_TRUE(scene.animation);
  EXPECT_EQ(posed(scene, 0.5).lights[0].intensity, 3);
  EXPECT_EQ(posed(scene, 0.5).materials[0].base_color, glm::vec4(1, 0.5, 1, 0.5));
  EXPECT_EQ(posed(scene, 0.5).materials[0].alpha_cutoff, 0.5f);
  EXPECT_EQ(duration(*scene.animation), 1);
}

TEST(AnimationPointer, OtherPropertiesAreNamed) {
  Draft draft = lit();
  animate(draft, pointer("/cameras/0/perspective/yfov"), {0, 1}, {1, 2}, "SCALAR", 1);
  animate(draft, pointer("/nodes/x/translation"), {0, 1}, {0, 0, 1, 0, 0, 5}, "VEC3", 3);
  const Scene scene = load(draft);
  EXPECT_TRUE(warns(scene, "/animations/0/channels/0/target: '/cameras/0/perspective/yfov' is not animated"));
  EXPECT_TRUE(warns(scene, "'/nodes/x/translation' is not animated"));
  EXPECT_FALSE(scene.animation);
}

}  // namespace
}  // namespace gnomon
