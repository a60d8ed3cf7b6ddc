// A run that fails takes away what it made, and nothing else.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "engine/base/error.h"
#include "tests/faults/program.h"
#include "tools/output_folder.h"

namespace gnomon::test {
namespace {

namespace fs = std::filesystem;

class OutputFolderTest : public testing::Test {
 protected:
  Program program_{testing::UnitTest::GetInstance()->current_test_info()->name()};
  const fs::path root_ = program_.folder();
};

TEST_F(OutputFolderTest, NothingRemainsOfARunThatFails) {
  {
    OutputFolder folder(root_ / "new" / "a");
    std::ofstream(folder.file("x")) << 1;
  }
  EXPECT_TRUE(program_.content().empty());
}

TEST_F(OutputFolderTest, WhatAnotherRunFinishedMeanwhileStays) {
  {
    OutputFolder failing(root_ / "new" / "a");
    OutputFolder other(root_ / "new" / "b");
    std::ofstream(other.file("x")) << "result";
    other.keep();
  }
  EXPECT_EQ(program_.read("new/b/x"), "result");
  EXPECT_FALSE(fs::exists(root_ / "new" / "a"));
}

TEST_F(OutputFolderTest, WhatWasThereStays) {
  program_.write("old/x", "before");
  { OutputFolder folder(root_ / "old"); }
  EXPECT_EQ(program_.read("old/x"), "before");
  EXPECT_EQ(program_.content().size(), 2u);
}

TEST_F(OutputFolderTest, AFolderInPlaceOfAResultIsRefusedBeforeAnythingIsReplaced) {
  program_.write("out/a", "before");
  program_.write("out/b/inside", "before");
  OutputFolder folder(root_ / "out");
  for (const char* name : {"a", "b"}) std::ofstream(folder.file(name)) << "after";
  EXPECT_THROW(folder.keep(), Error);
  EXPECT_EQ(program_.read("out/a"), "before");
}

TEST_F(OutputFolderTest, AFileInPlaceOfAFolderIsAnError) {
  program_.write("file", "before");
  EXPECT_THROW(OutputFolder(root_ / "file" / "a"), Error);
  EXPECT_EQ(program_.read("file"), "before");
}

TEST_F(OutputFolderTest, ALateFailureOfRenderLeavesAnothersResults) {
  program_.write("new/b/result", "finished");
  const Ended ended = program_.run({"render", "absent", "--graph", "pcf", "--out", "new/a"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(program_.read("new/b/result"), "finished");
}

}  // namespace
}  // namespace gnomon::test
