// RBSM, first half: the shadow test of every pixel (3.2), and the list of pixels that lie on the silhouette (3.3).
// Only these are walked: the work follows the pixels that need it.
//
// An invocation has 2x2 pixels, which gathers read at once, and queries the map for those of them that it decides about.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const ivec2 OFFSET[4] = ivec2[4](ivec2(0, 1), ivec2(1, 1), ivec2(1, 0), ivec2(0, 0));  // in the order of textureGather

float tested(ivec2 at, float device_depth, vec3 normal, Light light, LightView view, int width) {
  Query query;
  int state = make_query(at, device_depth, normal, light, view, query);
  ivec2 texel = ivec2(floor(query.position));
  bvec4 neighbours;
  bool lit = is_lit_cross(query, texel, neighbours);
  bool same = KEEP_ALL == 0 && (lit ? all(neighbours) : !any(neighbours));
  bool inside = state == PIXEL_INSIDE;
  // The conservative form works on the lit side only.
  bool wanted = MODE == MODE_CONSERVATIVE ? lit : true;
  if (inside && !same && wanted) list_pixel(at, width);
  return inside ? float(lit) : unmapped_visibility(state);
}

void main() {
  ivec2 first = 2 * ivec2(gl_GlobalInvocationID.xy), size = imageSize(visibility).xy;
  if (any(greaterThanEqual(first, size))) return;
  vec2 corner = vec2(first + 1) / vec2(size);
  vec4 depths = textureGather(depth, corner);
  vec4 normals_x = textureGather(geometric, corner, 0), normals_y = textureGather(geometric, corner, 1);
  vec4 v = vec4(1.0);
  Light light = lights[push.light];
  LightView view = views[push.view];
  uint undecided = 0u;
  for (int i = 0; i < 4; ++i) {
    ivec2 at = first + OFFSET[i];
    vec3 n = octahedral_decode(vec2(normals_x[i], normals_y[i]));
    bool there = !is_background(depths[i]) && all(lessThan(at, size));
    bool faced = faces_light(light, relative_position(at, depths[i]), n);
    if (there && !faced) v[i] = unmapped_visibility(PIXEL_AWAY);
    if (there && faced) undecided |= 1u << i;
  }
  if (undecided != 0u) {
    do {
      int i = findLSB(undecided);
      v[i] = tested(first + OFFSET[i], depths[i], octahedral_decode(vec2(normals_x[i], normals_y[i])), light, view, size.x);
      undecided &= undecided - 1u;
    } while (undecided != 0u);
  }
  for (int i = 0; i < 4; ++i) {
    ivec2 at = first + OFFSET[i];
    if (all(lessThan(at, size))) imageStore(visibility, ivec3(at, push.light), vec4(v[i]));
  }
}
