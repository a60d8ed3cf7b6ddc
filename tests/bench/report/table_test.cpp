// Tables of result rows, word by word.
#include "bench/report/table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

namespace gnomon {
namespace {

using nlohmann::json;

std::string to_table(const std::vector<json>& objects) {
  std::vector<Row> rows;
  for (const json& one : objects) rows.push_back(row_from(one));
  return gnomon::to_table(rows);
}

json row(const std::string& scene, const std::string& graph, int map, double misclassified, double ms,
         double ratio) {
  return {{"scene", scene},
          {"graph", graph},
          {"vars", {{"shadow_map", map}, {"bias", "normal_offset"}}},
          {"size", {640, 360}},
          {"error",
           {{"misclassified", misclassified},
            {"rmse", 0.05},
            {"wrongly_lit", 0.001},
            {"wrongly_shadowed", 0.002}}},
          {"frame_ms", {{"median", ms}}},
          {"ratio", {{"median", ratio}}},
          {"status", "ok"}};
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> all;
  for (std::string word; stream >> word;) all.push_back(word);
  return all;
}

// Words of the n-th line that begins with `technique`, counted from 0.
std::vector<std::string> line_of(const std::string& table, const std::string& technique, int n = 0) {
  std::istringstream stream(table);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("  " + technique) && n-- == 0) return words(line);
  return {};
}

TEST(Table, SharesArePerCentAndAbsentFiguresAreDashes) {
  const std::string table = to_table({row("fence", "shadow_mapping", 1024, 0.0125, 8.5, 1)});
  EXPECT_NE(table.find("fence, 640x360"), std::string::npos);
  EXPECT_EQ(line_of(table, "shadow_mapping"),
            (std::vector<std::string>{"shadow_mapping", "1.250", "0.100", "0.200", "-", "0.0500", "8.50",
                                      "1.000"}));
}

TEST(Table, OnlyVaryingVariablesAreShown) {
  const std::string table = to_table(
      {row("fence", "shadow_mapping", 512, 0.02, 8, 1), row("fence", "shadow_mapping", 1024, 0.01, 9, 1)});
  EXPECT_NE(table.find("shadow_mapping shadow_map=512"), std::string::npos);
  EXPECT_NE(table.find("shadow_mapping shadow_map=1024"), std::string::npos);
  EXPECT_EQ(table.find("bias"), std::string::npos);
}

TEST(Table, SequencesHaveTwoMoreColumns) {
  json moving = row("pendulum", "pcf", 1024, 0.01, 8, 1);
  EXPECT_EQ(to_table({moving}).find("flicker"), std::string::npos);
  moving["sequence"] = {{"rmse", {{"mean", 0.0625}, {"max", 0.1}}}};
  moving["flicker"] = 0.003;
  const std::string table = to_table({moving});
  EXPECT_NE(table.find("mean RMSE"), std::string::npos);
  EXPECT_NE(table.find("flicker"), std::string::npos);
  const auto words = line_of(table, "pcf");
  EXPECT_NE(std::find(words.begin(), words.end(), "0.0625"), words.end());
  EXPECT_NE(std::find(words.begin(), words.end(), "0.00300"), words.end());
}

TEST(Table, FailureShowsItsFirstLine) {
  json failed = row("fence", "shadow_volumes", 1024, 0, 0, 0);
  failed["status"] = "error: out of device memory\nmore";
  const std::string table = to_table({row("fence", "shadow_mapping", 1024, 0.01, 9, 1), failed});
  EXPECT_NE(table.find("error: out of device memory\n"), std::string::npos);
  EXPECT_EQ(table.find("more"), std::string::npos);
}

TEST(Table, MeansAreOverScenesThatHaveTheFigure) {
  json failed = row("robot", "b", 1024, 0.5, 50, 5);
  failed["status"] = "error: no";
  const std::string table =
      to_table({row("fence", "a", 1024, 0.01, 10, 1), row("fence", "b", 1024, 0.02, 20, 2),
                row("robot", "a", 1024, 0.03, 30, 1), failed});
  EXPECT_NE(table.find("mean of 2 scenes and sizes"), std::string::npos);
  EXPECT_EQ(line_of(table, "a ", 2).at(1), "2.000");
  EXPECT_EQ(line_of(table, "a ", 2).at(6), "20.00");
  EXPECT_EQ(line_of(table, "b ", 2).at(1), "2.000");
}

TEST(Table, ColumnsLineUp) {
  const std::string table = to_table(
      {row("fence", "shadow_mapping", 1024, 0.01, 9, 1), row("fence", "rbsm", 1024, 0.01, 12345.678, 1)});
  std::istringstream stream(table);
  std::string line;
  std::getline(stream, line);
  std::getline(stream, line);
  const size_t width = line.size();
  for (int i = 0; i < 2; ++i) {
    std::getline(stream, line);
    EXPECT_EQ(line.size(), width);
  }
}

TEST(Table, NoRowsGiveNoText) { EXPECT_EQ(gnomon::to_table(std::vector<Row>()), ""); }

}  // namespace
}  // namespace gnomon
