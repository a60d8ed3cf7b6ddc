// What needs more than --memory is refused at once, by name and size, and nothing is written.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/faults/program.h"

namespace gnomon::test {
namespace {

// Largest resident size of any process that this one has waited for, bytes.
uint64_t largest_child() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;
}

const std::vector<std::string> small = {"--device", "llvmpipe", "--repeat", "1", "--out", "new"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more = small) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(MemoryLimit, MapsThatNeedMoreAreRefusedBeforeAnythingIsAllocated) {
  const Program program("maps");
  const uint64_t before = largest_child();
  const Ended ended = program.run(
      with({"render", "square_plane", "--graph", "esm", "--set", "shadow_map=16384", "--size", "64x48"}));
  EXPECT_EQ(ended.status, 2);
  for (const char* part : {"it needs 4 GB of memory, and 1 GB are allowed", "map.depth 1 GB",
                           "moments.moments 1 GB", "--memory 5GB allows it"})
    EXPECT_NE(ended.error.find(part), std::string::npos) << part << "\n" << ended.error;
  EXPECT_TRUE(program.content().empty());
  EXPECT_LT(largest_child(), before + (uint64_t{512} << 20));
}

TEST(MemoryLimit, SizesThatNeedMoreAreRefusedBeforeAnythingIsAllocated) {
  const Program program("size");
  const uint64_t before = largest_child();
  const Ended ended =
      program.run(with({"render", "square_plane", "--graph", "shadow_mapping", "--size", "16384x16384"}));
  EXPECT_EQ(ended.status, 2);
  EXPECT_NE(ended.error.find("GB of memory, and 1 GB are allowed"), std::string::npos) << ended.error;
  EXPECT_TRUE(program.content().empty());
  EXPECT_LT(largest_child(), before + (uint64_t{512} << 20));
}

TEST(MemoryLimit, WhatTheCommandLineAllowsIsRendered) {
  const Program program("allowed");
  const std::vector<std::string> render = {"render", "square_plane", "--graph", "msm", "--size", "64x48"};
  const Ended refused = program.run(with(render, with({"--memory", "50MB"})));
  EXPECT_EQ(refused.status, 2) << refused.error;
  EXPECT_NE(refused.error.find("--memory 1GB allows it"), std::string::npos) << refused.error;
  const Ended taken = program.run(with(render, with({"--memory", "64MB"})));
  EXPECT_EQ(taken.status, 0) << taken.error;
}

}  // namespace
}  // namespace gnomon::test
