// What is said of cameras.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace gnomon {

// How an image of that aspect (width / height) shows a camera of another one; empty: they agree.
std::string aspect_warning(const Camera& camera, double image_aspect);

}  // namespace gnomon
