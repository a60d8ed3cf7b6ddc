// Work on those pixels alone that a first look has listed.
#pragma once

#include <array>
#include <string_view>

#include "engine/base/shape.h"
#include "passes/map/receiver_ports.h"

namespace gnomon {

class Context;

// Light by light: `find` looks at every pixel of an image of that shape and lists some of them
// (passes/frame/pixel_list.h), `work` is done on these. `sections`: parts of the pass that their times count
// to; empty: none.
void dispatch_listed(Context& c, const PerLight& find, const PerLight& work, const ImageShape& shape,
                     const std::array<std::string_view, 2>& sections = {});

}  // namespace gnomon
