// A light's projections: what each layer of a shadow map shows.
#pragma once

#include <optional>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

// A shadow-map view: one layer of the map. All matrices in double; subtract an origin before going to float.
// Clip space is Vulkan's: y down, z in [0,1]; depth grows with distance from the light in both encodings.
struct LightView {
  uint32_t light = 0;
  bool orthographic = false;
  glm::dmat4 light_from_world{1.0};  // rigid; looks along -z
  double half_width = 1,
         half_height = 1;    // tangent of the half angle (perspective) or world units (orthographic)
  double near = 1, far = 2;  // distance along the view axis, world units; fitted to the scene
  // Perspective: of all that the view holds, at least `far`. What is beyond `far` is lit or shadowed as if it
  // were there.
  double farthest = 2;
  glm::dmat4 clip_from_light() const;  // perspective or orthographic projection
};

// From where a scene is looked at.
struct SeenFrom {
  Camera camera;
  double aspect = 1;  // width / height of the image
};

// Views in layer order: 1 for spot and directional, 6 for point (+x -x +y -y +z -z of the light's own frame).
// `border`: texels kept outside a point light's 90 degrees a face, of `map_size`, so that walks and filters
// near an edge stay in the view. `map_size` in texels.
// `seen`: what the map is for. Then vertices that are more than 16 times as far as the ones before them -
// from the light, or with directional lights from the camera's eye - are left out where no triangle there can
// cast on another one there that the camera sees: what is near still casts on them, and they on it. Without
// it the views show the whole scene.
std::vector<LightView> light_views(const Scene& scene, uint32_t map_size, uint32_t border,
                                   const std::optional<SeenFrom>& seen = {});

}  // namespace gnomon
