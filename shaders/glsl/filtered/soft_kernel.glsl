// The kernel through which a pixel's receiver sees the light. After map/light_kernel.glsl.

struct SoftKernel {
  float penumbra;    // world units; 0: nothing hides any of the light
  vec2 half_width;   // texels
  Horizon horizon;
  bool round_light;
  float most_lit;    // what of the light is above the horizon
};

SoftKernel soft_kernel(Query query, ivec2 pixel, Light light) {
  vec2 half_size = half_size_of(light), most = vec2(map_size());  // beyond which the map's border is repeated anyway
  SoftKernel kernel;
  kernel.penumbra = width_at(pixel, int(push.light)).x;
  vec2 half_width = half_kernel(query.view, half_size, size_of(light), kernel.penumbra, query.plane.z);
  kernel.half_width = clamp(half_width, vec2(0.5 * params.narrowest), most);
  kernel.horizon = horizon_at(pixel, query.view, half_size);
  kernel.round_light = is_round(light);
  kernel.most_lit = share_above(kernel.horizon, kernel.round_light);
  return kernel;
}
