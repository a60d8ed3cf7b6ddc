// Reads EXR files; used by image.cpp only.
#pragma once

#include <filesystem>

#include "engine/image/image.h"

namespace gnomon::exr {

// All channels of a file as floats; of a file of several parts they are called "part.channel". Throws Error
// or OpenEXR's exceptions: cut off, subsampled, deep, too large, parts of different sizes, or a data window
// other than the display window.
Image read(const std::filesystem::path& file);

}  // namespace gnomon::exr
