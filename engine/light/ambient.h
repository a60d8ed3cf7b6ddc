// Light from all over the sky: what keeps a picture's unlit parts from being black. It has no shadows.
#pragma once

#include "engine/scene/scene.h"

namespace gnomon {

// A sky of one colour above a ground of the same, darker. The world's y points up.
struct Ambient {
  double share =
      0;  // of what all lights bring to the scene's middle, as irradiance of an open horizontal plane
  double ground = 0.3;             // radiance of the ground, as a share of the sky's
  glm::dvec3 sky{0.65, 0.8, 1.0};  // colour, linear
  bool operator==(const Ambient&) const = default;
};

// Radiance of the sky. Lights that are in the scene's middle count as if they were a part of its radius away.
glm::dvec3 sky_radiance(const Scene& scene, const Ambient& ambient);
// Irradiance of a surface with that unit normal from a hemisphere of sky over one of ground, per radiance of
// the sky: pi times the mean of both, weighted with how much of each the surface faces.
double hemisphere_irradiance(double normal_y, double ground);

}  // namespace gnomon
