// Devices that lack what can be done without, and other implementations than lavapipe, show the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "engine/base/resource_root.h"
#include "engine/render/renderer.h"
#include "engine/vulkan/device.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tools/edt.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

// Lavapipe as it is.
const std::shared_ptr<Device>& lavapipe() {
  static const auto device = open_device({.name_part = "llvmpipe"});
  return device;
}

// What is compared with it: the device that GNOMON_TEST_DEVICE names, or lavapipe without all that can be
// done without.
const std::shared_ptr<Device>& other() {
  static const auto device = [] {
    const char* name = std::getenv("GNOMON_TEST_DEVICE");
    return name != nullptr ? open_device({.name_part = name})
                           : open_device({.name_part = "llvmpipe", .thrifty = true});
  }();
  return device;
}

RenderSettings small() {
  RenderSettings settings;
  settings.width = 320, settings.height = 180;
  return settings;
}

Graph small_graph(const fs::path& file, Values set = {}) {
  if (load_graph(file).vars.contains("shadow_map")) set["shadow_map"] = int64_t{512};
  return load_graph(file, set);
}

Image shown(const std::shared_ptr<Device>& device, const std::shared_ptr<const Scene>& scene,
            const Graph& graph, const std::string& output = "visibility", RenderSettings settings = small()) {
  Renderer renderer(device, scene, graph, settings);
  renderer.render(TimingMode::none);
  return renderer.read(output);
}

// Share of the pixels. A device that places vertices more coarsely (SwiftShader: in sixteenths of a pixel)
// has other texels on the silhouettes of its maps, and filters spread these over their kernels.
double least_alike() {
  const bool coarser = other()->limits().subPixelPrecisionBits < lavapipe()->limits().subPixelPrecisionBits;
  return coarser ? 0.98 : 0.999;
}

double share_within(const Image& a, const Image& b, double tolerance) {
  EXPECT_EQ(a.data.size(), b.data.size());
  size_t near = 0;
  for (size_t i = 0; i < a.data.size(); ++i) near += std::abs(a.data[i] - b.data[i]) <= tolerance;
  return double(near) / double(a.data.size());
}

// A light of each type: layers of one view, and of six.
std::shared_ptr<const Scene> three_lights() {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {1.5, 7, 1}));
  scene.lights.push_back(analytic::light(LightType::directional, {-3, 5, 2}));
  scene.lights.push_back(analytic::light(LightType::point, {-4, 4, -3}));
  return std::make_shared<Scene>(std::move(scene));
}

std::shared_ptr<const Scene> shipped(const char* name) {
  return std::make_shared<Scene>(load_scene(resource_root() / "assets" / "scenes" / name));
}

class OtherDevices : public testing::TestWithParam<fs::path> {};
INSTANTIATE_TEST_SUITE_P(All, OtherDevices, testing::ValuesIn(all_graphs()), test::ParameterName());

TEST_P(OtherDevices, ShowTheSame) {
  const Graph graph = small_graph(GetParam());
  const std::vector<std::shared_ptr<const Scene>> scenes = {shipped("square_plane.glb"),
                                                            shipped("area_shapes.glb"), three_lights()};
  for (const auto& scene : scenes) {
    constexpr double tolerance = 1.0 / 255;
    const double most = least_alike();
    const Image wanted = shown(lavapipe(), scene, graph), found = shown(other(), scene, graph);
    EXPECT_GE(share_within(wanted, found, tolerance), most) << scene->name;
    for (const float v : found.data) ASSERT_TRUE(v >= 0 && v <= 1) << scene->name << ": " << v;
  }
}

// What a layer of a map holds does not depend on whether layers are drawn at once.
TEST(Layers, DrawnOneByOneAreTheSameBits) {
  const auto thrifty = open_device({.name_part = "llvmpipe", .thrifty = true});
  for (const char* bias : {"none", "midpoint"}) {
    const Graph graph = small_graph(find_graph("shadow_mapping"), {{"bias", std::string(bias)}});
    RenderSettings settings = small();
    settings.captures = {"map.depth"};
    EXPECT_EQ(shown(lavapipe(), three_lights(), graph, "map.depth", settings).data,
              shown(thrifty, three_lights(), graph, "map.depth", settings).data)
        << bias;
  }
}

// Moving casters are a layer of their own there.
TEST(Layers, OfMovingCastersAreTheSameOneByOne) {
  const auto scene = shipped("pendulum.glb");
  const Graph graph = small_graph(find_graph("area_temporal"));
  const auto thrifty = open_device({.name_part = "llvmpipe", .thrifty = true});
  Renderer once(lavapipe(), scene, graph, small()), one_by_one(thrifty, scene, graph, small());
  once.play(), one_by_one.play();
  for (int frame = 0; frame < 3; ++frame) {
    once.render(TimingMode::none), one_by_one.render(TimingMode::none);
  }
  constexpr double tolerance = 1.0 / 255, most = 0.999;
  EXPECT_GE(share_within(once.read("visibility"), one_by_one.read("visibility"), tolerance), most);
}

TEST(OtherDevicesEdt, DistanceTransformsAreExact) {
  auto mask = std::make_shared<Image>(151, 97, std::vector<std::string>{"Y"});
  std::mt19937 random(1);
  for (float& v : mask->data) v = random() % 200 == 0 ? 1.0f : 0.0f;
  for (const char* algorithm : {"banded_exact", "bounded_exact"}) {
    const EdtSettings settings{.algorithm = algorithm, .warmup = 0};
    const EdtError error = edt_error(run_edt(other(), mask, settings).nearest,
                                     run_edt(lavapipe(), mask, settings).nearest, mask->width);
    EXPECT_EQ(error.wrong, 0u) << algorithm;
  }
}

}  // namespace
}  // namespace gnomon
