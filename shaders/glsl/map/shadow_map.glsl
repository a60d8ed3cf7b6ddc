// Fragments of a shadow map, where there must be any: alpha masks, linear depth, and peeling for midpoint maps.
#include "frame/frame.glsl"

#ifdef MASKED
layout(set = 2, binding = 0) uniform sampler2D base_color_texture;
layout(location = 0) in vec2 in_uv;
layout(location = 2) in flat uint in_instance;
layout(location = 3) in float in_alpha;
#endif
#ifdef LINEAR_DEPTH
// (3.7) is applied per fragment: depth multiplied by w/f at the vertices and interpolated in screen space is right at the
// vertices only, and bends large triangles.
layout(location = 1) in float in_depth;
#endif
#ifdef PEEL
layout(location = 4) in flat int in_layer;
#endif

void main() {
#ifdef MASKED
  Material material = materials[instances[in_instance].info.y];
  if (material.base_color.a * in_alpha * texture(base_color_texture, in_uv).a < material.alpha.x) discard;
#endif
  float depth = gl_FragCoord.z;
#ifdef LINEAR_DEPTH
  depth = in_depth;
#endif
#ifdef PEEL
  // Only what lies behind the first surface. First and second are the same triangles, so equality is exact.
  if (depth <= first_at(ivec2(gl_FragCoord.xy), in_layer).x) discard;
#endif
#if defined(LINEAR_DEPTH)
  gl_FragDepth = clamp(depth, 0.0, 1.0);
#endif
}
