// A point of an area light as a light of its own, and the receiver as its map sees it. Pure functions.
//
// All samples share the light's axes and the widths of their windows: a sample's frame is the light's, moved by `offset`,
// and its window is centred on the tangents `window`, so that every sample's map holds the same receivers.
#ifndef GNOMON_LIGHT_SAMPLE
#define GNOMON_LIGHT_SAMPLE

#include "receiver_plane.glsl"

struct LightSample {
  vec3 offset;   // in the view's frame, world units
  vec2 window;   // tangents; 0 for orthographic views
  float weight;  // of its visibility
  int layer;     // of its map
};

// Clip space of a point `q` of the sample's frame: Vulkan's, perspective depth (3.6) or, for orthographic views, (3.8).
vec4 sample_clip(LightView view, LightSample s, vec3 q) {
  float z = -q.z;
  float near = view.range.x, far = view.range.y;
  if (is_orthographic(view)) return vec4(q.x / view.range.z, -q.y / view.range.w, encode_linear(view, z), 1.0);
  vec2 lateral = (q.xy - s.window * z) / view.range.zw;
  return vec4(lateral.x, -lateral.y, far / (far - near) * (z - near), z);
}

// `q`, `n`: the receiver and its unit geometric normal in the view's frame; `size`: texels a side.
Receiver sample_receiver(LightView view, LightSample s, vec3 q, vec3 n, float size) {
  Receiver r = make_receiver(view, q - s.offset, n, size);
  vec2 moved = s.window / view.range.zw;
  r.texel -= 0.5 * size * vec2(moved.x, -moved.y);
  return r;
}

// Cosine of the angle between a receiver's normal and the way to the sample.
float facing_sample(LightView view, LightSample s, vec3 q, vec3 n) {
  return is_orthographic(view) ? n.z : dot(n, normalize(s.offset - q));
}

// A surface is in shadow of what it faces away from.
bool faces_sample(LightView view, LightSample s, vec3 q, vec3 n) {
  return is_orthographic(view) ? n.z > 0.0 : dot(n, s.offset - q) > 0.0;
}

#endif
