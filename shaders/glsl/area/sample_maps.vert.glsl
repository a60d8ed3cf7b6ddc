// Vertices of the scene for the maps of an area light's samples: one instance a sample, which is also the layer. SPLIT_MOVING: one
// sample, whose casters that may move go to a second layer.
#include "area/light_samples.glsl"

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
  LightSample s = light_sample(push.first + gl_InstanceIndex);
  vec4 relative = instances[push.instance].relative_from_object * vec4(in_position, 1.0);
  vec3 q = light_space(view, vec4(relative.xyz, 1.0)) - s.offset;
  gl_Position = sample_clip(view, s, q);
#ifdef LINEAR_DEPTH
  out_depth = encode_linear(view, -q.z);
#endif
#ifdef SPLIT_MOVING
  gl_Layer = int(instances[push.instance].info.w);
#else
  gl_Layer = gl_InstanceIndex;
#endif
#ifdef MASKED
  out_uv = in_uv;
  out_alpha = in_color.a;
  out_instance = push.instance;
#endif
}
