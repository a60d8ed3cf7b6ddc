// Tests of this program that have a parameter say in their name which.
#include <gtest/gtest.h>

#include <regex>

namespace gnomon {
namespace {

TEST(ParameterNames, AreReadable) {
  const std::regex number("/[0-9]+$"), object("-byte object");
  const testing::UnitTest& program = *testing::UnitTest::GetInstance();
  for (int s = 0; s < program.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *program.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      if (test.value_param() == nullptr) continue;
      EXPECT_FALSE(std::regex_search(test.name(), number)) << suite.name() << "." << test.name();
      EXPECT_FALSE(std::regex_search(test.value_param(), object)) << suite.name() << "." << test.name();
    }
  }
}

}  // namespace
}  // namespace gnomon
