// Declares what passes that find blockers make, and when they need not run.
#include "passes/soft/blocker_ports.h"

#include <algorithm>

#include "engine/light/scene_facts.h"
#include "passes/frame/pixel_list.h"

namespace gnomon {

void declare_blocker(Declaration& d, const ImageShape& image) {
  d.output("blocker", Access::storage_write, true, image,
           "mean linear depth of what hides some of the light, from it, world units; 0: nothing does, or the "
           "light has no size; a layer a light");
  d.output(
      "width", Access::storage_write, true, image,
      "of the penumbra at the receiver, parallel to the light's larger side, world units; a layer a light");
  declare_pixel_list(d, image.extent, "pixels that something may hide some of one light from");
}

Need need_of_blocker(const SceneFacts& facts) {
  if (std::any_of(facts.light_size.begin(), facts.light_size.end(), [](double size) { return size > 0; }))
    return Need::run();
  Need none = Need::constant("blocker", 0, "no light has a size");
  none.constants.push_back({"width", {0, 0, 0, 0}});
  return none;
}

PerLightOutput blocker_output() { return {"blocker", "soft/blocker_search_none.glsl"}; }

}  // namespace gnomon
