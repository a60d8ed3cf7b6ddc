// What the parts of the reference tracer share. Internal.
#pragma once

#include <glm/glm.hpp>

#include "engine/truth/ray_scene.h"
#include "engine/truth/reference.h"

namespace gnomon {

// Part of every cache key: raise it when a change of the tracer may change a result.
inline constexpr const char* tracer_version = "1";

struct ReferenceTracer::Impl {
  explicit Impl(const Scene& source) : scene(source), rays(scene) {}
  const Scene scene;  // a copy, so that the caller's may go
  const RayScene rays;

  // Where shadow rays towards the light's centre end, relative to the rays' origin.
  ShadowTarget centre_of(const Light& light) const;
};

// Is the light traced as an area, with `samples` as in ReferenceSettings? Lights with a size are.
bool is_area(const Light& light, uint32_t samples);

}  // namespace gnomon
