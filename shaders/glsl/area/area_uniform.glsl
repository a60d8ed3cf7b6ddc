// Adds the visibility of some of an area light's samples, each tested against its own shadow map.
#include "area/area_query.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// PART_FIRST, PART_LAST: bits of push.part.x: begins, ends a light's samples.

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(visibility).xy))) return;
  AreaReceiver receiver;
  int state = make_area_receiver(at, receiver);
  if (state == PIXEL_OTHERS) return;
  if (state == PIXEL_INSIDE && push.count == 0u) state = PIXEL_OUTSIDE;  // nothing casts a shadow there
  ivec3 place = ivec3(at, push.light);
  float sum = (push.part.x & PART_FIRST) != 0u ? 0.0 : imageLoad(visibility, place).x;
  uint count = state == PIXEL_INSIDE ? push.count : 0u;
  for (uint i = 0u; i < count; ++i) {
    LightSample s = light_sample(push.first + i);
    Query query = sample_query(receiver, s, int(push.layer + i));
    bool lit = is_lit(query, ivec2(floor(query.position)));
    sum += lit && faces_sample(receiver.view, s, receiver.q, receiver.n) ? s.weight : 0.0;
  }
  float v = sum;
  if ((push.part.x & PART_LAST) != 0u) v = min(sum / uintBitsToFloat(push.part.y), 1.0);
  imageStore(visibility, place, vec4(state == PIXEL_INSIDE ? v : unmapped_visibility(state)));
}
