// May what is far away from a light's map cast a shadow there that the camera sees?
#pragma once

#include "engine/light/light_view.h"

namespace gnomon {

// Of the triangles that have a vertex further off than `reach`: may some cast on another one of them, where
// the camera sees it? Distances are the largest along the light's axes, from the light, or with a directional
// light from `middle`. Triangles are looked at one against another, as the light's centre sees them, and an
// area light's border; of surfaces with a hole in them, whole. Yes when there are too many. A moving camera
// may see all.
bool casts_beyond(const Scene& scene, const Light& light, const glm::dvec3& middle, double reach,
                  const SeenFrom& seen);

}  // namespace gnomon
