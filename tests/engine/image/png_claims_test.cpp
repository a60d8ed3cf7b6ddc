// What PNG files say of their size is held against their bytes.
#include "engine/image/png_claims.h"

#include <gtest/gtest.h>

#include <vector>

namespace gnomon::png {
namespace {

using Bytes = std::vector<uint8_t>;

void add_word(Bytes& bytes, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(uint8_t(value >> shift));
}
void add_chunk(Bytes& bytes, const char* type, uint32_t length, const Bytes& data) {
  add_word(bytes, length);
  bytes.insert(bytes.end(), type, type + 4);
  bytes.insert(bytes.end(), data.begin(), data.end());
  add_word(bytes, 0);  // the checksum, which nobody asks for
}
// Eight bits a channel; `length`: that the second chunk claims.
Bytes file(uint32_t width, uint32_t height, uint8_t type, uint32_t length, size_t data) {
  Bytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'}, header;
  add_word(header, width), add_word(header, height);
  for (const uint8_t value : {uint8_t(8), type, uint8_t(0), uint8_t(0), uint8_t(0)}) header.push_back(value);
  add_chunk(bytes, "IHDR", 13, header);
  add_chunk(bytes, "IDAT", length, Bytes(data));
  return bytes;
}

TEST(PngClaims, LengthsAndSizesThatTheBytesCanHoldAreBelieved) {
  EXPECT_EQ(false_claim(file(4, 2, 0, 30, 30)), "");
  EXPECT_EQ(false_claim(file(100, 250, 6, 100, 100)), "");  // 100 KB of about 150 bytes
  EXPECT_EQ(false_claim({}), "");
  EXPECT_EQ(false_claim(Bytes{'B', 'M', 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}), "");
}

TEST(PngClaims, OthersAreNot) {
  EXPECT_NE(false_claim(file(4, 2, 0, 0x26114944, 30)), "");
  EXPECT_NE(false_claim(file(4, 2, 0, 35, 30)), "");
  EXPECT_NE(false_claim(file(20000, 20000, 6, 100, 100)), "");
  EXPECT_NE(false_claim(file(1u << 31, 1u << 31, 6, 100, 100)), "");
}

}  // namespace
}  // namespace gnomon::png
