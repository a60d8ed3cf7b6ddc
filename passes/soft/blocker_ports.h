// What passes that find blockers have in common, however they look for them.
#pragma once

#include "engine/graph/pass.h"
#include "passes/map/receiver_ports.h"

namespace gnomon {

struct SceneFacts;  // engine/light/scene_facts.h

// Outputs `blocker` and `width`, images of that shape, and the list of pixels that the work is done on.
void declare_blocker(Declaration& d, const ImageShape& image);

// Where no light has a size, nothing is hidden in part and no penumbra is wide.
Need need_of_blocker(const SceneFacts& facts);

// Of a light whose shadows the camera cannot see.
PerLightOutput blocker_output();

}  // namespace gnomon
