// What of a scene lies outside of what shadow maps can resolve.
#pragma once

#include <string>
#include <vector>

#include "engine/graph/pass.h"
#include "engine/scene/scene.h"

namespace gnomon {

// Share of the surface that faces the light (0 to 1, by area), casters and receivers alike, that some of the
// light's `points`, in its own frame, meet at a steeper angle than `slope`: its tangent to the normal. 0 when
// nothing faces any of them.
double grazed_share(const Scene& scene, const Light& light, double slope,
                    const std::vector<glm::dvec3>& points = {glm::dvec3(0.0)});

// The watertight instance that the light's place is inside of, or nullptr. A directional light is nowhere.
const Instance* surrounding_caster(const Scene& scene, const Light& light);

// Where a light is looked from when maps are rendered.
enum class MapsFrom { centre, area };
// Warnings of a pass that renders shadow maps of `side` texels: too few texels, lights that graze most of
// what they shine on, from their centre or from some part of their area; lights inside of a caster.
void warn_about_maps(Environment& e, uint32_t side, MapsFrom from);
// Of a pass with the parameter `kernel`, texels, that filters maps of `side` texels.
void warn_about_kernel(Environment& e, uint32_t side);
// Of such a pass that filters depths, not tests: receivers must not rise over much of the map's depth range
// within the kernel.
void warn_about_rise(Environment& e, uint32_t side);

}  // namespace gnomon
