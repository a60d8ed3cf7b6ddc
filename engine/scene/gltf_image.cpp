// PNG and JPEG through tinygltf's stb_image, WebP through libwebp; other kinds are named.
#include "engine/scene/gltf_image.h"

#include <webp/decode.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "engine/base/error.h"
#include "engine/image/png_claims.h"
#include "engine/scene/gltf_uri.h"

namespace gnomon {
namespace {

constexpr int kLargestSide = 16384;  // texels

bool begins(const Bytes& bytes, std::string_view magic, size_t offset = 0) {
  return bytes.size() >= offset + magic.size() &&
         std::memcmp(bytes.data() + offset, magic.data(), magic.size()) == 0;
}

bool is_webp(const Bytes& bytes) { return begins(bytes, "RIFF") && begins(bytes, "WEBP", 8); }

// Error when there is none.
Bytes encoded(const GltfFile& gltf, const tinygltf::Image& image) {
  if (image.bufferView < 0) return read_uri(gltf.folder, image.uri);
  const auto& views = gltf.model.bufferViews;
  if (static_cast<size_t>(image.bufferView) >= views.size())
    fail("there is no buffer view " + std::to_string(image.bufferView));
  const tinygltf::BufferView& view = views[static_cast<size_t>(image.bufferView)];
  const auto& data = gltf.model.buffers.at(static_cast<size_t>(view.buffer)).data;
  if (view.byteOffset + view.byteLength > data.size()) fail("its buffer view has no data");
  const auto begin = data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
  return {begin, begin + static_cast<std::ptrdiff_t>(view.byteLength)};
}

std::string decode_webp(const Bytes& bytes, Texture& texture) {
  int width = 0, height = 0;
  if (WebPGetInfo(bytes.data(), bytes.size(), &width, &height) == 0) return "it is not a WebP image";
  if (width > kLargestSide || height > kLargestSide) return "it is too large";
  std::vector<uint8_t> rgba(size_t{4} * static_cast<size_t>(width) * static_cast<size_t>(height));
  if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), rgba.data(), rgba.size(), 4 * width) == nullptr)
    return "its WebP data is broken";
  texture.width = static_cast<uint32_t>(width), texture.height = static_cast<uint32_t>(height);
  texture.rgba = std::move(rgba);
  return {};
}

std::string decode_stb(const Bytes& bytes, Texture& texture) {
  if (std::string wrong = png::false_claim(bytes); !wrong.empty()) return wrong;
  tinygltf::Image image;
  std::string error, warning;
  if (!tinygltf::LoadImageData(&image, 0, &error, &warning, 0, 0, bytes.data(),
                               static_cast<int>(bytes.size()), nullptr))
    return "it is not an image that can be decoded";
  if (image.component != 4 || image.width < 1 || image.height < 1) return "it has no texels";
  if (image.width > kLargestSide || image.height > kLargestSide) return "it is too large";
  const size_t count = size_t{4} * static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (image.image.size() != count * (image.bits == 8 ? 1 : 2)) return "it is not whole";
  texture.width = static_cast<uint32_t>(image.width), texture.height = static_cast<uint32_t>(image.height);
  if (image.bits == 8) {
    texture.rgba = std::move(image.image);
  } else {  // 16 bits: the high byte of each (little-endian) channel
    texture.rgba.resize(count);
    for (size_t i = 0; i < count; ++i) texture.rgba[i] = image.image[2 * i + 1];
  }
  return {};
}

}  // namespace

std::string decode_image(const GltfFile& gltf, size_t index, Texture& texture) {
  try {
    const Bytes bytes = encoded(gltf, gltf.model.images[index]);
    if (bytes.empty()) return "it is empty";
    if (begins(bytes, "\xABKTX 20")) return "KTX2 images are not read";
    if (begins(bytes, "DDS ")) return "DDS images are not read";
    if (begins(bytes, "ftypavif", 4)) return "AVIF images are not read";
    return is_webp(bytes) ? decode_webp(bytes, texture) : decode_stb(bytes, texture);
  } catch (const Error& error) {
    return error.problems().front().what;
  }
}

}  // namespace gnomon
