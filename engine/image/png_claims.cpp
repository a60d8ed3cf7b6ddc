// Compares the lengths and the size that a PNG file states with its bytes.
#include "engine/image/png_claims.h"

#include <algorithm>
#include <array>

namespace gnomon::png {
namespace {

constexpr std::array<uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr uint64_t kChunkHead = 8, kChecksum = 4;  // bytes: length and type; after the data
constexpr uint64_t kMostExpansion = 1032;          // of deflate
constexpr std::array<uint64_t, 7> kChannels = {1, 1, 3, 1, 2, 1, 4};  // by colour type

uint64_t word(std::span<const uint8_t> bytes, uint64_t at) {
  uint64_t value = 0;
  for (uint64_t i = at; i < at + 4; ++i) value = value << 8 | bytes[i];
  return value;
}

// Bytes of the rows that the header in the first chunk asks for, each with a byte that names its filter.
uint64_t claimed_bytes(std::span<const uint8_t> bytes) {
  constexpr uint64_t kHeader = kSignature.size() + kChunkHead;
  if (bytes.size() < kHeader + 10) return 0;
  const uint64_t width = word(bytes, kHeader), height = word(bytes, kHeader + 4);
  const uint64_t depth = bytes[kHeader + 8],
                 type = std::min<uint64_t>(bytes[kHeader + 9], kChannels.size() - 1);
  return height * (1 + (width * depth * kChannels[type] + 7) / 8);
}

}  // namespace

std::string false_claim(std::span<const uint8_t> bytes) {
  if (bytes.size() < kSignature.size() || !std::equal(kSignature.begin(), kSignature.end(), bytes.begin()))
    return {};
  for (uint64_t at = kSignature.size(); at + kChunkHead <= bytes.size();) {
    const uint64_t length = word(bytes, at), left = bytes.size() - at - kChunkHead;
    if (length > left) return "a chunk is longer than the rest of the file";
    at += kChunkHead + length + kChecksum;
  }
  if (claimed_bytes(bytes) / kMostExpansion > bytes.size())
    return "it claims more pixels than its bytes can hold";
  return {};
}

}  // namespace gnomon::png
