// What the pyramid tells of a receiver. After map/back_projection.glsl, map/horizon.glsl, map/plain_window.glsl and map/search_region.glsl.

// Lit: nothing in the region is nearer than the receiver's plane, which hides nothing of the light itself. Dark: all of the region
// is, and its kernel lies inside of it. Revectorization asks the texels around the region, too.
int plainly(Query query, Light light, Horizon horizon, Region region) {
  if (crosses_light(horizon)) return MIXED;
#if SILHOUETTE == SILHOUETTE_REVECTORIZED
  region.low -= 1;
  region.high += 1;
  if (plain_window(query, region.low, region.high) == PLAINLY_LIT) return PLAINLY_LIT;
#endif
  if (!region.blocks && SILHOUETTE == SILHOUETTE_TEXEL) return PLAINLY_LIT;
  vec2 plane = min(plane_range(query, region.low, region.high), vec2(receiver_own_depth(query, back_projection(query, light))));
  return pyramid_range(region.low, region.high, query.layer).y < plane.x ? PLAINLY_DARK : MIXED;
}
