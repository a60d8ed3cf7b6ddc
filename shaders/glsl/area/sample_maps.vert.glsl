// Vertices of the scene for the maps of an area light's samples: one instance a sample, which is also the layer. SPLIT_MOVING: one
// sample, whose casters that may move go to a second layer.
#include "area/light_samples.glsl"
#include "frame/layer.glsl"

layout(push_constant) uniform Push { uint instance, material, view, first; } push;
layout(location = 0) in vec3 in_position;
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

void main() {
  LightView view = area_view(push.view);
#ifdef SPLIT_MOVING
  LightSample s = light_sample(push.first);
#else
  LightSample s = light_sample(push.first + gl_InstanceIndex);
#endif
  vec4 relative = instances[push.instance].relative_from_object * vec4(in_position, 1.0);
  vec3 q = light_space(view, vec4(relative.xyz, 1.0)) - s.offset;
  gl_Position = sample_clip(view, s, q);
#ifdef LINEAR_DEPTH
  out_depth = encode_linear(view, -q.z);
#endif
  choose_layer(gl_InstanceIndex);
#ifdef MASKED
  out_uv = in_uv;
  out_alpha = in_color.a;
  out_instance = push.instance;
#endif
}
