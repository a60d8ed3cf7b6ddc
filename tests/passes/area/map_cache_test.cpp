// Which samples' maps are kept, moved and rendered again.
#include "passes/area/map_cache.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

std::vector<glm::dvec2> places(int from, int to) {
  std::vector<glm::dvec2> result;
  for (int i = from; i < to; ++i) result.emplace_back(i, 0);
  return result;
}

uint32_t missing(const MapCache::Placed& placed) {
  uint32_t count = 0;
  for (const MapCache::Run& run : placed.missing) count += run.count;
  return count;
}

TEST(MapCache, WithoutKeptLayersAllGoToTheFirstOnesEveryTime) {
  MapCache cache;
  cache.resize(4, 4);
  for (int turn = 0; turn < 2; ++turn) {
    const MapCache::Placed placed = cache.place(0, places(0, 3));
    EXPECT_EQ(placed.layers, (std::vector<uint32_t>{0, 1, 2}));
    ASSERT_EQ(placed.missing.size(), 1u) << "one run";
    EXPECT_EQ(placed.missing[0].count, 3u);
  }
}

TEST(MapCache, KnownSamplesKeepTheirLayers) {
  MapCache cache;
  cache.resize(12, 4);
  const MapCache::Placed first = cache.place(0, places(0, 3)), again = cache.place(0, places(1, 5));
  EXPECT_EQ(missing(first), 3u);
  EXPECT_EQ(missing(again), 2u);
  EXPECT_EQ(again.layers[0], first.layers[1]);
  EXPECT_EQ(missing(cache.place(1, places(0, 1))), 1u) << "another view";
}

TEST(MapCache, WhatFindsNoPlaceGoesToScratchAndIsRenderedAgain) {
  MapCache cache;
  cache.resize(6, 4);  // two are kept
  const MapCache::Placed placed = cache.place(0, places(0, 4));
  EXPECT_EQ(placed.layers, (std::vector<uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(missing(cache.place(0, places(0, 4))), 2u);
}

TEST(MapCache, ForgetsAFaceOrAll) {
  MapCache cache;
  cache.resize(12, 4);
  cache.place(0, places(0, 2));
  cache.place(1, places(0, 2));
  cache.forget(0);
  EXPECT_EQ(missing(cache.place(1, places(0, 2))), 0u);
  EXPECT_EQ(missing(cache.place(0, places(0, 2))), 2u);
  cache.forget();
  EXPECT_EQ(missing(cache.place(1, places(0, 2))), 2u);
}

}  // namespace
}  // namespace gnomon
