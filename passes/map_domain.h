// What of a scene lies outside of what shadow maps can resolve.
#pragma once

#include <string>
#include <vector>

#include "engine/context.h"
#include "engine/scene.h"

namespace gnomon {

// Share of the surface that faces the light (0 to 1, by area), casters and receivers alike, which it meets at
// more than the steep slope of shaders/glsl/lib/receiver_plane.glsl: there one texel covers twenty times its
// width in depth. A point of the light's place stands for all of its area. 0 when nothing faces it.
double grazed_share(const Scene& scene, const Light& light);

// The watertight instance that the light's place is inside of, or nullptr. A directional light is nowhere.
const Instance* surrounding_caster(const Scene& scene, const Light& light);

// Warnings of a pass that renders shadow maps of `side` texels: too few texels, lights that graze most of
// what they shine on, lights inside of a caster.
void warn_about_maps(Environment& e, uint32_t side);
// Of a pass with the parameter `kernel`, texels, that filters a map of `side` texels.
void warn_about_kernel(Environment& e, uint32_t side);

}  // namespace gnomon
