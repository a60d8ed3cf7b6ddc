// The pass summed_area_table: sums of a map over all rectangles that begin at its corner.
#include <string_view>

#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/filtered/summed_area.h"

namespace gnomon {
namespace {

constexpr uint32_t kLines = 8;  // of a workgroup of summed_area_table.glsl

struct Layout {
  const char* name;  // GLSL type and swizzle of the channels
  VkFormat integers, floats;
};

// As many channels as the source has, of pairs twice as many.
Layout layout_of(VkFormat source, bool pair) {
  if (pair) return {"xyzw", VK_FORMAT_R32G32B32A32_UINT, VK_FORMAT_R32G32B32A32_SFLOAT};
  switch (source) {
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R16G16_SNORM:
      return {"xy", VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32_SFLOAT};
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return {"xyzw", VK_FORMAT_R32G32B32A32_UINT, VK_FORMAT_R32G32B32A32_SFLOAT};
    default:
      return {"x", VK_FORMAT_R32_UINT, VK_FORMAT_R32_SFLOAT};
  }
}

class SummedAreaTable : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Sums of a map over all rectangles that begin at its corner, so that any rectangle takes four.");
    d.cite("Crow 1984; wrapping integers: Peters et al. 2017, section 5");
    const ImageShape source =
        d.input("source", Access::sampled, true, "what is summed, every layer and channel by itself");
    const TableNumbers numbers = declare_table(d, "source");
    const bool integers = numbers != TableNumbers::floating, pair = numbers == TableNumbers::integer_pair;
    const Layout layout = layout_of(source.format, pair);
    if (pair && std::string_view(layout_of(source.format, false).name) == layout.name)
      d.refuse("numbers", "\"integer\" or \"float\" of a source with more than two channels");
    d.output("sums", Access::storage_read | Access::storage_write, true,
             {source.extent, source.layers, 1, integers ? layout.integers : layout.floats},
             "of all texels up to and including each one, in x and y");
    d.carry_traits("source", "sums");
    set_table(d, "sums");
  }

  void prepare(Environment& e) override {
    const Defines defines{
        {"CHANNELS",
         layout_of(e.shape("source").format, e.params().choice("numbers") == "integer_pair").name}};
    columns_ = e.compute("filtered/summed_area_table.glsl", defines);
    rows_ = e.compute("filtered/summed_area_table.glsl", {defines.front(), {"ROWS", "1"}});
    scale_.integer = table_steps(e.params());
    const double range = e.params().number("greatest") - e.params().number("least");
    scale_.factor = float(scale_.integer / range);
    e.fact("steps", double(scale_.integer));
  }

  void record(Context& c) override {
    const ImageShape shape = c.shape("sums");
    c.push(rows_, scale_);
    c.dispatch(rows_, divide_up(shape.extent.height, kLines), 1, shape.layers);
    c.own_barrier();
    c.dispatch(columns_, divide_up(shape.extent.width, kLines), 1, shape.layers);
  }

 private:
  struct Scale {
    float factor = 1;      // steps per unit of the source
    uint32_t integer = 1;  // steps of the whole range
  } scale_;
  Pipeline rows_, columns_;
};

GNOMON_PASS("summed_area_table", SummedAreaTable);

}  // namespace
}  // namespace gnomon
