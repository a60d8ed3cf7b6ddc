// A point of an area light as a light of its own, and the receiver as its map sees it. Pure functions.
//
// All samples share the light's axes and the widths of their windows: a sample's frame is the light's, moved by `offset`,
// and its window is centred on the tangents `window`, so that every sample's map holds the same receivers.
#ifndef GNOMON_LIGHT_SAMPLE
#define GNOMON_LIGHT_SAMPLE

#include "receiver_plane.glsl"

struct LightSample {
  vec3 offset;   // in the face's frame, world units
  vec2 window;   // tangents; 0 for orthographic faces
  float weight;  // of its visibility
  int layer;     // of its map
};

// Clip space of a point `q` of the sample's frame: Vulkan's, perspective depth (3.6) or, for orthographic faces, (3.8).
vec4 sample_clip(LightFace face, LightSample s, vec3 q) {
  float z = -q.z;
  float near = face.range.x, far = face.range.y;
  if (is_orthographic(face)) return vec4(q.x / face.range.z, -q.y / face.range.w, encode_linear(face, z), 1.0);
  vec2 lateral = (q.xy - s.window * z) / face.range.zw;
  return vec4(lateral.x, -lateral.y, far / (far - near) * (z - near), z);
}

// `q`, `n`: the receiver and its unit geometric normal in the face's frame; `size`: texels a side.
Receiver sample_receiver(LightFace face, LightSample s, vec3 q, vec3 n, float size) {
  Receiver r = make_receiver(face, q - s.offset, n, size);
  vec2 moved = s.window / face.range.zw;
  r.texel -= 0.5 * size * vec2(moved.x, -moved.y);
  return r;
}

// A surface is in shadow of what it faces away from.
bool faces_sample(LightFace face, LightSample s, vec3 q, vec3 n) {
  return is_orthographic(face) ? n.z > 0.0 : dot(n, s.offset - q) > 0.0;
}

#endif
