// A step of jump flooding: every pixel takes the nearest of the sites that it and eight pixels `step` away know (Rong and Tan
// 2006).
#include "lib/distance_transform.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Push { int step; } push;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(nearest).xy;
  if (any(greaterThanEqual(at.xy, size))) return;
  uint best = NO_SITE;
  int least = 0x7FFFFFFF;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      ivec2 from = at.xy + ivec2(i, j) * push.step;
      if (any(lessThan(from, ivec2(0))) || any(greaterThanEqual(from, size))) continue;
      uint known = imageLoad(FROM, ivec3(from, at.z)).x;
      ivec2 site;
      if (!unpack_site(known, site)) continue;
      int squared = squared_distance(site, at.xy);
      if (squared >= least) continue;
      least = squared;
      best = known;
    }
  imageStore(TO, at, uvec4(best));
}
