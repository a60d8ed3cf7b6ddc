// Decodes version 1 of meshoptimizer's attribute streams: bytes apart, deltas in groups of 16, few bits each.
#include "engine/scene/meshopt_stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace gnomon {
namespace {

constexpr size_t kGroup = 16;            // elements whose deltas of one byte have one width
constexpr size_t kMostInBlock = 256;     // elements
constexpr size_t kBlockBytes = 8192;     // at most
constexpr size_t kSmallestTail = 24;     // bytes, padding included
constexpr size_t kLargestElement = 256;  // bytes

class Reader {
 public:
  explicit Reader(std::span<const unsigned char> bytes) : bytes_(bytes) {}
  // Nothing where the stream ends too early; good() is false from then on.
  std::span<const unsigned char> take(size_t count) {
    if (count > bytes_.size()) {
      good_ = false;
      return {};
    }
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  bool good() const { return good_; }
  bool done() const { return good_ && bytes_.empty(); }

 private:
  std::span<const unsigned char> bytes_;
  bool good_ = true;
};

// Deltas of one group in `bits` bits each; all ones mean that the delta follows as a whole byte.
void read_group(Reader& reader, unsigned bits, unsigned char* deltas) {
  if (bits == 0) return;  // zeros
  const auto packed = reader.take(kGroup * bits / 8);
  if (packed.empty()) return;
  if (bits == 8) {
    std::copy(packed.begin(), packed.end(), deltas);
    return;
  }
  const unsigned ones = (1u << bits) - 1, per_byte = 8 / bits;
  for (unsigned i = 0; i < kGroup; ++i) {
    const unsigned place = i % per_byte;
    // Single bits begin with the least significant one, wider ones with the most significant.
    const unsigned shift = bits == 1 ? place : 8 - bits * (place + 1);
    const unsigned value = packed[i / per_byte] >> shift & ones;
    if (value != ones) {
      deltas[i] = static_cast<unsigned char>(value);
      continue;
    }
    const auto whole = reader.take(1);
    if (whole.empty()) return;
    deltas[i] = whole[0];
  }
}

// Deltas of one byte of all elements of a block.
void read_deltas(Reader& reader, unsigned control, size_t count, unsigned char* deltas) {
  constexpr std::array<std::array<unsigned, 4>, 2> widths = {{{0, 1, 2, 4}, {1, 2, 4, 8}}};
  if (control == 2) return;  // zeros
  if (control == 3) {
    const auto literal = reader.take(count);
    std::copy(literal.begin(), literal.end(), deltas);
    return;
  }
  const size_t groups = (count + kGroup - 1) / kGroup;
  const auto header = reader.take((groups + 3) / 4);
  if (header.empty()) return;
  for (size_t g = 0; g < groups; ++g)
    read_group(reader, widths[control][header[g / 4] >> (2 * (g % 4)) & 3], deltas + g * kGroup);
}

template <typename T>
T unzigzag(T v) {
  return static_cast<T>((v & 1) != 0 ? ~(v >> 1) : v >> 1);
}

// The value after `previous`, from its delta; both are the channel's four bytes, little-endian.
uint32_t next_value(uint32_t previous, uint32_t delta, unsigned mode) {
  uint32_t result = 0;
  switch (mode & 0xF) {
    case 0:
      for (unsigned s = 0; s < 32; s += 8)
        result |= uint32_t(uint8_t((previous >> s) + unzigzag(uint8_t(delta >> s)))) << s;
      return result;
    case 1:
      for (unsigned s = 0; s < 32; s += 16)
        result |= uint32_t(uint16_t((previous >> s) + unzigzag(uint16_t(delta >> s)))) << s;
      return result;
    default:
      return previous ^ std::rotr(delta, static_cast<int>(mode >> 4));
  }
}

bool valid_mode(unsigned char mode) { return mode == 0 || mode == 1 || (mode & 0xF) == 2; }

}  // namespace

bool decode_attributes_v1(std::span<unsigned char> out, size_t count, size_t stride,
                          std::span<const unsigned char> in) {
  const size_t channels = stride / 4, tail = stride + channels;
  if (stride == 0 || stride % 4 != 0 || stride > kLargestElement || out.size() < count * stride) return false;
  if (in.size() < 1 + std::max(tail, kSmallestTail) || in[0] != 0xA1) return false;
  std::array<uint32_t, kLargestElement / 4> last{};
  std::memcpy(last.data(), in.data() + in.size() - tail, stride);
  const auto modes = in.last(channels);
  if (!std::all_of(modes.begin(), modes.end(), valid_mode)) return false;

  Reader reader(in.subspan(1, in.size() - 1 - std::max(tail, kSmallestTail)));
  const size_t most = std::min(kBlockBytes / stride / kGroup * kGroup, kMostInBlock);
  std::vector<unsigned char> deltas(stride * most);
  for (size_t first = 0; first < count; first += most) {
    const size_t elements = std::min(count - first, most);
    const auto control = reader.take(channels);
    if (control.empty()) return false;
    std::fill(deltas.begin(), deltas.end(), static_cast<unsigned char>(0));
    for (size_t b = 0; b < stride; ++b)
      read_deltas(reader, control[b / 4] >> (2 * (b % 4)) & 3u, elements, &deltas[b * most]);
    if (!reader.good()) return false;
    for (size_t c = 0; c < channels; ++c)
      for (size_t i = 0; i < elements; ++i) {
        uint32_t delta = 0;
        for (size_t k = 0; k < 4; ++k) delta |= uint32_t{deltas[(4 * c + k) * most + i]} << (8 * k);
        last[c] = next_value(last[c], delta, modes[c]);
        std::memcpy(&out[(first + i) * stride + 4 * c], &last[c], 4);
      }
  }
  return reader.done();
}

namespace {

template <typename Unsigned, typename Signed>
void decode_colors(std::span<unsigned char> elements) {
  constexpr int largest = std::numeric_limits<Unsigned>::max();
  for (size_t at = 0; at + 4 * sizeof(Unsigned) <= elements.size(); at += 4 * sizeof(Unsigned)) {
    Unsigned in[4];
    std::memcpy(in, &elements[at], sizeof in);
    const int scale =
        (1 << std::bit_width(unsigned{in[3]})) - 1;  // of the K bits that alpha's highest bit tells
    // NOLINTNEXTLINE(bugprone-signed-char-misuse): differences, which are signed
    const int y = in[0], co = static_cast<Signed>(in[1]), cg = static_cast<Signed>(in[2]);
    const int alpha = in[3] & (scale >> 1);
    const int rgba[4] = {y + co - cg, y + cg, y - co - cg, alpha << 1 | (alpha & 1)};
    Unsigned out[4];
    for (int c = 0; c < 4; ++c)
      out[c] = static_cast<Unsigned>(std::lround(std::clamp(
          scale > 0 ? float(rgba[c]) * float(largest) / float(scale) : 0.0f, 0.0f, float(largest))));
    std::memcpy(&elements[at], out, sizeof out);
  }
}

}  // namespace

void decode_color_filter(std::span<unsigned char> elements, size_t stride) {
  if (stride == 4)
    decode_colors<uint8_t, int8_t>(elements);
  else
    decode_colors<uint16_t, int16_t>(elements);
}

}  // namespace gnomon
