// Reading JSON files: comments, places of errors, duplicate keys.
#include "engine/base/config.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

using nlohmann::json;

std::string error_of(const std::string& text) {
  try {
    parse_json(text, "f.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParseJson, ReadsWithComments) {
  const json value =
      parse_json("// one\n{\"a\": [1, 2.5, \"x\", true, null, {\"b\": -3}] /* two */}", "f.json");
  EXPECT_EQ(value, json::parse(R"({"a": [1, 2.5, "x", true, null, {"b": -3}]})"));
  EXPECT_EQ(parse_json("7", "f"), json(7));
}

TEST(ParseJson, SyntaxErrorsHaveLineAndColumn) {
  EXPECT_TRUE(error_of("{\"a\": 1,\n  \"b\": }").starts_with("f.json: line 2, column 8: syntax error"))
      << error_of("{\"a\": 1,\n  \"b\": }");
  EXPECT_TRUE(error_of("").starts_with("f.json: line 1, column 1: syntax error")) << error_of("");
  EXPECT_TRUE(error_of("[1] 2").starts_with("f.json: line 1, column 5: ")) << error_of("[1] 2");
  EXPECT_NE(error_of("[1e999]").find("number overflow"), std::string::npos) << error_of("[1e999]");
  EXPECT_NE(error_of("\"\xff\"").find("UTF-8"), std::string::npos);
}

TEST(ParseJson, AllDuplicateKeysAreReportedWithTheirPlace) {
  EXPECT_EQ(error_of(R"({"p": [0, {"a": 1, "a": 2}], "p": 3, "x/y": {"~": 1, "~": 1}})"),
            "f.json: /p/1/a: duplicate key 'a'\nf.json: /p: duplicate key 'p'\n"
            "f.json: /x~1y/~0: duplicate key '~'");
  EXPECT_EQ(error_of(R"([{"a": 1}, {"a": 1}])"), "no error");
}

TEST(ParseJson, DepthIsLimited) {
  const std::string deep = error_of(std::string(100000, '['));
  EXPECT_NE(deep.find("nested deeper than 64 levels"), std::string::npos) << deep.substr(0, 200);
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_NE(error_of(objects).find("nested deeper"), std::string::npos);
  EXPECT_EQ(error_of(std::string(64, '[') + std::string(64, ']')), "no error");
}

TEST(ReadJson, MissingFileAndFolder) {
  EXPECT_THROW(read_json("/nonexistent/x.json"), Error);
  EXPECT_THROW(read_json(std::filesystem::temp_directory_path()), Error);
}

TEST(ObjectReader, ReportsTypesAndUnknownKeys) {
  const json object = json::parse(R"({"name": 3, "size": "big", "count": 2.5, "colour": 1})");
  Problems problems;
  ObjectReader reader(object, "f.json", "/x", problems);
  EXPECT_EQ(reader.text("name", "d"), "d");
  EXPECT_EQ(reader.number("size", 7), 7);
  EXPECT_EQ(reader.integer("count", 4), 4);
  EXPECT_EQ(reader.find("color"), nullptr);
  EXPECT_EQ(reader.required_text("id"), "");
  EXPECT_EQ(reader.place_of("a/b"), "/x/a~1b");
  reader.finish();
  std::string text;
  for (const Problem& problem : problems.all()) text += to_string(problem) + "\n";
  EXPECT_EQ(text,
            "f.json: /x/name: 'name' is 3: must be a string\n"
            "f.json: /x/size: 'size' is \"big\": must be a number\n"
            "f.json: /x/count: 'count' is 2.5: must be an integer\n"
            "f.json: /x: 'id' is missing\n"
            "f.json: /x/colour: unknown key 'colour' (did you mean 'color'?)\n");
}

TEST(ObjectReader, NeedsAnObject) {
  Problems problems;
  ObjectReader reader(json::array(), "f", "/x", problems);
  EXPECT_EQ(reader.required_text("id"), "");
  reader.finish();
  ASSERT_EQ(problems.all().size(), 1u);
  EXPECT_EQ(to_string(problems.all()[0]), "f: /x: is an array: must be an object");
}

TEST(CanonicalHash, IgnoresOrderAndSpelling) {
  const std::string one = canonical_hash(parse_json(R"({"a": 1, "b": [512, 0.5, "x"]})", ""));
  EXPECT_EQ(one, canonical_hash(parse_json(R"({"b": [5.12e2, 5e-1, "x"], "a": 1.0})", "")));
  EXPECT_EQ(one.size(), 16u);
  EXPECT_EQ(canonical_hash(json(0)), canonical_hash(json(-0.0)));
}

TEST(CanonicalHash, TellsDifferentValuesApart) {
  const std::vector<std::string> texts{"1",       "\"1\"",        "true", "null",
                                       "[1]",     "{\"1\":1}",    "[]",   "{}",
                                       "[[],1]",  "[[1]]",        "0.1",  "0.10000000000000002",
                                       "\"a,b\"", "[\"a\",\"b\"]"};
  std::map<std::string, std::string> seen;
  for (const std::string& text : texts) {
    const auto [found, fresh] = seen.emplace(canonical_hash(parse_json(text, "")), text);
    EXPECT_TRUE(fresh) << text << " and " << found->second;
  }
}

TEST(ToValue, KeepsTypes) {
  Problems problems;
  EXPECT_EQ(to_value(json(3), "f", "/x", problems), Value(int64_t{3}));
  EXPECT_EQ(to_value(json(3.0), "f", "/x", problems), Value(3.0));
  EXPECT_EQ(to_value(json(true), "f", "/x", problems), Value(true));
  EXPECT_TRUE(problems.empty());
  to_value(json(18446744073709551615ull), "f", "/x", problems);
  to_value(json::object(), "f", "/x", problems);
  to_value(json(), "f", "/x", problems);
  EXPECT_EQ(problems.all().size(), 3u);
}

TEST(ParseValue, FromTheCommandLine) {
  EXPECT_EQ(parse_value("true"), Value(true));
  EXPECT_EQ(parse_value("-12"), Value(int64_t{-12}));
  EXPECT_EQ(parse_value("1e3"), Value(1000.0));
  EXPECT_EQ(parse_value("box"), Value(std::string("box")));
  EXPECT_EQ(parse_value("nan"), Value(std::string("nan")));
  EXPECT_EQ(parse_value("12x"), Value(std::string("12x")));
  EXPECT_EQ(parse_value(""), Value(std::string()));
}

TEST(ExpandSweep, EveryCombination) {
  Problems problems;
  const auto rows =
      expand_sweep(json::parse(R"({"kernel": [7, 15], "map": 512, "mode": ["a", "b"]})"), "f", "", problems);
  ASSERT_TRUE(problems.empty());
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].at("kernel"), Value(int64_t{7}));
  EXPECT_EQ(rows[1].at("kernel"), Value(int64_t{7}));
  EXPECT_EQ(rows[1].at("mode"), Value(std::string("b")));
  EXPECT_EQ(rows[3].at("map"), Value(int64_t{512}));
  EXPECT_EQ(expand_sweep(json::object(), "f", "", problems).size(), 1u);
}

TEST(ExpandSweep, BadInput) {
  Problems problems;
  expand_sweep(json::parse(R"({"a": [], "b": [[1]]})"), "f", "/set", problems);
  expand_sweep(json(3), "f", "/set", problems);
  json big = json::object();
  for (char c = 'a'; c < 'h'; ++c) big[std::string(1, c)] = std::vector<int>(10, 1);
  expand_sweep(big, "f", "/set", problems);
  EXPECT_EQ(problems.all().size(), 4u);
}

}  // namespace
}  // namespace gnomon
