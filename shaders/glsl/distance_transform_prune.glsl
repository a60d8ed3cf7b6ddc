// Columns that hold the nearest site of some pixel of a word's rows; the others need not be looked at there. An invocation has 32
// columns of a word, whose bits it makes.
//
// On row y the squared distance to site (s, r) is x^2 - 2 x s + s^2 + (y - r)^2: nearest are the vertices of the lower convex
// hull of the points (s, s^2 + (y - r)^2). How far a site's point lies above the chord between two others is linear in y, so that a
// site that is hidden on the word's first row and on its last is hidden on all rows between. Of a column's sites only three can be
// nearest: one in the word, for which the column is kept, or the nearest one above or below it. Those above and those below make
// a hull each; columns with sites in the word lend one of these.
#include "lib/distance_transform.glsl"

layout(local_size_x = 32) in;

const int MOST_RISE = 1 << 26;   // pixels^2: times CHUNK it fits 32 bits

struct Hull {
  uint kept;          // columns of the chunk, a bit each
  ivec2 top, second;  // last two vertices: column of the chunk, row
};

int word, layer, chunk_begin;

uvec2 word_at(int column) {
  return imageLoad(words, ivec3(min(chunk_begin + column, imageSize(words).x - 1), word, layer)).xy;
}

ivec2 site_of(int column, uvec2 sites, bool above) {
  int inside = word * WORD + (above ? findLSB(sites.x) : findMSB(sites.x));
  int row = sites.x != 0u ? inside : above ? carry_above(sites.y) : carry_below(sites.y);
  return ivec2(column, row);
}

int lift_of(ivec2 site, int y) { return square(site.x) + square(site.y - y); }

// Is `b`'s point on row y not below the chord between those of `a` and `c`?
bool hidden(ivec2 a, ivec2 b, ivec2 c, int y) {
  int lift = lift_of(b, y), before = lift - lift_of(a, y), after = lift_of(c, y) - lift;
  return max(abs(before), abs(after)) < MOST_RISE && before * (c.x - b.x) >= after * (b.x - a.x);
}

void add(inout Hull hull, ivec2 site, bool above) {
  if (!is_row(site.y)) return;
  int first = word * WORD, last = first + WORD - 1;
  while (bitCount(hull.kept) >= 2 && hidden(hull.second, hull.top, site, first) && hidden(hull.second, hull.top, site, last)) {
    hull.kept &= ~(1u << hull.top.x);
    hull.top = hull.second;
    int column = findMSB(hull.kept & ~(1u << hull.top.x));
    hull.second = site_of(column, word_at(max(column, 0)), above);
  }
  hull.kept |= 1u << site.x;
  hull.second = hull.top;
  hull.top = site;
}

void main() {
  int chunk = int(gl_GlobalInvocationID.x);
  word = int(gl_WorkGroupID.y);
  layer = int(gl_WorkGroupID.z);
  chunk_begin = chunk * CHUNK;
  int width = imageSize(words).x;
  if (chunk_begin >= width) return;
  Hull above = Hull(0u, ivec2(0), ivec2(0)), below = above;
  uint inside = 0u;
  for (int column = 0; column < min(CHUNK, width - chunk_begin); ++column) {
    uvec2 sites = word_at(column);
    if (sites.x != 0u) inside |= 1u << column;
    add(above, site_of(column, sites, true), true);
    add(below, site_of(column, sites, false), false);
  }
  imageStore(kept, ivec3(chunk, word, layer), uvec4(inside | above.kept | below.kept));
}
