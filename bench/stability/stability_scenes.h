// The scene that the stability walk bends: a square and a sphere over a floor, lit by one spot with a square
// area light, seen from above. Built in code; every axis changes one of its numbers.
#pragma once

#include <cstdint>

#include "engine/scene/scene.h"

namespace gnomon {

// Lengths in the scene's own units, before `scale`.
struct StabilitySetup {
  double depth_range = 0;   // farthest / nearest depth, of the light's face and of the camera; 0: as it comes
  double offset = 0;        // of the whole scene from the world's origin, world units along (1, 1/2, -3/4)
  double scale = 1;         // world units to a unit of the scene
  double incidence = 15;    // degrees between the floor's normal and the way to the light
  double light_size = 0.8;  // side of the square area light; 0: a point
  double light_height = -1;       // above the floor, the light looking level; negative: as `incidence` says
  bool light_inside = false;      // in the sphere's centre
  double fov = 45;                // degrees, the camera's vertical field of view
  uint32_t layers = 1;            // floors in one plane
  double sliver_aspect = 1;       // length / width of the thin triangles in the blocker; 1: none
  uint32_t depth_complexity = 1;  // squares over one another instead of the one blocker
  bool flat = false;       // a floor alone under a directional light straight above: one depth in the map
  uint64_t triangles = 4;  // 0: the camera sees none; 1: one is the scene; above 4: of the floor
  uint32_t lights = 1;     // spot, directional, point, ...; 0: a file without lights, as the loader reads it
};

// Error when there is no room for the file that `lights` 0 needs.
Scene stability_scene(const StabilitySetup& setup);

}  // namespace gnomon
