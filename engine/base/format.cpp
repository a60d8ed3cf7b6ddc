// Sizes, names and kinds of image formats.
#include "engine/base/format.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace gnomon {
namespace {

struct FormatRow {
  VkFormat format;
  const char* name;
  uint32_t bytes;  // a texel
};

#define ROW(name, bytes) \
  { VK_FORMAT_##name, #name, bytes }
constexpr FormatRow kRows[] = {
    ROW(R8_UNORM, 1),
    ROW(R8_SNORM, 1),
    ROW(R8_UINT, 1),
    ROW(R8_SINT, 1),
    ROW(R8G8_UNORM, 2),
    ROW(R8G8_SNORM, 2),
    ROW(R8G8_UINT, 2),
    ROW(R8G8_SINT, 2),
    ROW(R8G8B8A8_UNORM, 4),
    ROW(R8G8B8A8_SNORM, 4),
    ROW(R8G8B8A8_UINT, 4),
    ROW(R8G8B8A8_SINT, 4),
    ROW(R8G8B8A8_SRGB, 4),
    ROW(B8G8R8A8_UNORM, 4),
    ROW(B8G8R8A8_SRGB, 4),
    ROW(A2B10G10R10_UNORM_PACK32, 4),
    ROW(B10G11R11_UFLOAT_PACK32, 4),
    ROW(E5B9G9R9_UFLOAT_PACK32, 4),
    ROW(R16_UNORM, 2),
    ROW(R16_SNORM, 2),
    ROW(R16_UINT, 2),
    ROW(R16_SINT, 2),
    ROW(R16_SFLOAT, 2),
    ROW(R16G16_UNORM, 4),
    ROW(R16G16_SNORM, 4),
    ROW(R16G16_UINT, 4),
    ROW(R16G16_SINT, 4),
    ROW(R16G16_SFLOAT, 4),
    ROW(R16G16B16A16_UNORM, 8),
    ROW(R16G16B16A16_SNORM, 8),
    ROW(R16G16B16A16_UINT, 8),
    ROW(R16G16B16A16_SINT, 8),
    ROW(R16G16B16A16_SFLOAT, 8),
    ROW(R32_UINT, 4),
    ROW(R32_SINT, 4),
    ROW(R32_SFLOAT, 4),
    ROW(R32G32_UINT, 8),
    ROW(R32G32_SINT, 8),
    ROW(R32G32_SFLOAT, 8),
    ROW(R32G32B32A32_UINT, 16),
    ROW(R32G32B32A32_SINT, 16),
    ROW(R32G32B32A32_SFLOAT, 16),
    ROW(R64_UINT, 8),
    ROW(D16_UNORM, 2),
    ROW(X8_D24_UNORM_PACK32, 4),
    ROW(D32_SFLOAT, 4),
    ROW(S8_UINT, 1),
    ROW(D16_UNORM_S8_UINT, 4),
    ROW(D24_UNORM_S8_UINT, 4),
    ROW(D32_SFLOAT_S8_UINT, 8),
};
#undef ROW

const FormatRow* find_row(VkFormat format) {
  const auto row = std::find_if(std::begin(kRows), std::end(kRows),
                                [&](const FormatRow& r) { return r.format == format; });
  return row == std::end(kRows) ? nullptr : row;
}

constexpr uint64_t kHuge = std::numeric_limits<uint64_t>::max();

uint64_t times(uint64_t a, uint64_t b) { return b != 0 && a > kHuge / b ? kHuge : a * b; }
uint64_t plus(uint64_t a, uint64_t b) { return a > kHuge - b ? kHuge : a + b; }

}  // namespace

uint32_t texel_bytes(VkFormat format) {
  const FormatRow* row = find_row(format);
  return row ? row->bytes : 16;
}

std::string format_name(VkFormat format) {
  const FormatRow* row = find_row(format);
  return row ? row->name : "format " + std::to_string(int(format));
}

bool is_depth(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_S8_UINT:
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return true;
    default:
      return false;
  }
}

uint64_t bytes_of(const ImageShape& image) {
  uint64_t texels = 0;
  for (uint32_t mip = 0; mip < image.mips && mip < 32; ++mip) {
    const uint64_t width = std::max(1u, image.extent.width >> mip);
    const uint64_t height = std::max(1u, image.extent.height >> mip);
    texels = plus(texels, times(width, height));
  }
  return times(times(texels, image.layers), texel_bytes(image.format));
}

uint64_t bytes_of(const BufferShape& buffer) { return times(buffer.count, buffer.stride); }

}  // namespace gnomon
