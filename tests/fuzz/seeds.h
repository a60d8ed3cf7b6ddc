// Inputs to begin with.
#pragma once

#include <map>
#include <string>

namespace gnomon::fuzz {

using Seeds = std::map<std::string, std::string>;  // content by name

Seeds scene_seeds();
Seeds row_seeds();
Seeds exr_seeds();
Seeds png_seeds();

}  // namespace gnomon::fuzz
