// Typed parameters: defaults, ranges, variables, and look-ups.
#include "engine/base/params.h"

#include <gtest/gtest.h>

#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/graph/pass.h"

namespace gnomon {
namespace {

using Strings = std::vector<std::string>;

struct Answers {
  bool flag;
  int64_t integer;
  double number;
  std::string choice;
};

Answers declare(Declaration& d) {
  return {d.flag("on", true, "flag"), d.integer("size", 512, 1, 16384, "texels", "side"),
          d.number("width", 0.5, 0, 8, "world units", "width"),
          d.choice("mode", "b", {"a", "b", "c"}, "mode")};
}

Declaration with(Values values) { return Declaration({}, std::move(values), {}); }

TEST(Params, DefaultsWhenNothingIsGiven) {
  Declaration d;
  const Answers answers = declare(d);
  EXPECT_TRUE(answers.flag);
  EXPECT_EQ(answers.integer, 512);
  EXPECT_EQ(answers.number, 0.5);
  EXPECT_EQ(answers.choice, "b");
  const Params params = d.params();
  EXPECT_EQ(params.choice_index("mode"), 1);
  EXPECT_EQ(params.integer("size"), 512);
  EXPECT_EQ(params.specs().size(), 4u);
  EXPECT_EQ(params.specs()[1].unit, "texels");
}

TEST(Params, GivenValuesAreReturnedAndConverted) {
  Declaration d = with({{"on", false}, {"size", 64.0}, {"width", int64_t{2}}, {"mode", std::string("c")}});
  const Answers answers = declare(d);
  EXPECT_FALSE(answers.flag);
  EXPECT_EQ(answers.integer, 64);
  EXPECT_EQ(answers.number, 2.0);
  EXPECT_EQ(answers.choice, "c");
  EXPECT_TRUE(d.value_errors().empty());
  EXPECT_EQ(d.params().number("width"), 2.0);
}

TEST(Params, WrongValuesAreSentencesWithRangeAndUnit) {
  Declaration d =
      with({{"on", int64_t{1}}, {"size", int64_t{0}}, {"width", 9.5}, {"mode", std::string("x")}});
  declare(d);
  const Strings expected{"'on' is 1: must be true or false", "'size' is 0: must be in 1..16384 texels",
                         "'width' is 9.5: must be in 0..8 world units",
                         "'mode' is \"x\": must be one of \"a\", \"b\", \"c\""};
  EXPECT_EQ(d.value_errors(), expected);
  EXPECT_EQ(d.params().integer("size"), 512);  // the default stands in
}

TEST(Params, MistypedNumbers) {
  Declaration d = with({{"size", 1.5}, {"width", std::string("wide")}});
  declare(d);
  const Strings expected{"'size' is 1.5: must be an integer in 1..16384 texels",
                         "'width' is \"wide\": must be a number in 0..8 world units"};
  EXPECT_EQ(d.value_errors(), expected);
}

TEST(Params, UndeclaredNames) {
  Declaration d = with({{"sizes", int64_t{1}}, {"on", true}});
  declare(d);
  EXPECT_EQ(d.undeclared(), Strings{"sizes"});
}

TEST(Params, RemembersWhatIsRead) {
  Declaration d;
  declare(d);
  const Params params = d.params();
  params.flag("on");
  params.choice("mode");
  EXPECT_EQ(params.never_read(), (Strings{"size", "width"}));
}

TEST(Params, WrongNameOrTypeIsAnError) {
  Declaration d;
  declare(d);
  const Params params = d.params();
  EXPECT_THROW(params.number("size"), Error);
  EXPECT_THROW(params.integer("sizes"), Error);
}

TEST(Declaration, TwiceTheSameNameIsAnError) {
  Declaration d;
  declare(d);
  EXPECT_THROW(d.flag("on", true, ""), Error);
  d.output("x", Access::color, false, {}, "");
  EXPECT_THROW(d.input("x", Access::sampled, false, ""), Error);
  EXPECT_THROW(d.choice("pick", "none", {"a"}, ""), Error);
}

TEST(Declaration, InputsReturnTheConnectedShape) {
  const ImageShape shape{{64, 32}, 2, 1, VK_FORMAT_R8_UNORM};
  Declaration::Inputs inputs;
  inputs["source"].image = shape;
  inputs["list"].buffer = BufferShape{12, 8, "uvec2"};
  Declaration d({}, {}, inputs);
  EXPECT_EQ(d.input("source", Access::sampled, true, ""), shape);
  EXPECT_EQ(d.optional_input("other", Access::sampled, true, ""), std::nullopt);
  EXPECT_EQ(d.input_buffer("list", Access::storage_read, "").count, 12u);
  EXPECT_EQ(d.find("source")->image, shape);
  EXPECT_TRUE(d.find("other")->optional);
  EXPECT_EQ(d.find("nothing"), nullptr);
  Declaration listing;
  EXPECT_EQ(listing.input("source", Access::sampled, true, "").extent, (Extent{1, 1}));
}

TEST(Value, TextReadsBackAsTheSameValue) {
  const std::vector<Value> values{true, false,     int64_t{0}, int64_t{-7}, INT64_MAX,           0.1,
                                  1.0,  -2.5e-300, 1e300,      1.0 / 3,     std::string("gauss")};
  for (const Value& value : values) EXPECT_EQ(parse_value(to_string(value)), value) << to_string(value);
  EXPECT_EQ(to_string(Value(0.1)), "0.1");
  EXPECT_EQ(to_string(Value(2.0)), "2.0");
}

}  // namespace
}  // namespace gnomon
