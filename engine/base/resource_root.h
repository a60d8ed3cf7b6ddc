// Where shaders, graphs, scenes and suites are found.
#pragma once

#include <filesystem>

namespace gnomon {

// Folder that holds assets/, shaders/ and bench/suites/. GNOMON_ROOT where that is set; else share/gnomon
// beside the program's own file, or the shared library's that this is part of (PREFIX/bin/program,
// PREFIX/lib/.../library.so); else the one that was offered; else the source tree. Error when none is there.
std::filesystem::path resource_root();

// The folder of the installed package that a program was built against: what find_package(gnomon) compiles
// into the program calls it before main() begins. The last one counts.
bool offer_resource_root(const char* folder);

}  // namespace gnomon
