// Lists of pixels that a pass makes in one dispatch and works off in another, as
// shaders/glsl/frame/pixel_list.glsl uses them: the buffers `listed`, of pixels, and `arguments`, four words:
// the workgroups in x, y and z of an indirect dispatch and the number of pixels listed.
#pragma once

#include "engine/graph/pass.h"

namespace gnomon {

// `what`: which of one light's pixels, for the listing.
// `listed`, `arguments`: the buffers' names.
void declare_pixel_list(Declaration& d, Extent pixels, const std::string& what,
                        const std::string& listed = "listed", const std::string& arguments = "arguments");

// No workgroups in x, one in y and z; no pixels. A barrier is the caller's.
void clear_pixel_list(Context& c, const std::string& arguments = "arguments");

}  // namespace gnomon
