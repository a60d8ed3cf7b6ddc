// Names that would steer a terminal.
#include "engine/base/printable.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(Printable, LeavesOrdinaryTextAsItIs) {
  const std::string text = "d\xC3\xA9j\xC3\xA0 vu, \xE6\x97\xA5\xE6\x9C\xAC, \xF0\x9F\x98\x80 100 %";
  EXPECT_EQ(printable(text), text);
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, ShowsWhatSteersTheTerminal) {
  EXPECT_EQ(printable("\x1b]0;owned\x07\x1b[2J"), "\\x1b]0;owned\\x07\\x1b[2J");
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\x0dd");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\x7f\xC2\x9B"
                      "31m"),
            "\\x7f\\x9b31m");  // delete, and the one-character CSI
  EXPECT_EQ(printable("abc\xE2\x80\xAE"
                      "fdp"),
            "abc\\u202efdp");  // right-to-left override
  EXPECT_EQ(printable("\xE2\x80\xA8"), "\\u2028");
}

TEST(Printable, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            "\\x9b31m");
  EXPECT_EQ(printable("a\xC3"), "a\\xc3");
  EXPECT_EQ(printable("\xC0\x80"), "\\xc0\\x80");           // not the shortest form
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(printable("\xF5\x80\x80\x80"), "\\xf5\\x80\\x80\\x80");
}

TEST(Printable, LinesMayStay) { EXPECT_EQ(printable_lines("a\n\x1b[1mb\n"), "a\n\\x1b[1mb\n"); }

}  // namespace
}  // namespace gnomon
