// Small scenes made by code: the same bytes every time, one .glb of less than 1 MB each.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

struct SceneGenerator {
  std::string name;
  std::string description;  // one sentence
};

// In alphabetical order.
std::vector<SceneGenerator> scene_generators();

// Writes out_dir/NAME.glb (through a file beside it). Error for an unknown name or a folder that cannot be
// written.
void generate_scene(const std::string& name, const std::filesystem::path& out_dir);

// The bytes that generate_scene() writes.
std::string scene_bytes(const std::string& name);

// Exact measures of the analytic scenes, world units; the ground is the plane y = 0 in all. All light
// sources face straight down, their local x is the world's x, their local y the world's -z.
namespace sphere_plane {
constexpr double kSphereRadius = 1.5;
constexpr double kSphereCentre[3] = {0.0, 2.5, 0.0};
constexpr double kLight[3] = {2.0, 10.0, -1.0};
constexpr double kLightSide = 0.4;   // of the square area light
constexpr double kGroundHalf = 6.0;  // the ground is [-6, 6] x [-6, 6]
// Vertices lie on the sphere (to 2^-17); the faces are inside it by at most this share of the radius.
constexpr double kTessellationError = 4e-4;
}  // namespace sphere_plane

// The blocker is the square [-1, 1] x [-1, 1] at y = 2, the light is above its centre. Hard shadow: the
// square of half side kBlockerHalf * kLightHeight / (kLightHeight - kBlockerHeight) = 4/3. Area light of side
// s: umbra of half side 4/3 - (s / 2) / 3, penumbra out to 4/3 + (s / 2) / 3, visibility separable in x and z
// (linear in between).
namespace square_plane {
constexpr double kBlockerHalf = 1.0;
constexpr double kBlockerHeight = 2.0;
constexpr double kLightHeight = 8.0;
constexpr double kLightSide = 0.32;
constexpr double kGroundHalf = 5.5;
}  // namespace square_plane

// The blocker of square_plane under five area lights, in this order: a rectangle, a disc, a sphere, a polygon
// (an arrow head, not convex) and a window: a rectangle whose emission is a texture, nearest, of which the
// panes of one diagonal are black.
namespace area_shapes {
constexpr double kBlockerHalf = 1.0;
constexpr double kBlockerHeight = 2.0;
constexpr double kLightHeight = 8.0;
constexpr double kLights[5][2] = {{-1.5, -1.5}, {1.5, -1.5}, {0.0, 0.0}, {-1.5, 1.5}, {1.5, 1.5}};  // x, z
constexpr double kRectangleWidth = 1.6, kRectangleHeight = 0.8;
constexpr double kDiscRadius = 0.6, kSphereRadius = 0.6;
constexpr double kPolygon[4][2] = {{-0.75, -0.5}, {0.0, -0.25}, {0.75, -0.5}, {0.0, 0.75}};
constexpr double kWindowSide = 1.2;
constexpr int kWindowPanes = 2;  // a side
constexpr double kGroundHalf = 5.5;
}  // namespace area_shapes

// The sun's angular diameter a is 0.53 degrees, so that its penumbrae are 2 tan(a / 2) = 0.00925 of the way
// from the caster wide. The lamp is a sphere.
namespace sun_and_lamp {
constexpr double kBlockerHalf = 1.0;
constexpr double kBlockerHeight = 6.0;
constexpr double kSunDirection[3] = {0.5, -2.0, 0.3};  // the way it shines
constexpr double kSunDegrees = 0.53;
constexpr double kLamp[3] = {-2.5, 3.0, 1.5};
constexpr double kLampRadius = 0.2;
constexpr double kGroundHalf = 5.5;
}  // namespace sun_and_lamp

}  // namespace gnomon
