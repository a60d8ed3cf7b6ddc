// Key frames, node trees and poses against values worked out by hand.
#include "engine/scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/light/light_fit.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/truth/reference.h"
#include "tests/engine/scene/gltf_draft.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;
using test::Draft;

constexpr double pi = std::numbers::pi;

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

glm::dvec4 about_z(double degrees) {
  const double half = 0.5 * degrees / 180 * pi;
  return {0, 0, std::sin(half), std::cos(half)};
}
double angle_about_z(const glm::dquat& q) { return 2 * std::atan2(q.z, q.w) / pi * 180; }

TEST(Track, StepHoldsUntilTheNextKeyFrame) {
  const Track track{Interpolation::step, {1, 2, 4}, {{1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}}};
  for (const auto& [at, wanted] :
       {std::pair{0.0, 1.0}, {1.0, 1.0}, {1.999, 1.0}, {2.0, 2.0}, {3.9, 2.0}, {4.0, 3.0}, {9.0, 3.0}})
    EXPECT_EQ(vector_at(track, at).x, wanted) << at;
}

TEST(Track, LinearIsProportionalAndClamped) {
  const Track track{Interpolation::linear, {1, 3}, {{1, -2, 0, 0}, {5, 2, 8, 0}}};
  expect_near(vector_at(track, 1.5), {2, -1, 2});
  expect_near(vector_at(track, 2.5), {4, 1, 6});
  expect_near(vector_at(track, -1), {1, -2, 0});
  expect_near(vector_at(track, 77), {5, 2, 8});
  expect_near(vector_at(track, std::numeric_limits<double>::quiet_NaN()), {1, -2, 0});
  expect_near(vector_at(track, std::numeric_limits<double>::infinity()), {5, 2, 8});
}

// glTF 2.0, C.5 by hand: from 0 to 1 in 2 s, leaving at 3 per second, arriving at -1 per second.
TEST(Track, CubicSplineIsHermite) {
  const glm::dvec4 zero(0);
  const Track track{Interpolation::cubic_spline,
                    {1, 3},
                    {{9, 0, 0, 0}, zero, {3, 0, 0, 0}, {-1, 0, 0, 0}, {1, 0, 0, 0}, {9, 0, 0, 0}}};
  EXPECT_NEAR(vector_at(track, 1).x, 0, 1e-12);
  EXPECT_NEAR(vector_at(track, 3).x, 1, 1e-12);
  // t = 1/2: h01 = 1/2, h10 = 1/8, h11 = -1/8: 1/2 + 2 (3/8 + 1/8).
  EXPECT_NEAR(vector_at(track, 2).x, 1.5, 1e-12);
  // t = 1/4: h01 = 10/64, h10 = 9/64, h11 = -3/64.
  EXPECT_NEAR(vector_at(track, 1.5).x, 10.0 / 64 + 2 * (3 * 9.0 / 64 + 3.0 / 64), 1e-12);
  const double h = 1e-6;
  EXPECT_NEAR((vector_at(track, 1 + h).x - 0) / h, 3, 1e-4);  // the tangents are slopes
  EXPECT_NEAR((1 - vector_at(track, 3 - h).x) / h, -1, 1e-4);
}

TEST(Track, RotationsTurnEvenlyTheShorterWay) {
  Track track{Interpolation::linear, {0, 1}, {about_z(10), about_z(130)}};
  EXPECT_NEAR(angle_about_z(rotation_at(track, 0.25)), 40, 1e-9);
  track.values = {about_z(10), -about_z(50)};  // the same rotation as 50 degrees
  EXPECT_NEAR(std::remainder(angle_about_z(rotation_at(track, 0.5)), 360), 30, 1e-9);
  track.values = {about_z(-170), about_z(170)};  // through 180, not through 0
  EXPECT_NEAR(std::abs(std::remainder(angle_about_z(rotation_at(track, 0.5)), 360)), 180, 1e-9);
  track.interpolation = Interpolation::step;
  EXPECT_NEAR(angle_about_z(rotation_at(track, 0.99)), -170, 1e-9);
}

TEST(Track, SplineOfRotationsIsNormalised) {
  const glm::dvec4 zero(0);
  const Track track{Interpolation::cubic_spline, {0, 1}, {zero, about_z(0), zero, zero, about_z(90), zero}};
  const glm::dquat middle = rotation_at(track, 0.5);
  EXPECT_NEAR(glm::length(middle), 1, 1e-12);
  EXPECT_NEAR(angle_about_z(middle), 45, 1e-9);  // by symmetry
}

// A draft with more accessors at the end of its data.
size_t add_accessor(Draft& draft, const std::vector<float>& values, const char* type, int components) {
  Json& document = draft.document;
  const size_t offset = draft.data.size();
  draft.data += test::raw(values);
  document["buffers"][0]["byteLength"] = draft.data.size();
  document["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", 4 * values.size()}});
  document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                   {"componentType", 5126},
                                   {"count", values.size() / static_cast<size_t>(components)},
                                   {"type", type}});
  return document["accessors"].size() - 1;
}

// Adds an animation of its own with one channel.
void animate(Draft& draft, int node, const std::string& path, const std::vector<float>& times,
             const std::vector<float>& values, const std::string& interpolation = "LINEAR") {
  const bool rotation = path == "rotation";
  const size_t input = add_accessor(draft, times, "SCALAR", 1);
  const size_t output = add_accessor(draft, values, rotation ? "VEC4" : "VEC3", rotation ? 4 : 3);
  draft.document["animations"].push_back(
      {{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
}

// Node 0 carries node 1, which has the square, node 2, a camera, and node 3, a light; node 4 is a square
// apart.
Draft tree() {
  Draft draft;
  Json& d = draft.document;
  d["nodes"] = {{{"children", {1, 2, 3}}, {"translation", {5, 0, 0}}},
                {{"mesh", 0}, {"translation", {1, 0, 0}}},
                {{"camera", 0}, {"translation", {0, 2, 0}}},
                {{"translation", {0, 0, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                {{"mesh", 0}}};
  d["scenes"][0]["nodes"] = {0, 4};
  d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
  d["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", Json::object()}}};
  return draft;
}

glm::dvec3 place(const glm::dmat4& m) { return glm::dvec3(m[3]); }

TEST(Animation, ParentsCarryInstancesCamerasAndLights) {
  Draft draft = tree();
  animate(draft, 0, "translation", {0.5f, 1.5f}, {0, 0, 0, 0, 10, 0});
  animate(draft, 1, "scale", {0, 2}, {1, 1, 1, 3, 1, 1});
  animate(draft, 0, "rotation", {0, 2}, {0, 0, 0, 1, 0, 0, std::sqrt(0.5f), std::sqrt(0.5f)});
  const Scene scene = test::load(draft);
  ASSERT_TRUE(scene.animation);
  EXPECT_EQ(duration(*scene.animation), 2.0);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_TRUE(scene.instances[0].moving);
  EXPECT_FALSE(scene.instances[1].moving);
  EXPECT_TRUE(scene.cameras[0].moving);
  EXPECT_TRUE(scene.lights[0].moving);
  EXPECT_FALSE(test::warns(scene, "animation"));
  // At time 0 the parent is where its first key frame has it, not where the node says.
  expect_near(place(scene.instances[0].world_from_object), {1, 0, 0});
  EXPECT_EQ(scene.bounds.max.x, 2.0);
  // At time 1: up by 5, a quarter turn half done, the square twice as wide.
  const Pose pose = pose_at(scene, 1);
  const double c = std::sqrt(0.5);
  expect_near(place(pose.instances[0]), {c, 5 + c, 0}, 1e-7);
  expect_near(glm::dvec3(pose.instances[0] * glm::dvec4(1, 0, 0, 1)), {3 * c, 5 + 3 * c, 0}, 1e-7);
  expect_near(place(pose.cameras[0]), {-2 * c, 5 + 2 * c, 0}, 1e-7);
  expect_near(glm::dvec3(pose.cameras[0][0]), {c, c, 0}, 1e-7);  // turned, and rigid
  expect_near(place(pose.lights[0]), {0, 5, 3}, 1e-7);
  EXPECT_EQ(pose.instances[1], glm::dmat4(1.0));
  // Clamped at both ends.
  EXPECT_EQ(pose_at(scene, 99).instances, pose_at(scene, 2).instances);
  EXPECT_EQ(pose_at(scene, -1).instances, pose_at(scene, 0).instances);
  EXPECT_EQ(pose_at(scene, 0).instances[0], scene.instances[0].world_from_object);
  EXPECT_EQ(posed(scene, 1).lights[0].world_from_light, pose.lights[0]);

  const SceneFacts facts = scene_facts(scene, scene.cameras[0], 1.0);
  EXPECT_TRUE(facts.animated);
  EXPECT_TRUE(facts.casters_move);
  EXPECT_EQ(facts.light_moves, std::vector<bool>{true});
  EXPECT_EQ(facts.shadowless[0], "");  // it may, later on
}

TEST(Animation, StillScenesHaveNone) {
  const Scene still = test::load(tree());
  EXPECT_FALSE(still.animation);
  const SceneFacts facts = scene_facts(still, still.cameras[0], 1.0);
  EXPECT_FALSE(facts.animated);
  EXPECT_FALSE(facts.casters_move);
  EXPECT_EQ(facts.light_moves, std::vector<bool>{false});
  EXPECT_EQ(pose_at(still, 3).instances[1], still.instances[1].world_from_object);
  // Key frames that never change a value place the node and are no movement.
  Draft draft = tree();
  animate(draft, 0, "translation", {0, 1, 2}, {7, 0, 0, 7, 0, 0, 7, 0, 0});
  const Scene placed = test::load(draft);
  EXPECT_FALSE(placed.animation);
  expect_near(place(placed.instances[0].world_from_object), {8, 0, 0});
}

// A mirrored instance has a mirrored mesh of its own; its movement follows, and a scale that changes sign
// turns it over.
TEST(Animation, MirroredInstancesFollow) {
  Draft draft = tree();
  draft.document["nodes"][1]["scale"] = {-1, 1, 1};
  animate(draft, 0, "translation", {0, 1}, {0, 0, 0, 4, 0, 0});
  const Scene scene = test::load(draft);
  const auto corner = [&](double seconds, float x) {
    return glm::dvec3(pose_at(scene, seconds).instances[0] * glm::dvec4(x, 0, 0, 1));
  };
  EXPECT_GT(glm::determinant(glm::dmat3(pose_at(scene, 0.5).instances[0])), 0);
  expect_near(corner(0.5, -1), {2, 0, 0});  // the mesh reaches from x = -1 to 0
  expect_near(corner(0.5, 0), {3, 0, 0});
  Draft flips = tree();
  animate(flips, 1, "scale", {0, 1}, {1, 1, 1, -1, 1, 1});
  const Scene turned = test::load(flips);
  EXPECT_GT(glm::determinant(glm::dmat3(pose_at(turned, 0).instances[0])), 0);
  EXPECT_LT(glm::determinant(glm::dmat3(pose_at(turned, 1).instances[0])), 0);
  const glm::dmat4 flat = pose_at(turned, 0.5).instances[0];  // through 0: still with an inverse
  EXPECT_NEAR(std::abs(glm::determinant(glm::dmat3(flat))), kSmallestScale, 1e-9);
}

TEST(Animation, OddChannelsAreToldAndLeftOut) {
  Draft draft = tree();
  animate(draft, 0, "translation", {0, 1}, {0, 0, 0, 4, 0, 0});
  animate(draft, 0, "translation", {0, 1}, {0, 0, 0, 9, 0, 0});
  animate(draft, 1, "weights", {0, 1}, {0, 0, 0, 9, 0, 0});
  draft.document["nodes"][4]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1};
  animate(draft, 4, "scale", {0, 1}, {1, 1, 1, 9, 1, 1});
  const Scene scene = test::load(draft);
  EXPECT_TRUE(test::warns(scene, "/animations/1/channels/0: node 0's translation is animated already"));
  EXPECT_TRUE(test::warns(scene, "/animations/2/channels/0/target/path: 'weights'"));
  EXPECT_TRUE(test::warns(scene, "/animations/3/channels/0: node 4 has a matrix"));
  expect_near(place(pose_at(scene, 1).instances[0]), {5, 0, 0});
  EXPECT_FALSE(scene.instances[1].moving);
}

TEST(Animation, BadOnesNameFileAndPlace) {
  const auto error = [](const std::function<void(Draft&)>& spoil) {
    Draft draft = tree();
    animate(draft, 0, "translation", {0, 1}, {0, 0, 0, 4, 0, 0});
    spoil(draft);
    return test::error_of("bad.glb", draft.bytes());
  };
  const auto expect = [](const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const auto sampler = [](Draft& d) -> Json& { return d.document["animations"][0]["samplers"][0]; };
  const auto channel = [](Draft& d) -> Json& { return d.document["animations"][0]["channels"][0]; };
  expect(error([&](Draft& d) { channel(d)["target"]["node"] = 55; }),
         {"bad.glb", "/animations/0/channels/0/target/node", "no node 55"});
  expect(error([&](Draft& d) { channel(d)["sampler"] = 1; }),
         {"/animations/0/channels/0/sampler", "no sampler 1"});
  expect(error([&](Draft& d) { sampler(d)["input"] = 99; }),
         {"/animations/0/samplers/0/input", "no accessor 99"});
  expect(error([&](Draft& d) { sampler(d)["output"] = 1; }),
         {"/animations/0/samplers/0/output", "components"});
  expect(error([&](Draft& d) { sampler(d)["interpolation"] = "MAGIC"; }), {"interpolation", "MAGIC"});
  expect(error([&](Draft& d) { sampler(d)["interpolation"] = "CUBICSPLINE"; }),
         {"/animations/0/samplers/0/output", "2 key frames need 6 values, there are 2"});
  const auto with = [&](const std::string& path, const std::vector<float>& times,
                        const std::vector<float>& values) {
    Draft draft = tree();
    animate(draft, 0, path, times, values);
    return test::error_of("bad.glb", draft.bytes());
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect(with("translation", {0, 1, 1}, std::vector<float>(9)), {"input", "key frame 2 is not after"});
  expect(with("translation", {1, 0}, std::vector<float>(6)), {"input", "key frame 1 is not after"});
  expect(with("translation", {-1, 0}, std::vector<float>(6)), {"key frame 0 is not a finite number"});
  expect(with("translation", {0, nan}, std::vector<float>(6)), {"key frame 1 is not a finite number"});
  expect(with("scale", {0, 1}, {1, 1, 1, 1, nan, 1}), {"output", "value 1 is not finite"});
  expect(with("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 0}), {"value 1 is a quaternion of length 0"});
}

// Fitting the still part once gives what fitting everything at the pose gives.
TEST(LightFit, FollowsTheScene) {
  for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
    Scene scene = analytic::square_over_plane(analytic::light(type, {1.5, 7, 1}));
    scene.instances[1].moving = true;
    const LightFit fit(scene, 32, 1);
    for (const double height : {0.0, 2.0, 5.5}) {
      scene.instances[1].world_from_object[3].y += height;
      const auto quick = fit.views(scene), whole = light_views(scene, 32, 1);
      ASSERT_EQ(quick.size(), whole.size());
      for (size_t i = 0; i < quick.size(); ++i) {
        EXPECT_EQ(quick[i].near, whole[i].near);
        EXPECT_EQ(quick[i].far, whole[i].far);
        EXPECT_EQ(quick[i].half_width, whole[i].half_width);
        EXPECT_EQ(quick[i].light_from_world, whole[i].light_from_world);
      }
    }
  }
}

TEST(Animation, ReferenceDependsOnThePose) {
  Draft draft = tree();
  animate(draft, 1, "translation", {0, 1}, {0, 0, 0, 4, 0, 0});
  const Scene scene = test::load(draft);
  const ReferenceSettings settings;
  EXPECT_EQ(reference_key(scene, settings), reference_key(posed(scene, 0), settings));
  EXPECT_NE(reference_key(scene, settings), reference_key(posed(scene, 0.5), settings));
}

}  // namespace
}  // namespace gnomon
