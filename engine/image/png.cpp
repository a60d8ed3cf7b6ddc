// Decodes and encodes PNG through stb.
#include "engine/image/png.h"

#include <fmt/format.h>

#include <memory>

#include "engine/base/error.h"
#include "engine/base/input_file.h"
#include "engine/image/png_claims.h"

// Static: a shared library linked beside may carry the same symbols.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

namespace gnomon::png {

Image read(const std::filesystem::path& file) {
  const std::string text = read_input_file(file);
  const std::span bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  if (const std::string wrong = false_claim(bytes); !wrong.empty())
    fail("cannot read as PNG: " + wrong, file.string());
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_us, decltype(&stbi_image_free)> pixels(
      stbi_load_16_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, 0),
      &stbi_image_free);
  if (!pixels) fail(fmt::format("cannot read as PNG: {}", stbi_failure_reason()), file.string());
  static const std::vector<std::string> names[] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  Image image(static_cast<uint32_t>(width), static_cast<uint32_t>(height), names[channels - 1]);
  const size_t size = size_t{image.width} * image.height;
  for (size_t c = 0; c < image.channels.size(); ++c)
    // 8-bit values were widened by v * 257, so that the division is exact in both depths.
    for (size_t i = 0; i < size; ++i)
      image.data[c * size + i] = pixels.get()[i * image.channels.size() + c] / 65535.0f;
  return image;
}

std::string encode(std::span<const uint8_t> pixels, uint32_t width, uint32_t height, uint32_t channels,
                   const std::filesystem::path& file) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
  };
  const int ok =
      stbi_write_png_to_func(append, &bytes, static_cast<int>(width), static_cast<int>(height),
                             static_cast<int>(channels), pixels.data(), static_cast<int>(width * channels));
  if (!ok) fail("cannot encode as PNG", file.string());
  return bytes;
}

}  // namespace gnomon::png
