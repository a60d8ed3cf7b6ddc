// Images on the CPU and their files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

// Planar float image: pixel (x, y) of channel c is data[(c * height + y) * width + x]; row 0 at the top.
struct Image {
  uint32_t width = 0, height = 0;
  std::vector<std::string> channels;  // names as in EXR: "Y", "R", "light1.Y", ...
  std::vector<float> data;
  std::string comment;  // kept in EXR files

  Image() = default;
  Image(uint32_t w, uint32_t h, std::vector<std::string> names);
  std::span<float> plane(size_t channel);
  std::span<const float> plane(size_t channel) const;
  std::span<const float> plane(const std::string& name) const;  // Error when absent
  bool has(const std::string& name) const;
  float& at(uint32_t x, uint32_t y, size_t channel = 0) { return data[(channel * height + y) * width + x]; }
  float at(uint32_t x, uint32_t y, size_t channel = 0) const {
    return data[(channel * height + y) * width + x];
  }
};

// One value a pixel of an image from `file`: the channel `name`; or of a layer of that name its Y, or the
// luminance of its R, G and B; or with "luminance" that of the image's own R, G and B. Error, with the
// channels there are.
std::vector<float> scalar_values(const Image& image, const std::string& name, const std::string& file);

// All writers write beside the target and rename, so that nothing half-written remains; Error on failure.
Image read_exr(const std::filesystem::path& file);  // channels of several parts: "part.channel"
void write_exr(const std::filesystem::path& file, const Image& image);  // 32-bit float, ZIP
Image read_image(const std::filesystem::path& file);  // EXR or PNG by extension; PNG as 0..1, not linearised
void write_png_srgb(const std::filesystem::path& file,
                    const Image& linear_rgb);  // 3 channels, clamped, sRGB encoded
void write_png_gray(const std::filesystem::path& file,
                    const Image& values);  // 1 channel, [0,1], no transfer curve
// Writes text atomically; Error names the file (full disk, no such folder, ...).
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace gnomon
