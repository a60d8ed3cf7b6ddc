// Vertices of the scene for the views of a shadow map: one instance a view, which is also the layer.
#include "frame/frame.glsl"
#include "frame/layer.glsl"

layout(push_constant) uniform Push { uint instance; } push;
layout(location = 0) in vec3 in_position;
invariant gl_Position;  // the same depth with and without what masked materials need
#ifdef MASKED
layout(location = 2) in vec2 in_uv;
layout(location = 3) in vec4 in_color;
layout(location = 0) out vec2 out_uv;
layout(location = 3) out float out_alpha;
layout(location = 2) out flat uint out_instance;
#endif
#ifdef LINEAR_DEPTH
layout(location = 1) out float out_depth;
#endif
#ifdef PEEL
layout(location = 4) out flat int out_layer;
#endif

void main() {
#if VIEWS_COUNT == 1
  LightView view = views[0];
#else
  LightView view = views[gl_InstanceIndex];
#endif
  vec4 relative = instances[push.instance].relative_from_object * vec4(in_position, 1.0);
  gl_Position = view.clip_from_relative * vec4(relative.xyz, 1.0);
  choose_layer(gl_InstanceIndex);
#ifdef PEEL
  out_layer = gl_InstanceIndex;
#endif
#ifdef MASKED
  out_uv = in_uv;
  out_alpha = in_color.a;
  out_instance = push.instance;
#endif
#ifdef LINEAR_DEPTH
  out_depth = encode_linear(view, -light_space(view, vec4(relative.xyz, 1.0)).z);
#endif
}
