// Which layers hold the shadow maps of which samples, from frame to frame. Device-free.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <tuple>
#include <vector>

namespace gnomon {

class MapCache {
 public:
  struct Run {  // samples [first, first + count) of those placed, to be rendered to layers from `layer` on
    uint32_t first = 0, count = 0, layer = 0;
  };
  struct Placed {
    std::vector<uint32_t> layers;  // one a sample
    std::vector<Run> missing;
  };

  // Of `layers`, all but the last `scratch` keep their maps; those take what finds no other place.
  void resize(uint32_t layers, uint32_t scratch);
  void forget();               // casters have moved
  void forget(uint32_t view);  // its light has moved
  // At most `scratch` samples of a view, by their places on the light.
  Placed place(uint32_t view, std::span<const glm::dvec2> samples);

 private:
  using Key = std::tuple<uint32_t, double, double>;
  std::map<Key, uint32_t> layer_of_;
  std::vector<uint32_t> free_;  // layers, the next one last
  uint32_t kept_ = 0;
};

}  // namespace gnomon
