// Shadow volumes against the ray tracer: open, closed and folded meshes, the camera inside.
#include <random>

#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using namespace hard_shadow;
using analytic::add;
using analytic::light;
using analytic::square;

Material double_sided() {
  Material m;
  m.double_sided = true;
  return m;
}

const glm::dvec3 kLightAt(1.5, 7, 1);

Scene sphere_over_plane(LightType type) {
  Scene scene;
  add(scene, square(20), {0, 0, 0});
  add(scene, analytic::sphere(1, 24, 48), {0, 2, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 0, 0}));
  scene.lights.push_back(light(type, kLightAt));
  return scene;
}

// Triangles in all directions, seen and lit from both sides: nothing is closed, most edges are bare.
Scene leaves(LightType type, int count) {
  Scene scene;
  std::mt19937 random(7);
  const auto unit = [&] { return double(random()) / double(std::mt19937::max()); };
  Mesh mesh;
  mesh.name = "leaves";
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 at(4 * unit() - 2, 0.5 + 3 * unit(), 4 * unit() - 2);
    for (uint32_t k = 0; k < 3; ++k) {
      mesh.indices.push_back(uint32_t(mesh.positions.size()));
      mesh.positions.push_back(glm::vec3(at + 0.6 * glm::dvec3(unit(), unit(), unit())));
      mesh.normals.push_back({0, 1, 0});
      mesh.uvs.emplace_back(0);
    }
  }
  analytic::finish(mesh);
  add(scene, square(20), {0, 0, 0});
  add(scene, mesh, {0, 0, 0}, double_sided());
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 1, 0}));
  scene.lights.push_back(light(type, kLightAt));
  return scene;
}

// A strip bent over a ridge: one welded mesh, one edge inside, six bare.
Mesh tent() {
  Mesh mesh;
  mesh.name = "tent";
  mesh.positions = {{-1, 0, -1}, {-1, 0, 1}, {0, 1, 1}, {0, 1, -1}, {1, 0, 1}, {1, 0, -1}};
  mesh.indices = {0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5};
  mesh.normals.assign(6, {0, 1, 0});
  mesh.uvs.assign(6, {0, 0});
  analytic::finish(mesh);
  return mesh;
}

void expect_error(const Scene& scene, const RenderSettings& s, double bound, const char* what) {
  const Frame run = render("shadow_volumes", scene, s);
  const Misclassified e = compare(run, trace(scene, s));
  EXPECT_GT(e.counted, 1000u) << what;
  EXPECT_GT(e.shadowed, 0u) << what;
  EXPECT_LE(e.share(), bound) << what << ": " << e.wrong << " of " << e.counted;
}

struct Case {
  LightType type;
  bool reversed_z;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << analytic::name_of(c.type) << (c.reversed_z ? " reversed" : " standard");
}

class ShadowVolumesCase : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, ShadowVolumesCase,
                         testing::Values(Case{LightType::spot, true}, Case{LightType::spot, false},
                                         Case{LightType::point, true}, Case{LightType::point, false},
                                         Case{LightType::directional, true},
                                         Case{LightType::directional, false}),
                         test::ParameterName());

// Shares of the counted pixels: a handful of those that a true edge passes within rounding of their centre.
constexpr double kBound = 5e-4;

TEST_P(ShadowVolumesCase, OpenSquare) {
  const Scene scene = analytic::square_over_plane(light(GetParam().type, kLightAt));
  expect_error(scene, settings(GetParam().reversed_z), kBound, "square over plane");
}

TEST_P(ShadowVolumesCase, ClosedSphere) {
  expect_error(sphere_over_plane(GetParam().type), settings(GetParam().reversed_z), kBound,
               "sphere over plane");
}

TEST_P(ShadowVolumesCase, Leaves) {
  expect_error(leaves(GetParam().type, 200), settings(GetParam().reversed_z), kBound, "leaves");
}

// The camera stands in the shadow: only z-fail counts rightly, and both its caps are needed.
TEST_P(ShadowVolumesCase, CameraInsideAVolume) {
  for (const bool closed : {false, true}) {
    Scene scene = closed ? sphere_over_plane(GetParam().type)
                         : analytic::square_over_plane(light(GetParam().type, kLightAt));
    scene.cameras[0] = analytic::camera({-0.25, 0.6, -0.1}, {-3, 0.2, 1});
    const RenderSettings s = settings(GetParam().reversed_z);
    const Frame run = render("shadow_volumes", scene, s);
    EXPECT_EQ(run.facts.at("volumes.light0.z_fail"), 1.0);
    const Misclassified e = compare(run, trace(scene, s));
    EXPECT_GT(e.shadowed, 100u);
    EXPECT_LE(e.share(), kBound) << (closed ? "sphere: " : "square: ") << e.wrong << " of " << e.counted;
  }
}

TEST_P(ShadowVolumesCase, ZPassWhereTheCameraIsOutside) {
  const Scene scene = analytic::square_over_plane(light(GetParam().type, kLightAt));
  const Frame run = render("shadow_volumes", scene, settings(GetParam().reversed_z));
  EXPECT_EQ(run.facts.at("volumes.light0.z_fail"), 0.0);
}

// A double-sided sheet is dark where the camera sees the side away from the light, and does not shadow its
// lit side, whichever way its triangles are wound, with z-fail (a box around the camera) and with z-pass.
TEST_P(ShadowVolumesCase, SheetFromBothSides) {
  for (const bool up : {true, false})
    for (const bool above : {true, false})
      for (const bool enclosed : {true, false}) {
        Scene scene;
        add(scene, square(3, up), {0, 0, 0}, double_sided());
        const glm::dvec3 eye(1, above ? 4 : -4, 2);
        // A speck of a mesh at the camera's near plane, out of its sight and the light's way.
        if (enclosed) add(scene, square(1e-4f), eye, double_sided());
        scene.cameras.push_back(analytic::camera(eye, {0, 0, 0}));
        scene.lights.push_back(light(GetParam().type, kLightAt));
        RenderSettings s = settings(GetParam().reversed_z, 80, 60);
        s.keep_all = true;  // a sheet alone needs no technique
        const Frame run = render("shadow_volumes", scene, s);
        const Reference reference = trace(scene, s);
        EXPECT_EQ(run.facts.at("volumes.light0.z_fail"), enclosed || !above ? 1.0 : 0.0);
        size_t different = 0, seen = 0;
        for (size_t i = 0; i < reference.depth.size(); ++i) {
          if (!std::isfinite(reference.depth[i])) continue;
          ++seen;
          different += run.visibility[0][i] != (above ? 1.0f : 0.0f);
        }
        EXPECT_GT(seen, 1000u);
        // The speck's shadow is smaller than a pixel.
        EXPECT_LE(different, enclosed ? 1u : 0u) << "wound up " << up << ", seen from above " << above;
      }
}

TEST_P(ShadowVolumesCase, FoldedSheet) {
  for (const glm::dvec3 eye : {glm::dvec3(4, 5, 4), glm::dvec3(-5, 1.5, 2), glm::dvec3(0.3, 0.3, 0.9)}) {
    Scene scene;
    add(scene, square(20), {0, 0, 0});
    add(scene, tent(), {0, 0.25, 0}, double_sided());
    scene.cameras.push_back(analytic::camera(eye, {0, 0.4, 0}));
    scene.lights.push_back(light(GetParam().type, {4, 2.5, 1}));
    expect_error(scene, settings(GetParam().reversed_z), kBound, "tent");
  }
}

TEST(ShadowVolumes, SeveralLightsInTheirLayers) {
  Scene scene = sphere_over_plane(LightType::spot);
  scene.lights.push_back(light(LightType::directional, {-3, 5, 2}));
  scene.lights.push_back(light(LightType::point, {-4, 4, -3}));
  expect_error(scene, settings(true), kBound, "three lights");
}

TEST(ShadowVolumes, MirroredAndScaledInstances) {
  Scene scene = sphere_over_plane(LightType::point);
  scene.instances[1].world_from_object = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 2, 0)) *
                                         glm::scale(glm::dmat4(1.0), glm::dvec3(-1.5, 0.5, 1));
  expect_error(scene, settings(true), kBound, "mirrored");
}

TEST(ShadowVolumes, FarFromTheOrigin) {
  const Scene scene = analytic::moved(sphere_over_plane(LightType::spot), {1e6, -2e6, 5e5});
  expect_error(scene, settings(true), kBound, "moved by 2e6");
}

// Seen from within, a closed double-sided mesh is not a solid: its inside lies in the shadow of its lit side.
TEST(ShadowVolumes, InsideAClosedDoubleSidedMesh) {
  Scene scene;
  add(scene, analytic::sphere(5, 24, 48), {0, 0, 0}, double_sided());
  add(scene, analytic::sphere(0.5, 12, 24), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({3, 0, 0}, {0, -1, 0}));
  scene.lights.push_back(light(LightType::point, {0, 9, 0}));
  const RenderSettings s = settings(true);
  const Misclassified outer = compare(render("shadow_volumes", scene, s), trace(scene, s));
  EXPECT_LE(outer.share(), kBound) << outer.wrong << " of " << outer.counted;
  scene.lights[0] = light(LightType::point, {2, 3, 0.5});
  expect_error(scene, s, kBound, "light within");
}

// The stencil counts to 255 and wraps: many layers are dark, except exactly 256 of them.
TEST(ShadowVolumes, CountsWrapAround) {
  for (const int layers : {255, 256, 257}) {
    Scene scene;
    add(scene, square(20), {0, 0, 0});
    Mesh stack;
    for (int i = 0; i < layers; ++i)
      for (const glm::vec3 p : {glm::vec3(-1, 0, -1), glm::vec3(-1, 0, 1), glm::vec3(1, 0, 0)}) {
        stack.indices.push_back(uint32_t(stack.positions.size()));
        stack.positions.push_back(p + glm::vec3(0, 2.0f + 0.01f * float(i), 0));
        stack.normals.push_back({0, 1, 0});
        stack.uvs.emplace_back(0);
      }
    analytic::finish(stack);
    add(scene, stack, {0, 0, 0});
    scene.cameras.push_back(analytic::camera({0, 1.2, 3}, {0, 0, 0}));
    scene.lights.push_back(light(LightType::directional, {0, 10, 0}));
    const RenderSettings s = settings(true, 40, 30);
    const Frame run = render("shadow_volumes", scene, s);
    EXPECT_EQ(run.visibility[0][15 * 40 + 20], layers == 256 ? 1.0f : 0.0f) << layers;
  }
}

TEST(ShadowVolumes, NamesWhatItHandlesInAnotherWay) {
  Scene scene = leaves(LightType::spot, 3);
  scene.materials[1].alpha_masked = true;
  const Frame run = render("shadow_volumes", scene, settings(true, 32, 24));
  int open = 0, masked = 0;
  for (const std::string& w : run.warnings) {
    open += w.find("open mesh '', 'leaves':") != std::string::npos;
    masked += w.find("alpha-masked mesh 'leaves':") != std::string::npos;
  }
  EXPECT_EQ(open, 1);
  EXPECT_EQ(masked, 1);
}

// The camera looks through the back of a single-sided sheet: the volume's near cap is in plain sight.
TEST(ShadowVolumes, SingleSidedSheetSeenThrough) {
  for (const bool up : {true, false}) {
    Scene scene;
    add(scene, square(20), {0, 0, 0});
    add(scene, square(1, up), {0, 2, 0});
    scene.cameras.push_back(analytic::camera({0.5, 9, 1}, {0, 0, 0}));
    scene.lights.push_back(light(LightType::spot, {2, 5, 1}));
    expect_error(scene, settings(true), kBound, up ? "front seen" : "back seen");
  }
}

// What a closed single-sided mesh hides from nobody: a room whose faces look inwards, seen through its culled
// wall; and a shell with the camera in it. Lights without and within.
TEST_P(ShadowVolumesCase, WhatIsSeenThroughCulledWalls) {
  const glm::dvec3 without(3, 6.5, 2), within(0.5, 1.5, 0.7);
  for (const bool room : {true, false})
    for (const glm::dvec3& at : {without, within}) {
      Scene scene;
      add(scene, analytic::cube(3, !room), {0, 0, 0});
      add(scene, analytic::cube(0.5), {0, -2, 0});
      add(scene, square(20), {0, -4, 0});
      scene.cameras.push_back(room ? analytic::camera({7, 6, 9}, {0, -1, 0})
                                   : analytic::camera({2, 1, 2.2}, {0, -2.5, 0}));
      scene.lights.push_back(light(GetParam().type, at, {0, -3, 0}));
      const RenderSettings s = settings(GetParam().reversed_z);
      const Misclassified e = compare(render("shadow_volumes", scene, s), trace(scene, s));
      EXPECT_GT(e.counted, 1000u) << room;
      EXPECT_LE(e.share(), kBound) << (room ? "room" : "shell") << (at == within ? ", light within: " : ": ")
                                   << e.wrong << " of " << e.counted;
    }
}

// The camera goes into a shell and out again.
TEST(ShadowVolumes, TheCameraMovesIntoAShell) {
  Scene scene;
  add(scene, analytic::cube(3), {0, 0, 0});
  add(scene, square(2), {0, -1, 0});
  add(scene, square(20), {0, -4, 0});
  scene.lights.push_back(light(LightType::spot, {1, 9, 2}, {0, -3, 0}));
  for (const glm::dvec3 eye :
       {glm::dvec3(0, 1, 2), glm::dvec3(0, 1, 2.95), glm::dvec3(0, 1, 3.05), glm::dvec3(0, 7, 8)}) {
    scene.cameras = {analytic::camera(eye, {0, -2, 0})};
    const RenderSettings s = settings(true);
    const Misclassified e = compare(render("shadow_volumes", scene, s), trace(scene, s));
    EXPECT_LE(e.share(), kBound) << eye.z << ": " << e.wrong << " of " << e.counted;
  }
}

}  // namespace
}  // namespace gnomon
