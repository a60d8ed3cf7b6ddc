// What is said of cameras.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace gnomon {

// How an image of that aspect (width / height) shows a camera of another one; empty: they agree.
std::string aspect_warning(const Camera& camera, double image_aspect);

// What sizes in the image of an orthographic camera go with, world units: half its height, as if a camera
// with an angle of 90 degrees looked from there. 1 for a perspective one, where they go with the view depth.
double image_scale(const Camera& camera, double image_aspect);

// View depth that device depths of an orthographic camera reach to: behind all that it sees of the scene as
// it stands, and of what it may see. Above the camera's near plane.
double depth_end(const Scene& scene, const Camera& camera);

// Something of the scene may lie beyond the camera's far plane, now or later on.
bool far_plane_cuts(const Scene& scene, const Camera& camera);

}  // namespace gnomon
