// What is said of cameras.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace gnomon {

// How an image of that aspect (width / height) shows a camera of another one; empty: they agree.
std::string aspect_warning(const Camera& camera, double image_aspect);

// Something of the scene may lie beyond the camera's far plane, now or later on.
bool far_plane_cuts(const Scene& scene, const Camera& camera);

}  // namespace gnomon
