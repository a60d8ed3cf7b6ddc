// The text of errors.
#include "engine/base/error.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(Error, TextHasOnlyThePartsThatAreThere) {
  EXPECT_EQ(to_string(Problem{"it broke", {}, {}, {}}), "it broke");
  EXPECT_EQ(to_string(Problem{"it broke", "a.json", "/passes/1", "mend it"}),
            "a.json: /passes/1: it broke (mend it)");
  EXPECT_EQ(to_string(Problem{"it broke", {}, "line 3", {}}), "line 3: it broke");
}

TEST(Error, CarriesAllProblemsOneALine) {
  Problems problems;
  EXPECT_NO_THROW(problems.raise());
  problems.add("first", "f");
  problems.add("second", {}, "/x", "hint");
  try {
    problems.raise();
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "f: first\n/x: second (hint)");
    EXPECT_EQ(error.problems().size(), 2u);
  }
  EXPECT_THROW(fail("x"), Error);
}

TEST(DidYouMean, NamesTheNearest) {
  const std::vector<std::string> names{"gbuffer", "shadow_map", "compose"};
  EXPECT_EQ(did_you_mean("gbufer", names), "did you mean 'gbuffer'?");
  EXPECT_EQ(did_you_mean("shadowmap", names), "did you mean 'shadow_map'?");
  EXPECT_EQ(did_you_mean("zzzzzzz", names), "one of: gbuffer, shadow_map, compose");
  EXPECT_EQ(did_you_mean("gbuf", std::vector<std::string>{"gbuffer"}), "one of: gbuffer");  // distance 3
}

TEST(DidYouMean, LimitIsATwoOrAThirdOfTheLength) {
  const std::vector<std::string> names{"abcdefghijkl"};
  EXPECT_EQ(did_you_mean("abcdefghWXYZ", names), "did you mean 'abcdefghijkl'?");  // 4 of 12
  EXPECT_EQ(did_you_mean("abcdefgVWXYZ", names), "one of: abcdefghijkl");          // 5 of 12
  EXPECT_EQ(did_you_mean("xy", std::vector<std::string>{"id"}), "one of: id");     // nothing in common
}

TEST(DidYouMean, SaysNothingAboutManyCandidates) {
  std::vector<std::string> names;
  for (int i = 0; i < 13; ++i) names.push_back("candidate_" + std::to_string(i));
  EXPECT_EQ(did_you_mean("other", names), "");
  EXPECT_EQ(did_you_mean("other", {}), "");
  EXPECT_EQ(did_you_mean("", std::vector<std::string>{"a"}), "one of: a");
}

}  // namespace
}  // namespace gnomon
