// Lists of pixels that one dispatch makes and another works off.
#include "passes/frame/pixel_list.h"
#include "engine/graph/pass.h"
#include "engine/render/context.h"

namespace gnomon {

void declare_pixel_list(Declaration& d, Extent pixels, const std::string& what, const std::string& listed,
                        const std::string& arguments) {
  constexpr Access kBoth = Access::storage_read | Access::storage_write;
  d.transient_buffer(listed, kBoth, {uint64_t(pixels.width) * pixels.height, 4, "uint"},
                     what + ", as y * width + x");
  d.transient_buffer(arguments, kBoth | Access::indirect | Access::transfer_write, {4, 4, "uint"},
                     "workgroups (x, y, z) that work off the list, and the number of listed pixels");
}

void clear_pixel_list(Context& c, const std::string& arguments) {
  constexpr uint64_t kWord = 4;  // bytes
  c.fill(arguments, 0, 0, kWord);
  c.fill(arguments, 1, kWord, 2 * kWord);
  c.fill(arguments, 0, 3 * kWord, kWord);
}

}  // namespace gnomon
