// What raster passes name: targets to render to, and draws of the scene.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/vulkan/pipeline.h"

namespace gnomon {

struct Draw {  // one instance of one mesh
  uint32_t first_index, index_count;
  int32_t vertex_offset;
  uint32_t instance, material;
  bool double_sided, alpha_masked, mirrored, watertight;
  bool plain;  // of one base colour: no texture, no vertex colours
};

struct ColorTarget {
  std::string port;
  std::optional<std::array<float, 4>> clear;     // absent: keep what is there
  std::optional<uint32_t> layer = std::nullopt;  // this one alone, whatever Targets::layer says
};
struct DepthTarget {
  std::string port;
  std::optional<float> clear;
  uint32_t clear_stencil = 0;
};
struct Targets {
  std::vector<ColorTarget> colors;
  std::optional<DepthTarget> depth;
  // `layers` layers of arrays from this one on (of an image with fewer, the last), gl_Layer counted from it;
  // absent: all.
  std::optional<uint32_t> layer;
  uint32_t layers = 1;
};

enum class Cull {
  material,  // glTF: back faces, unless the material is double-sided
  none,
  front  // front faces, unless the material is double-sided
};
struct ScenePipelines {
  Pipeline opaque, masked;  // masked: alpha-masked materials
  Pipeline plain = {};      // opaque, of one base colour; none: drawn as the others
};

// Which layers each instance of the scene is drawn into.
struct LayerRun {
  uint32_t first, count;
};
using InstanceLayers = std::vector<std::vector<LayerRun>>;  // [instance]

}  // namespace gnomon
