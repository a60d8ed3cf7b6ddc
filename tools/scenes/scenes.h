// The generated scenes: each returns a .glb file's bytes.
#pragma once

#include <string>

namespace gnomon::generate {

std::string area_shapes_scene();
std::string colonnade();
std::string fence();
std::string foliage();
std::string hills();
std::string lattice();
std::string moving_light();
std::string pendulum();
std::string robot();
std::string sphere_plane_scene();
std::string square_plane_scene();
std::string sun_and_lamp_scene();

}  // namespace gnomon::generate
