// The pass image_source: an image that the program gives, as if a pass had made it.
#include <fmt/format.h>

#include "engine/base/error.h"
#include "engine/graph/pass.h"
#include "engine/image/image.h"
#include "engine/light/light_view.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/render_settings.h"
#include "passes/map/map_traits.h"

namespace gnomon {
namespace {

class ImageSource : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.darkens_lit_surfaces();  // whatever the scene casts
    d.summary("Shows an image that the program gives (RenderSettings::images), as if a pass had made it.");
    const bool mask = d.flag("mask", false, "1 where the image is not 0, in 8 bits a pixel");
    d.optional_input_buffer("views", Access::uniform,
                            "what the image shows, where it stands for a shadow map");
    d.offer_behind("views", "value");
    d.output("value", Access::transfer_write, true,
             {d.setting().viewport, 1, 1, mask ? VK_FORMAT_R8_UNORM : VK_FORMAT_R32_SFLOAT},
             "the image's first channel");
    const bool depth =
        d.choice("holds", "values", {"values", "depth"},
                 "what the image is: values, or depth from the light, a shadow map") == "depth";
    if (depth && mask) d.refuse("holds", "\"values\" with mask");
    if (depth) set_depth_map(d, "value", declare_depth_map(d));
  }

  void prepare(Environment& e) override {
    const auto given = e.settings().images.find(e.id());
    if (given == e.settings().images.end() || !given->second)
      fail(fmt::format("pass '{}' shows an image that the program must give", e.id()));
    const Image& image = *given->second;
    const Extent size = e.shape("value").extent;
    if (image.channels.empty() || image.width != size.width || image.height != size.height)
      fail(fmt::format("pass '{}' shows {}x{} pixels, but its image has {}x{}", e.id(), size.width,
                       size.height, image.width, image.height));
    const auto values = image.plane(0);
    std::vector<uint8_t> mask;
    if (e.params().flag("mask"))
      for (const float value : values) mask.push_back(value != 0 ? 255 : 0);
    texels_ = e.upload(mask.empty() ? std::as_bytes(values) : std::as_bytes(std::span(mask)),
                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  }

  void record(Context& c) override { c.copy(texels_, "value"); }

 private:
  Buffer texels_;
};

GNOMON_PASS("image_source", ImageSource);

}  // namespace
}  // namespace gnomon
