// Temporal coherence, second part: mean distance of the blockers around pixels that are new (section 5.2.3).
#include "area/area_temporal_query.glsl"
#include "lib/vogel_disc.glsl"

layout(local_size_x = 64) in;

// Over those of the texels around the receiver that are in front of its plane.
float mean_blocker(ivec2 at, Query query) {
  float sum = 0.0, found = 0.0, rotation = 6.2831853 * interleaved_gradient_noise(at);
  for (int i = 0; i < params.blockers; ++i) {
    vec2 offset = params.blocker_radius * vogel_point(i, params.blockers, rotation);
    ivec2 texel = map_texel(query.position + offset);
    float map = caster_depth(texel);
    bool blocks = query_depth(query, vec2(texel) + 0.5) > map;
    sum += blocks ? decode_depth(query.view, map, LINEAR_MAP) : 0.0;
    found += float(blocks);
  }
  return found > 0.0 ? sum / found : BLOCKER_NONE;
}

void main() {
  ivec2 at;
  bool listed = fresh_pixel(list_slot(), imageSize(visibility).x, at);
  AreaReceiver receiver;
  make_area_receiver(at, receiver);
  float blocker = mean_blocker(at, sample_query(receiver, light_sample(push.first), STILL_LAYER));
  ivec3 place = ivec3(at, push.light);
  vec4 packed = imageLoad(shadow_buffer, place);
  if (listed) imageStore(shadow_buffer, place, vec4(packed.xyz, blocker));
}
