// Which glTF extensions are read, and what leaving out the others means. Internal to the scene loader.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/scene/scene.h"

namespace gnomon {

// One warning for each extension in use that is not read: what is ignored, and whether it can change shadows.
// Error for a required one that is not known.
void check_extensions(const nlohmann::json& document, const std::string& file, SceneWarnings& warnings);

}  // namespace gnomon
