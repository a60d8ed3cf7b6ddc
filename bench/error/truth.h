// A scene's ray-traced reference at one size, and the error of images against it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "bench/error/measure.h"
#include "engine/base/params.h"
#include "engine/image/image.h"
#include "engine/scene/scene.h"
#include "engine/truth/reference.h"

namespace gnomon {

// The channels R, G, B of a shaded image; Error when one is missing.
Image rgb_of(const Image& color);

struct Graph;  // engine/graph/graph.h

// Of the pass that a graph's colour comes from; without any where it has none of these parameters.
Ambient ambient_of(const Graph& graph);

class Truth {
 public:
  // Traces, or reads from `cache`.
  Truth(std::shared_ptr<const Scene> scene, const ReferenceSettings& settings,
        const std::filesystem::path& cache);

  // `color`: the shaded image, for FLIP; may be nullptr. `graph`: whose widest map's texels acne and leak are
  // judged by (map_side; 1024 when there is none).
  MeasuredError error(const Image& visibility, const Image* color, const Graph& graph) const;
  const Reference& reference() const { return reference_; }
  const Image& shaded(const Ambient& ambient = {}) const;  // shade_reference() of it; until asked for another

 private:
  std::shared_ptr<const Scene> scene_;
  Camera camera_;
  Reference reference_;
  ReferenceTracer tracer_;
  const std::vector<std::vector<uint32_t>>& deep_umbra_of(const EdgeSettings& edges) const;
  mutable Image shaded_;  // made when first asked for
  mutable Ambient shaded_with_;
  mutable std::map<uint32_t, std::vector<std::vector<uint32_t>>>
      deep_umbra_;  // by the map's size; a list a light
};

}  // namespace gnomon
