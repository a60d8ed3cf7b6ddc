// What hides some of the light from each listed pixel, and the width of its penumbra (Macedo 2018, eq. 5.2). Whoever includes it
// defines before that
//   float find_blocker(ivec2 at, Query query, Light light)   linear depth, or NO_BLOCKER
void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), imageSize(blocker).x, at)) return;
  Query query;
  make_query(at, query);
  Light light = lights[push.light];
  float z_b = find_blocker(at, kernel_query(query), light);
  float penumbra = z_b == NO_BLOCKER ? 0.0 : penumbra_of_blocker(query.view, size_of(light), query.plane.z, z_b);
  imageStore(blocker, ivec3(at, push.light), vec4(z_b));
  imageStore(width, ivec3(at, push.light), vec4(penumbra));
}
