// PNGs of a measured row, for reports.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "bench/error/truth.h"
#include "bench/run/row.h"
#include "engine/image/image.h"

namespace gnomon {

// Writes into `folder`/images, under names made of the row's key: `visibility` of the first light, `color`
// (sRGB), and for all rows of the scene, size and camera together `reference`, `domain` (white: counted) and
// `reference_color`. `color` may be nullptr. Gives what each shows and its path relative to `folder`. Values
// that are not finite are drawn as 0.
std::map<std::string, std::string> write_row_images(const std::filesystem::path& folder, const Row& row,
                                                    const Truth& truth, const Image& visibility,
                                                    const Image* color);

}  // namespace gnomon
