// Shapes of images and buffers.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <string>

namespace gnomon {

struct Extent {
  uint32_t width = 1, height = 1;  // pixels or texels
  bool operator==(const Extent&) const = default;
};

struct ImageShape {
  Extent extent;
  uint32_t layers = 1;
  uint32_t mips = 1;
  VkFormat format = VK_FORMAT_UNDEFINED;
  bool operator==(const ImageShape&) const = default;
};

struct BufferShape {
  uint64_t count = 1;          // elements
  uint32_t stride = 4;         // bytes an element, std430
  std::string glsl = "uint";   // GLSL type of an element: a basic type, or a struct
  std::string glsl_file = {};  // that defines the struct, relative to shaders/glsl
  bool operator==(const BufferShape&) const = default;
};

}  // namespace gnomon
