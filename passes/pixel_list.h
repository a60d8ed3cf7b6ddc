// Lists of pixels that a pass makes in one dispatch and works off in another: a buffer of pixels and one of
// four words, the workgroups in x, y and z of an indirect dispatch and the number of pixels listed.
#pragma once

#include "engine/context.h"

namespace gnomon {

constexpr Access kListArguments =
    Access::storage_read | Access::storage_write | Access::indirect | Access::transfer_write;

// No workgroups in x, one in y and z; no pixels. A barrier is the caller's.
void clear_list(Context& c, const std::string& arguments);

}  // namespace gnomon
