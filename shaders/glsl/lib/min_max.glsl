// Depths of a block of texels, and what they tell of a receiver over a window of the map: plainly lit, plainly in umbra, or
// neither.
#ifndef GNOMON_MIN_MAX
#define GNOMON_MIN_MAX

// x: least, y: greatest depth.
vec2 min_max_of(vec4 depths) {
  return vec2(min(min(depths.x, depths.y), min(depths.z, depths.w)), max(max(depths.x, depths.y), max(depths.z, depths.w)));
}
vec2 min_max_join(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

const int PLAINLY_LIT = 0, PLAINLY_DARK = 1, MIXED = 2;
// `receiver`: least and greatest depth of the receiver over the window; `map`: of a part of the map that holds the window.
int min_max_compare(vec2 receiver, vec2 map) {
  return receiver.y <= map.x ? PLAINLY_LIT : receiver.x > map.y ? PLAINLY_DARK : MIXED;
}

// Min-max pyramids: level i holds blocks of 2^(i+1) texels a side, and the last blocks of a level reach to the map's border.
// The block of a level of `blocks` blocks that a texel of the map is in.
ivec2 pyramid_block(ivec2 texel, int level, ivec2 blocks) { return min(texel >> (level + 1), blocks - 1); }
// The finest level of which a window of so many texels, wherever it stands, touches at most 2 blocks on an axis.
int pyramid_level(int texels) { return texels <= 3 ? 0 : findMSB(texels - 2); }

#endif
