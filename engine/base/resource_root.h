// Where shaders, graphs, scenes and suites are found.
#pragma once

#include <filesystem>

namespace gnomon {

// Root folder that holds assets/ and shaders/ (GNOMON_ROOT, else the source tree or the install prefix).
std::filesystem::path resource_root();

}  // namespace gnomon
