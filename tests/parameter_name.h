// Readable names of the parameters that tests are run with.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace gnomon::test {

// Letters, digits and '_', as GoogleTest asks of a test's name.
inline std::string identifier(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return text;
}

// As PrintTo() of the parameter's type, or the stream's operator, prints it; of a file its stem.
struct ParameterName {
  template <typename T>
  std::string operator()(const testing::TestParamInfo<T>& info) const {
    return identifier(testing::PrintToString(info.param));
  }
  std::string operator()(const testing::TestParamInfo<std::string>& info) const {
    return identifier(info.param);
  }
  std::string operator()(const testing::TestParamInfo<std::filesystem::path>& info) const {
    return identifier(info.param.stem().string());
  }
};

}  // namespace gnomon::test
