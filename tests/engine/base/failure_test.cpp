// Exceptions of libraries as errors that name what was being worked on.
#include "engine/base/failure.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

template <class Work>
std::string text_of(Work work) {
  try {
    naming("scene.glb", work);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Failure, AnErrorStaysAsItIs) {
  EXPECT_EQ(text_of([] { fail("is empty", "a.json", "/x"); }), "a.json: /x: is empty");
}

TEST(Failure, OthersNameTheInputInPlainWords) {
  const std::string json = text_of([] { nlohmann::json(nullptr).get<double>(); });
  EXPECT_TRUE(json.starts_with("scene.glb: ")) << json;
  EXPECT_EQ(json.find("json.exception"), std::string::npos) << json;
  EXPECT_NE(json.find("must be number"), std::string::npos) << json;
  const std::string memory = text_of([] { throw std::bad_alloc(); });
  EXPECT_TRUE(memory.starts_with("scene.glb: out of memory (")) << memory;
  const std::string files = text_of([] {
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/nonexistent/folder")) {
    }
  });
  EXPECT_EQ(files, "/nonexistent/folder: No such file or directory");
  EXPECT_EQ(text_of([] { throw 3; }), "scene.glb: failed for a reason that is not known");
}

TEST(Failure, WhatIsReturnedIsReturned) {
  EXPECT_EQ(naming("x", [] { return 7; }), 7);
}

}  // namespace
}  // namespace gnomon
