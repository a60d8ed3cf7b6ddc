// May the camera's near plane lie in a light's shadow? Decides between z-fail and z-pass shadow volumes.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

// Bounds of every instance, world space, as its transformed vertices have them.
std::vector<Bounds> instance_bounds(const Scene& scene);

// The eye, then the near plane's corners, a little enlarged so that rounding never decides.
std::vector<glm::dvec3> near_pyramid(const Camera& camera, double aspect);

// Conservative: false only when no instance's box touches the hull of the eye, the near plane's rectangle and
// the light (a directional light: swept towards it past the scene). `aspect`: width / height of the image.
bool near_plane_may_be_shadowed(const std::vector<Bounds>& casters, const Camera& camera, double aspect,
                                const Light& light);

}  // namespace gnomon
