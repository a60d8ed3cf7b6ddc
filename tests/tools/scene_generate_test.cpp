// The generated scenes: the same bytes every time, watertight, facing outwards.
#include "tools/scene_generate.h"
#include "engine/base/resource_root.h"
#include "engine/light/scene_facts.h"
#include "tests/parameter_name.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"
#include "tools/scene_info.h"

namespace gnomon {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class GeneratedScene : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("gnomon_generate_" + GetParam());
    generate_scene(GetParam(), folder_);
    file_ = folder_ / (GetParam() + ".glb");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_, file_;
};

TEST_P(GeneratedScene, IsTheSameEveryTimeAndTheCommittedFile) {
  const std::string bytes = bytes_of(file_);
  EXPECT_EQ(bytes, scene_bytes(GetParam()));
  EXPECT_EQ(bytes, bytes_of(resource_root() / "assets" / "scenes" / (GetParam() + ".glb")));
  EXPECT_LT(bytes.size(), 1000000u);
}

TEST_P(GeneratedScene, LoadsWithoutWarnings) {
  const Scene scene = load_scene(file_);
  EXPECT_EQ(scene.warnings.messages, std::vector<std::string>{});
  EXPECT_EQ(scene.warnings.degenerate_triangles, 0u);
  EXPECT_EQ(scene.warnings.nonfinite_triangles, 0u);
  const bool sun = GetParam() == "hills" || GetParam() == "sun_and_lamp";
  ASSERT_EQ(scene.lights.size(), GetParam() == "area_shapes" ? 5u : GetParam() == "sun_and_lamp" ? 2u : 1u);
  ASSERT_EQ(scene.cameras.size(), GetParam() == "pendulum" ? 2u : 1u);
  EXPECT_EQ(scene.lights[0].type, sun ? LightType::directional : LightType::spot);
  EXPECT_EQ(scene.lights[0].area.has_value(), GetParam() != "hills");
  const SceneFacts facts = scene_facts(scene, scene.cameras[0], 16.0 / 9.0);
  EXPECT_EQ(facts.shadowless[0], "");
  EXPECT_EQ(facts.has_alpha_mask, GetParam() == "foliage");
}

// Solids are closed: only grounds, leaves and the square blocker are not.
TEST_P(GeneratedScene, SolidsAreWatertight) {
  const std::set<std::string> open = {"ground", "lawn", "floor", "leaves", "shrubs", "sprays", "blocker"};
  const Scene scene = load_scene(file_);
  for (const Mesh& mesh : scene.meshes) {
    EXPECT_EQ(mesh.watertight, open.count(mesh.name) == 0) << mesh.name;
    EXPECT_EQ(scene.materials[mesh.material].double_sided, !mesh.watertight) << mesh.name;
  }
}

// The signed volume of a closed mesh is positive exactly when its triangles face outwards.
TEST_P(GeneratedScene, SolidsFaceOutwards) {
  for (const Mesh& mesh : load_scene(file_).meshes) {
    if (!mesh.watertight) continue;
    double volume = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const auto p = [&](size_t k) {
        return glm::dvec3(mesh.positions[mesh.indices[i + k]]) - mesh.bounds.centre();
      };
      volume += glm::dot(p(0), glm::cross(p(1), p(2))) / 6.0;
    }
    EXPECT_GT(volume, 0.0) << mesh.name;
  }
}

TEST_P(GeneratedScene, NormalsAgreeWithFaces) {
  for (const Mesh& mesh : load_scene(file_).meshes) {
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const uint32_t* v = &mesh.indices[i];
      const glm::dvec3 a(mesh.positions[v[0]]), b(mesh.positions[v[1]]), c(mesh.positions[v[2]]);
      const glm::dvec3 face = glm::normalize(glm::cross(b - a, c - a));
      const glm::dvec3 mean(mesh.normals[v[0]] + mesh.normals[v[1]] + mesh.normals[v[2]]);
      ASSERT_GT(glm::dot(face, mean), 0.0) << mesh.name << " triangle " << i / 3;
    }
  }
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const SceneGenerator& generator : scene_generators()) result.push_back(generator.name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(All, GeneratedScene, testing::ValuesIn(names()), test::ParameterName());

TEST(SceneGenerate, UnknownNameIsAnErrorWithAHint) {
  try {
    scene_bytes("fense");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'fence'"), std::string::npos) << error.what();
  }
}

TEST(SceneGenerate, SphereHasItsStatedMeasures) {
  const Scene scene = load_scene(resource_root() / "assets/scenes/sphere_plane.glb");
  const glm::dvec3 centre(sphere_plane::kSphereCentre[0], sphere_plane::kSphereCentre[1],
                          sphere_plane::kSphereCentre[2]);
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.name != "sphere") continue;
    for (const glm::vec3& p : mesh.positions)
      ASSERT_NEAR(glm::length(glm::dvec3(p) - centre), sphere_plane::kSphereRadius, std::sqrt(3.0) * 0x1p-17);
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {  // the middle of a face is its deepest point
      const glm::dvec3 middle =
          (glm::dvec3(mesh.positions[mesh.indices[i]]) + glm::dvec3(mesh.positions[mesh.indices[i + 1]]) +
           glm::dvec3(mesh.positions[mesh.indices[i + 2]])) /
          3.0;
      ASSERT_GT(glm::length(middle - centre),
                sphere_plane::kSphereRadius * (1.0 - sphere_plane::kTessellationError));
    }
  }
  EXPECT_EQ(scene.lights[0].area->width, sphere_plane::kLightSide);
}

TEST(SceneGenerate, SquareAndLightHaveTheirStatedMeasures) {
  const Scene scene = load_scene(resource_root() / "assets/scenes/square_plane.glb");
  const Light& light = scene.lights[0];
  EXPECT_EQ(glm::dvec3(light.world_from_light[3]), glm::dvec3(0, square_plane::kLightHeight, 0));
  EXPECT_NEAR(glm::dot(glm::dvec3(light.world_from_light[0]), glm::dvec3(1, 0, 0)), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(glm::dvec3(light.world_from_light[1]), glm::dvec3(0, 0, -1)), 1.0, 1e-12);
  EXPECT_EQ(light.area->width, square_plane::kLightSide);
  EXPECT_EQ(scene.bounds.max.y, square_plane::kBlockerHeight);
  EXPECT_EQ(scene.bounds.max.x, square_plane::kGroundHalf);
}

TEST(SceneInfo, TellsWhatMoves) {
  const auto text = [](const char* name) {
    return describe_scene(load_scene(resource_root() / "assets/scenes" / name));
  };
  EXPECT_NE(text("pendulum.glb").find("animation: 2 s, moves 1 instances, 1 cameras, 0 lights"),
            std::string::npos);
  EXPECT_NE(text("moving_light.glb").find("animation: 2 s, moves 0 instances, 0 cameras, 1 lights"),
            std::string::npos);
  EXPECT_EQ(text("foliage.glb").find("animation"), std::string::npos);
}

TEST(SceneGenerate, AreaShapesHaveTheirStatedMeasures) {
  using Shape = AreaLight::Shape;
  namespace s = area_shapes;
  const Scene scene = load_scene(resource_root() / "assets/scenes/area_shapes.glb");
  ASSERT_EQ(scene.lights.size(), 5u);
  const double disc = 2 * s::kDiscRadius, sphere = 2 * s::kSphereRadius;
  std::vector<glm::dvec2> outline;
  for (const auto& p : s::kPolygon) outline.emplace_back(p[0], p[1]);
  const AreaLight areas[] = {{Shape::rectangle, s::kRectangleWidth, s::kRectangleHeight, {}, {}},
                             {Shape::disc, disc, disc, {}, {}},
                             {Shape::sphere, sphere, sphere, {}, {}},
                             polygon_light(outline),
                             {Shape::rectangle, s::kWindowSide, s::kWindowSide, {}, 0}};
  for (size_t i = 0; i < 5; ++i) {
    const Light& light = scene.lights[i];
    EXPECT_EQ(*light.area, areas[i]) << light.name;
    EXPECT_EQ(glm::dvec3(light.world_from_light[3]),
              glm::dvec3(s::kLights[i][0], s::kLightHeight, s::kLights[i][1]));
    EXPECT_NEAR(light.world_from_light[0].x, 1.0, 1e-12);
    EXPECT_NEAR(light.world_from_light[1].z, -1.0, 1e-12);
  }
  const double half = 0.25 * s::kWindowSide;  // one diagonal of panes is black
  EXPECT_EQ(emission_at(scene, areas[4], {half, half}), glm::dvec3(0.0));
  EXPECT_EQ(emission_at(scene, areas[4], {-half, -half}), glm::dvec3(0.0));
  EXPECT_EQ(emission_at(scene, areas[4], {-half, half}).r, 1.0);
  EXPECT_EQ(emission_at(scene, areas[4], {half, -half}).b, 1.0);
}

TEST(SceneGenerate, SunAndLampHaveTheirStatedSizes) {
  namespace s = sun_and_lamp;
  const Scene scene = load_scene(resource_root() / "assets/scenes/sun_and_lamp.glb");
  ASSERT_EQ(scene.lights.size(), 2u);
  const Light &sun = scene.lights[0], &lamp = scene.lights[1];
  EXPECT_NEAR(angular_diameter(*sun.area) * 180 / std::acos(-1.0), s::kSunDegrees, 1e-12);
  const glm::dvec3 direction(s::kSunDirection[0], s::kSunDirection[1], s::kSunDirection[2]);
  EXPECT_NEAR(glm::dot(glm::dvec3(sun.world_from_light[2]), glm::normalize(direction)), -1, 1e-12);
  EXPECT_EQ(lamp.type, LightType::point);
  EXPECT_EQ(*lamp.area,
            (AreaLight{AreaLight::Shape::sphere, 2 * s::kLampRadius, 2 * s::kLampRadius, {}, {}}));
  EXPECT_EQ(glm::dvec3(lamp.world_from_light[3]), glm::dvec3(s::kLamp[0], s::kLamp[1], s::kLamp[2]));
  const std::string text = describe_scene(scene);
  EXPECT_NE(text.find(", angular diameter 0.53 degrees\n"), std::string::npos) << text;
  EXPECT_NE(text.find(", area: sphere of radius 0.2\n"), std::string::npos) << text;
}

TEST(SceneInfo, NamesTheShapesOfAreaLights) {
  const std::string text = describe_scene(load_scene(resource_root() / "assets/scenes/area_shapes.glb"));
  for (const char* part : {"area: rectangle 1.6 x 0.8\n", "area: disc of radius 0.6\n",
                           "area: sphere of radius 0.6\n", "area: polygon of 4 corners in 1.5 x 1.5\n",
                           "area: rectangle 1.2 x 1.2 with emission texture window 2x2\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(SceneInfo, NamesWhatIsThere) {
  const std::string text = describe_scene(load_scene(resource_root() / "assets/scenes/foliage.glb"));
  for (const char* part : {"foliage", "leaves", "masked at alpha 0.5", "texture spray 64x64", "spot",
                           "cameras: 1", "warnings: 0"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

}  // namespace
}  // namespace gnomon
