// Full-screen passes over the pixels that show geometry: the depth test leaves the background out.
#pragma once

#include "engine/render/environment.h"
#include "engine/render/raster.h"
#include "engine/render/render_settings.h"

namespace gnomon {

// For a triangle at the far plane (shaders/glsl/frame/pixel_rays.glsl) against the camera's depth, which
// stays as it is.
inline RasterState behind_all(const Environment& e) {
  RasterState state;
  state.layout = VertexLayout::none;
  state.depth = e.shape("depth").format;
  state.depth_test = true;
  state.depth_compare = e.settings().reversed_z ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_GREATER;
  return state;
}

}  // namespace gnomon
