// Taps that stand for several texels each: after what soft/back_projection.glsl declares. Where a tap is a patch and the one beside it
// is none, the texel at which the surface ends is looked for between them.

// Texels beyond the one that a tap reads that hide something, too, towards a tap that hides nothing.
int texels_beyond(ivec2 tap, ivec2 way) {
  ivec2 texel = texel_of(grid, tap);
  int inside = 0, outside = grid.stride;
  do {
    int middle = (inside + outside) / 2;
    if (magnification_of(texel + middle * way) > 0.0) inside = middle;
    else outside = middle;
  } while (outside - inside > 1);
  return inside;
}

void hide_coarse_tap(ivec2 tap) {
  if (bit_lit(tap)) return;
  bvec4 ends = bit_discontinuity(tap, false);
  vec2 texel = vec2(texel_of(grid, tap)), low = low_of(grid, tap), high = low + float(grid.stride);
  if (ends.x) low.x = texel.x - float(texels_beyond(tap, ivec2(-1, 0)));
  if (ends.y) high.x = texel.x + 1.0 + float(texels_beyond(tap, ivec2(1, 0)));
  if (ends.z) low.y = texel.y - float(texels_beyond(tap, ivec2(0, -1)));
  if (ends.w) high.y = texel.y + 1.0 + float(texels_beyond(tap, ivec2(0, 1)));
  float left = ends.x ? 0.0 : magnification_at(tap - ivec2(1, 0)), above = ends.z ? 0.0 : magnification_at(tap - ivec2(0, 1));
  hide_texels(low, high, magnification_at(tap), left, above);
}

void hide_coarse() {
  read_window(grid.taps);
  int y = 0;
  do {
    int x = 0;
    do {
      if (!is_inner(grid, ivec2(x, y))) hide_coarse_tap(ivec2(x, y));
    } while (++x < grid.taps.x);
  } while (++y < grid.taps.y && !is_full(mask));
}
