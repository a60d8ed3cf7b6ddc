// Assigns layers to the shadow maps of samples, from frame to frame.
#include "passes/area/map_cache.h"

#include <algorithm>

namespace gnomon {

void MapCache::resize(uint32_t layers, uint32_t scratch) {
  kept_ = layers > scratch ? layers - scratch : 0;
  forget();
}

void MapCache::forget() {
  layer_of_.clear();
  free_.clear();
  for (uint32_t layer = kept_; layer > 0; --layer) free_.push_back(layer - 1);
}

void MapCache::forget(uint32_t view) {
  for (auto at = layer_of_.begin(); at != layer_of_.end();) {
    const bool its = std::get<0>(at->first) == view;
    if (its) free_.push_back(at->second);
    at = its ? layer_of_.erase(at) : std::next(at);
  }
  std::sort(free_.rbegin(), free_.rend());  // neighbours are rendered together
}

MapCache::Placed MapCache::place(uint32_t view, std::span<const glm::dvec2> samples) {
  Placed placed;
  uint32_t scratch = kept_;
  for (uint32_t i = 0; i < samples.size(); ++i) {
    const Key key{view, samples[i].x, samples[i].y};
    const auto known = layer_of_.find(key);
    if (known != layer_of_.end()) {
      placed.layers.push_back(known->second);
      continue;
    }
    uint32_t layer = 0;
    if (free_.empty()) {
      layer = scratch++;
    } else {
      layer = layer_of_[key] = free_.back();
      free_.pop_back();
    }
    placed.layers.push_back(layer);
    const bool joins = !placed.missing.empty() &&
                       placed.missing.back().first + placed.missing.back().count == i &&
                       placed.missing.back().layer + placed.missing.back().count == layer;
    joins ? void(++placed.missing.back().count) : placed.missing.push_back({i, 1, layer});
  }
  return placed;
}

}  // namespace gnomon
