// Compute and graphics pipelines of a pass.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"
#include "engine/vulkan/shader.h"

namespace gnomon {

enum class VertexLayout {
  none,       // vertices come from gl_VertexIndex alone
  positions,  // location 0: vec3 position
  normals,    // and location 1: octahedral normal
  masked,     // location 0, and location 2: uv, 3: colour: what an alpha mask needs
  full,       // location 0 to 3: all of these
  references  // location 0: uvec2, from a buffer of the pass' own
};
enum class Blend { none, add, multiply };

struct StencilOps {  // wrap-around counting is done by front and back operations
  bool enable = false;
  VkCompareOp compare = VK_COMPARE_OP_ALWAYS;
  uint32_t reference = 0;
  VkStencilOp front_pass = VK_STENCIL_OP_KEEP, front_depth_fail = VK_STENCIL_OP_KEEP;
  VkStencilOp back_pass = VK_STENCIL_OP_KEEP, back_depth_fail = VK_STENCIL_OP_KEEP;
};

struct RasterState {
  std::string vertex, fragment;  // shader files; no fragment shader when empty
  Defines defines;               // of both
  VertexLayout layout = VertexLayout::positions;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  std::vector<VkFormat> colors;          // attachments
  VkFormat depth = VK_FORMAT_UNDEFINED;  // depth (and stencil) attachment
  bool depth_test = false, depth_write = false, depth_clamp = false;
  VkCompareOp depth_compare = VK_COMPARE_OP_LESS_OR_EQUAL;
  Blend blend = Blend::none;
  bool color_write = true;
  StencilOps stencil;
};

// Viewport, scissor and cull mode are dynamic. Shared: copies are cheap.
struct Pipeline {
  std::shared_ptr<void> owner;
  VkPipeline handle = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
};

// A shader that is given this define knows how many invocations a subgroup has, which is then required of the
// device.
constexpr const char* kSubgroupSize = "SUBGROUP_SIZE";

Pipeline make_compute_pipeline(const std::shared_ptr<Device>& device, VkPipelineLayout layout,
                               const ShaderSource& source, VkPipelineCache cache);
Pipeline make_raster_pipeline(const std::shared_ptr<Device>& device, VkPipelineLayout layout,
                              const RasterState& state, const std::string& preamble, VkPipelineCache cache);

}  // namespace gnomon
