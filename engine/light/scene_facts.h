// What of a scene decides which passes it needs.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

// What passes ask about in need(). World units, double precision.
struct SceneFacts {
  uint64_t triangles = 0;
  uint32_t lights = 0;
  bool has_alpha_mask = false;
  bool has_double_sided = false;
  bool has_open_meshes = false;
  bool animated = false;
  bool casters_move = false;
  double nearest_depth = 0;  // no visible surface is nearer to the camera along its axis
  double middle_depth = 1;   // the camera's distance to the scene's middle
  // (of an orthographic camera both are its image_scale(), which sizes in its image go with)
  double smallest_pixel = 0;  // no pixel shows less of a visible surface than this, world units
  // per light:
  std::vector<std::string> shadowless;  // why the camera sees none of its shadows; empty: it may see some
  std::vector<bool> light_moves;
  std::vector<double> light_size;  // largest side of its AreaLight; 0 for a point
  std::vector<double> penumbra;    // no penumbra that the camera sees is wider, pixels

  // Does its area make no difference to any pixel?
  bool shines_as_point(uint32_t light) const { return penumbra[light] < negligible_penumbra; }
  // Pixels. Of the silhouette's pixels no more than this part have their centre in the penumbra.
  static constexpr double negligible_penumbra = 1.0 / 64;
  // Why the camera sees no shadow of any light; empty: it may see some.
  std::string no_shadow() const;
  static constexpr const char* no_caster = "no caster reaches what the camera sees";  // of shadowless
};
// Tests on bounds that find something to do when in doubt. `aspect`: width / height of the view. `height`: of
// the view in pixels; 0: unknown, and nothing is small compared with a pixel.
SceneFacts scene_facts(const Scene& scene, const Camera& camera, double aspect, uint32_t height = 0);
// The same without anything that allows to leave something out.
SceneFacts promising_nothing(SceneFacts facts);

}  // namespace gnomon
