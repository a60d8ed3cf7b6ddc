// The pass screen_penumbra: hard shadows become soft on the screen.
#include <array>
#include <cmath>

#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/frame/pixel_list.h"
#include "passes/screen/screen_kernel.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

constexpr uint32_t kCell = 8;    // pixels a side; shaders: CELL
constexpr double kCutOff = 2.5;  // standard deviations of the Gaussian; shaders: CUT_OFF
constexpr Access kBoth = Access::storage_read | Access::storage_write;

class ScreenPenumbra : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Averages hard shadows on the screen over a penumbra whose width each pixel knows.");
    d.cite("Macedo 2018, ch. 2.5.4 and 5.4; MohammadBagher et al. 2010");
    d.constant("CELL", int64_t{kCell});
    d.constant("CUT_OFF", kCutOff);
    const ImageShape image = d.input("source", Access::sampled, true, "hard shadows; a layer a light");
    d.input("width", Access::sampled, true, "of the penumbra at the receiver, world units; a layer a light");
    d.input_behind("views", "source", Access::uniform, "what the shadow map's layers show");
    d.offer_behind("source", "visibility");
    d.input("depth", Access::sampled, false, "the camera's device depth");
    d.input("geometric", Access::sampled, false, "octahedral geometric normal");
    declare_surface_test(d);
    const bool separable = d.choice("form", "plane", {"plane", "separable"},
                                    "plane: the light's copy on the receiver's tangent plane; separable: as "
                                    "published, a square of pixels along "
                                    "x, then along y") == "separable";
    d.integer("line_taps", 31, 1, 255, "pixels",
              "separable: of a line at most; when it has fewer, each is one");
    d.choice("kernel", "box", {"box", "gaussian"},
             "the light's own shape, or a Gaussian of the same variance");
    d.integer("taps", 12, 1, 64, "pixels", "a side of the kernel at most; when it has fewer, each is one");
    const ImageShape shape{image.extent, d.setting().lights, 1, VK_FORMAT_R32_SFLOAT};
    if (separable)
      d.transient("rows", kBoth, true, shape, "averaged along x");
    else
      declare_lists(d, shape);
    d.output("visibility", Access::storage_write, true, shape, "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::soft);
  }

  void prepare(Environment& e) override {
    separable_ = e.params().choice("form") == "separable";
    // A box of half width 1 has a standard deviation of 1 / sqrt(3), a disc of radius 1 one of 1 / 2.
    const bool gaussian = e.params().choice("kernel") == "gaussian";
    for (const Light& light : e.scene().lights)
      reach_.push_back(gaussian ? float(kCutOff * (is_round(light) ? 0.5 : 1 / std::sqrt(3.0))) : 1.0f);
    if (separable_) {
      along_x_ = e.compute("screen/screen_penumbra_line.glsl");
      along_y_ = e.compute("screen/screen_penumbra_line.glsl", {{"ALONG_Y_AXIS", "1"}});
      return;
    }
    cells_ = e.compute("screen/screen_penumbra_cells.glsl");
    find_ = e.compute("screen/screen_penumbra_find.glsl");
    filter_ = e.compute("screen/screen_penumbra.glsl");
  }

  void record(Context& c) override {
    const ImageShape shape = c.shape("visibility");
    if (!separable_) c.dispatch_over(cells_, c.shape("cells").extent, shape.layers);
    for (uint32_t layer = 0; layer < shape.layers; ++layer) {
      const Push push{layer, reach_[layer]};
      if (separable_)
        filter_lines(c, shape, push);
      else
        filter_listed(c, shape, push);
    }
  }

 private:
  struct Push {
    uint32_t layer;
    float reach;
  };

  static void declare_lists(Declaration& d, const ImageShape& shape) {
    const Extent cells{divide_up(shape.extent.width, kCell), divide_up(shape.extent.height, kCell)};
    d.transient("cells", kBoth, true, {cells, shape.layers, 1, VK_FORMAT_R32G32_SFLOAT},
                "least and greatest visibility of each cell of 8x8 pixels");
    declare_pixel_list(d, shape.extent, "pixels with light and shadow both in their kernel");
  }

  void filter_lines(Context& c, const ImageShape& shape, const Push& push) const {
    c.push(along_x_, push);
    c.dispatch_over(along_x_, shape.extent);
    c.own_barrier();
    c.push(along_y_, push);
    c.dispatch_over(along_y_, shape.extent);
  }
  void filter_listed(Context& c, const ImageShape& shape, const Push& push) const {
    c.own_barrier();
    clear_pixel_list(c);
    c.own_barrier();
    c.push(find_, push);
    c.dispatch_over(find_, shape.extent);
    c.own_barrier();
    c.push(filter_, push);
    c.dispatch_indirect(filter_, "arguments");
  }

  static bool is_round(const Light& light) {
    return light.area &&
           (light.area->shape == AreaLight::Shape::disc || light.area->shape == AreaLight::Shape::sphere);
  }

  bool separable_ = false;
  Pipeline cells_, find_, filter_, along_x_, along_y_;
  std::vector<float> reach_;  // of each light's kernel, in its half widths
};

GNOMON_PASS("screen_penumbra", ScreenPenumbra);

}  // namespace
}  // namespace gnomon
