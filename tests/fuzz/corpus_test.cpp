// Inputs that once found a fault, and the seeds of the mutations: each is taken or refused with an Error.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/base/input_file.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/target.h"

namespace gnomon::fuzz {

static void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

namespace {

class Fuzz : public testing::TestWithParam<Target> {};

TEST_P(Fuzz, SeedsAreTaken) {
  for (const auto& [name, bytes] : seeds(GetParam())) {
    EXPECT_EQ(try_input(GetParam(), bytes), Outcome::taken) << name;
  }
}

TEST_P(Fuzz, TheKeptCorpusFindsNothing) {
  const std::filesystem::path folder =
      std::filesystem::path(GNOMON_TEST_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / GetParam().name;
  if (!std::filesystem::is_directory(folder)) return;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    EXPECT_NO_THROW(try_input(GetParam(), read_input_file(entry.path())));
  }
}

TEST_P(Fuzz, MutationsAreTheSameForTheSameSeed) {
  const auto formless = [](std::string bytes, size_t) { return bytes + "x"; };
  constexpr size_t most = 1 << 20;
  for (const auto& [name, bytes] : seeds(GetParam()))
    for (unsigned seed = 0; seed < 3; ++seed)
      EXPECT_EQ(mutated(GetParam().kind, bytes, most, seed, formless),
                mutated(GetParam().kind, bytes, most, seed, formless))
          << name;
}

INSTANTIATE_TEST_SUITE_P(Targets, Fuzz, testing::ValuesIn(targets()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace gnomon::fuzz
