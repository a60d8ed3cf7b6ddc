// Work on those pixels alone that a first look has listed.
#pragma once

#include "engine/base/shape.h"
#include "passes/map/receiver_ports.h"

namespace gnomon {

class Context;

// Light by light: `find` looks at every pixel of an image of that shape and lists some of them
// (passes/frame/pixel_list.h), `work` is done on these.
void dispatch_listed(Context& c, const PerLight& find, const PerLight& work, const ImageShape& shape);

}  // namespace gnomon
