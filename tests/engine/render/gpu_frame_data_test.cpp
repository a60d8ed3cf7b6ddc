// What shaders see of the lights: sizes.
#include <cstring>
#include <fstream>

#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/area_light.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

constexpr uint32_t kSide = 8;

// A pixel a component of each light's size.
class ShowSizes : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.output("visibility", Access::storage_write, false, {{kSide, kSide}, 1, 1, VK_FORMAT_R32_SFLOAT},
             "sizes");
  }
  void prepare(Environment& e) override {
    const auto file = test::scratch_folder() / "show_sizes.glsl";
    std::ofstream(file) << R"(#include "frame/frame.glsl"
      layout(local_size_x = 8, local_size_y = 8) in;
      void main() {
        ivec2 at = ivec2(gl_GlobalInvocationID.xy);
        bool shown = at.y < LIGHT_COUNT && at.x < 4;
        imageStore(visibility, at, vec4(shown ? lights[min(at.y, LIGHT_COUNT - 1)].size[at.x & 3] : 0.0));
      })";
    pipeline_ = e.compute(file.string());
  }
  void record(Context& c) override { c.dispatch_over(pipeline_, {kSide, kSide}); }

 private:
  Pipeline pipeline_;
};
GNOMON_PASS("test_show_sizes", ShowSizes);

TEST(FrameData, ShadersKnowTheSizesOfLights) {
  using Shape = AreaLight::Shape;
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {1, 6, 1}));
  scene.lights[0].area = AreaLight{Shape::rectangle, 2, 0.5, {}, {}};
  scene.lights.push_back(analytic::light(LightType::point, {-1, 6, 1}));
  scene.lights[1].area = AreaLight{Shape::sphere, 1.5, 1.5, {}, {}};
  scene.lights.push_back(analytic::light(LightType::directional, {-1, 6, 1}));
  scene.lights[2].area = angular_disc(0.02);
  scene.lights.push_back(analytic::light(LightType::spot, {-1, 6, -1}));  // without one
  const auto file = test::scratch_folder() / "sizes.json";
  std::ofstream(file)
      << R"({ "schema": 1, "name": "sizes", "passes": [ { "id": "show", "type": "test_show_sizes" } ],
    "outputs": { "visibility": "show.visibility" } })";
  Renderer renderer(hard_shadow::device(), std::make_shared<Scene>(scene), load_graph(file),
                    hard_shadow::settings(true, kSide, kSide));
  renderer.render(TimingMode::none);
  const Image shown = renderer.read("visibility");
  const float sizes[4][4] = {
      {1, 0.25f, 0, 0}, {0.75f, 0.75f, 2, 0}, {0, 0, 1, std::tan(0.01f)}, {0, 0, 0, 0}};
  for (size_t light = 0; light < 4; ++light)
    for (size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(shown.plane(size_t{0})[light * kSide + k], sizes[light][k], 1e-7) << light << ' ' << k;
}

}  // namespace
}  // namespace gnomon
