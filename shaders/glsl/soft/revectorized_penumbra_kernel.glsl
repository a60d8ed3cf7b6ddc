// The kernel of a penumbra's width in the map. After map/light_kernel.glsl.

// Half axes, texels.
vec2 half_kernel_at(ivec2 pixel, Query query, Light light) {
  vec2 most = vec2(map_size());  // beyond which the map's border is repeated anyway
  float penumbra = width_at(pixel, int(push.light)).x;
  return min(half_kernel(query.view, half_size_of(light), size_of(light), penumbra, query.plane.z), most);
}
