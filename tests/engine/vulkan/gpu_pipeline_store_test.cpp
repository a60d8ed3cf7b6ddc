// Pipelines that renderers of a device share.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "engine/vulkan/pipeline_store.h"
#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon {
namespace {

// Pipelines that are null, which Vulkan allows to be destroyed.
struct Counter {
  int made = 0;
  VkPipeline operator()() {
    ++made;
    return VK_NULL_HANDLE;
  }
};

TEST(PipelineStore, MakesWhatItDoesNotHave) {
  PipelineStore store(test::kernel_device()->handle(), 8);
  Counter counter;
  const auto first = store.get("a", std::ref(counter));
  EXPECT_EQ(store.get("a", std::ref(counter)), first);
  EXPECT_EQ(counter.made, 1);
  EXPECT_NE(store.get("b", std::ref(counter)), first);
  EXPECT_EQ(counter.made, 2);
}

TEST(PipelineStore, ForgetsTheOneUsedLongestAgo) {
  PipelineStore store(test::kernel_device()->handle(), 2);
  Counter counter;
  for (const char* key : {"a", "b", "a", "c"}) store.get(key, std::ref(counter));
  EXPECT_EQ(counter.made, 3);
  store.get("a", std::ref(counter));
  EXPECT_EQ(counter.made, 3);
  store.get("b", std::ref(counter));
  EXPECT_EQ(counter.made, 4);
}

TEST(PipelineStore, WhatItForgetsLivesAsLongAsItIsHeld) {
  PipelineStore store(test::kernel_device()->handle(), 1);
  Counter counter;
  const PipelineStore::Held held = store.get("a", std::ref(counter));
  const std::weak_ptr<const VkPipeline> other = store.get("b", std::ref(counter));
  EXPECT_EQ(held.use_count(), 1);
  EXPECT_FALSE(other.expired());
  store.get("c", std::ref(counter));
  EXPECT_TRUE(other.expired());
}

}  // namespace
}  // namespace gnomon
