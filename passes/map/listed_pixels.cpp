// Work on those pixels alone that a first look has listed.
#include "passes/map/listed_pixels.h"

#include "engine/render/context.h"
#include "passes/frame/pixel_list.h"

namespace gnomon {

void dispatch_listed(Context& c, const PerLight& find, const PerLight& work, const ImageShape& shape,
                     const std::array<std::string_view, 2>& sections) {
  for (uint32_t light = 0; light < shape.layers; ++light) {
    if (find.shade_shadowless(c, light)) continue;
    if (light > 0) c.own_barrier();  // the list is used again
    clear_pixel_list(c);
    c.own_barrier();
    if (!sections[0].empty()) c.section(sections[0]);
    find.dispatch_over(c, light, shape.extent);
    c.own_barrier();
    if (!sections[1].empty()) c.section(sections[1]);
    work.dispatch_indirect(c, light, "arguments");
  }
}

}  // namespace gnomon
