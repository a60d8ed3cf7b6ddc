// Light views of a moving scene: what never changes is measured once.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/light/light_view.h"
#include "engine/scene/scene.h"

namespace gnomon {

struct ViewFit;  // engine/light/light_views.cpp

// views() gives what light_views() would for the scene as it stands, from the vertices of what moves alone
// where the light stands still. Instances and lights may move between calls where Instance::moving and
// Light::moving say so.
class LightFit {
 public:
  LightFit(const Scene& scene, uint32_t map_size, uint32_t border, const std::optional<SeenFrom>& seen = {});
  LightFit(LightFit&&) noexcept;
  LightFit& operator=(LightFit&&) noexcept;
  ~LightFit();
  std::vector<LightView> views(const Scene& scene) const;

 private:
  uint32_t map_size_, border_;
  std::optional<SeenFrom> seen_;
  glm::dvec3 middle_;           // what distances of a directional light's vertices are from
  std::vector<ViewFit> still_;  // per light that stands still: of the instances that do
};

// A view for all samples of an area light: a frustum whose apex may stand anywhere on the light and whose
// window is moved for each sample so that it holds all receivers of the light's own frustum.
struct AreaView {
  LightView view;  // the light's own, widened for the samples; its range holds what any of them can see
  double converge =
      0;  // a sample at x, y of the light's frame has its window's centre at -converge * (x, y), as tangents
};
// `centre`: the light's own view, of `scene`. Of a light without area, and of views of other lights than
// spots: the same view.
AreaView area_view(const Scene& scene, const LightView& centre);

}  // namespace gnomon
