// The pass shadow_test: the shadow-map test of every camera pixel.
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/light/view_set.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/frame/behind_all.h"
#include "passes/map/receiver_ports.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class ShadowTest : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Tests every camera pixel against the shadow map.");
    d.cite("Williams 1978; Macedo 2018, eq. 3.2");
    d.kind(PassKind::raster);
    const ImageShape visibility = declare_receiver(d, Access::sampled | Access::depth_test);
    d.reads_around("shadow_map", 1);
    d.output("visibility", Access::color, true, visibility, "0 in shadow, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::hard);
  }

  void prepare(Environment& e) override {
    const auto& of_light = e.views("views").of_light;
    for (size_t i = 0; i < of_light.size(); ++i) {
      const bool shadowless = !e.scene_facts().shadowless[i].empty();
      forms_.push_back({shadowless, of_light[i].count});
      if (!tests_.contains(forms_[i])) tests_[forms_[i]] = make(e, forms_[i]);
    }
    report_bias(e);
  }

  void record(Context& c) override {
    constexpr std::array<float, 4> kLit{1, 1, 1, 1};
    for (uint32_t light = 0; light < forms_.size(); ++light) {
      const Pipeline& test = tests_.at(forms_[light]);
      c.render({{{"visibility", kLit, light}}, DepthTarget{"depth", {}}, {}}, [&] {
        c.push(test, std::array<uint32_t, 2>{light, c.views("views").of_light[light].first});
        c.draw_fullscreen(test);
      });
    }
  }

 private:
  using Form = std::pair<bool, uint32_t>;  // shadowless; number of views

  static Pipeline make(Environment& e, const Form& form) {
    RasterState state = behind_all(e);
    state.vertex = "hard/shadow_test.vert.glsl";
    state.fragment = "hard/shadow_test.glsl";
    state.colors = {VK_FORMAT_R32_SFLOAT};
    if (form.first) state.defines.emplace_back("SHADOWLESS", "1");
    state.defines.emplace_back("LIGHT_VIEWS", std::to_string(form.second));
    return e.raster(state);
  }

  std::vector<Form> forms_;  // per light
  std::map<Form, Pipeline> tests_;
};

GNOMON_PASS("shadow_test", ShadowTest);

}  // namespace
}  // namespace gnomon
