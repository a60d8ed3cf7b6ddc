#include <fmt/format.h>

#include "engine/context.h"
#include "engine/error.h"
#include "engine/image.h"

namespace gnomon {
namespace {

class ImageSource : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.darkens_lit_surfaces();  // whatever the scene casts
    d.summary("Shows an image that the program gives (RenderSettings::images), as if a pass had made it.");
    d.output("value", Access::transfer_write, true, {d.setting().viewport, 1, 1, VK_FORMAT_R32_SFLOAT},
             "the image's first channel");
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
    texels_ = e.upload(std::as_bytes(image.plane(0)), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  }

  void record(Context& c) override { c.copy(texels_, "value"); }

 private:
  Buffer texels_;
};

GNOMON_PASS("image_source", ImageSource);

}  // namespace
}  // namespace gnomon
