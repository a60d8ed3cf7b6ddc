// A fixture for passes that the validation layers must have nothing to say about.
#pragma once

#include <gtest/gtest.h>

#include "engine/vulkan/device.h"
#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::test {

// Fails the test for what the layers say about the shared device meanwhile.
class Silent : public testing::Test {
 protected:
  void SetUp() override { messages_ = validation_messages(*kernel_device()).size(); }
  void TearDown() override {
    const auto& all = validation_messages(*kernel_device());
    for (size_t i = messages_; i < all.size(); ++i) ADD_FAILURE() << all[i];
  }

 private:
  size_t messages_ = 0;
};

}  // namespace gnomon::test
