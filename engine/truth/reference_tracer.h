// What the parts of the reference tracer share. Internal.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <mutex>

#include "engine/truth/ray_scene.h"
#include "engine/truth/reference.h"

namespace gnomon {

// Part of every cache key: raise it when a change of the tracer may change a result.
inline constexpr const char* kTracerVersion = "2";

struct ReferenceTracer::Impl {
  explicit Impl(const Scene& source) : scene(source) {}
  const Scene scene;  // a copy, so that the caller's may go

  // For rays of a camera: the hierarchy is built for its eye, and kept until another one's is asked for.
  std::shared_ptr<const RayScene> rays_of(const Camera& camera) const;

 private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const RayScene> rays_;
};

// Where shadow rays towards the light's centre end, relative to the rays' origin.
ShadowTarget centre_of(const Light& light, const RayScene& rays);

// Is the light traced as an area, with `samples` as in ReferenceSettings? Lights with a size are.
bool is_area(const Light& light, uint32_t samples);

}  // namespace gnomon
