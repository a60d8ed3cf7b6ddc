// Columns that hold the nearest site of some pixel of a word's rows; the others need not be looked at there. An invocation has SPAN
// columns of a word, whose bits it makes.
//
// On row y the squared distance to site (s, r) is x^2 - 2 x s + s^2 + (y - r)^2: nearest are the vertices of the lower convex
// hull of the points (s, s^2 + (y - r)^2). How far a site's point lies above the chord between two others is linear in y, so that a
// site that is hidden on the word's first row and on its last is hidden on all rows between. Of a column's sites only three can be
// nearest: one in the word, for which the column is kept, or the nearest one above or below it. Those above and those below make
// a hull each; columns with sites in the word lend one of these. A vertex that is more than three words of columns behind, or
// whose neighbours are more than MOST_APART columns apart, stays.
#include "distance/distance_transform_column.glsl"

layout(local_size_x = 8) in;

const int SPAN = 1024;           // columns
const int MOST_APART = 256;      // columns of three vertices of which one may hide another
const int MOST_RISE = 1 << 23;   // pixels^2: times MOST_APART it fits 32 bits
const ivec2 NO_VERTEX = ivec2(-1);

struct Hull {
  uvec4 kept;          // columns of the window, a bit each: three words and the current one
  ivec2 top, second;  // last two vertices: column of the span, row; or NO_VERTEX
};

int word, layer;
int begin;   // first column of the span, in the image
int window;  // first column of the window, in the span; negative at first

Column column_at(int column) { return load_column(begin + column, word, layer); }

ivec2 site_of(int column, Column sites, bool above) {
  int inside = word * WORD + (above ? findLSB(sites.bits) : findMSB(sites.bits));
  int row = sites.bits != 0u ? inside : above ? carry_above(sites.carry) : carry_below(sites.carry);
  return ivec2(column, row);
}

int lift_of(ivec2 site, int y) { return square(site.x) + square(site.y - y); }

// Is `b`'s point on row y not below the chord between those of `a` and `c`?
bool hidden(ivec2 a, ivec2 b, ivec2 c, int y) {
  int lift = lift_of(b, y), before = lift - lift_of(a, y), after = lift_of(c, y) - lift;
  return max(abs(before), abs(after)) < MOST_RISE && before * (c.x - b.x) >= after * (b.x - a.x);
}

// The window's columns before `column`, a bit each. None of the window for what is behind it.
uvec4 bits_before(int column) {
  ivec4 count = clamp(column - window - CHUNK * ivec4(0, 1, 2, 3), 0, CHUNK);
  return mix((uvec4(1u) << uvec4(count)) - 1u, uvec4(0xFFFFFFFFu), equal(count, ivec4(CHUNK)));
}

// The vertex before `column`, or NO_VERTEX when there is none in the window.
ivec2 vertex_before(Hull hull, int column, bool above) {
  uvec4 bits = hull.kept & bits_before(column);
  ivec4 last = mix(findMSB(bits) + CHUNK * ivec4(0, 1, 2, 3), ivec4(-1), equal(bits, uvec4(0u)));
  int found = max(max(last.x, last.y), max(last.z, last.w)) + window;
  return found < window ? NO_VERTEX : site_of(found, column_at(max(found, 0)), above);
}

void pop(inout Hull hull, bool above) {
  hull.kept &= bits_before(hull.top.x);
  hull.top = hull.second;
  hull.second = vertex_before(hull, hull.top.x, above);
}

// Does `site` hide the hull's last vertex, on all rows of the word?
bool hides_top(Hull hull, ivec2 site) {
  int first = word * WORD, last = first + WORD - 1;
  return hull.second != NO_VERTEX && hull.top.x >= window && site.x - hull.second.x <= MOST_APART &&
         hidden(hull.second, hull.top, site, first) && hidden(hull.second, hull.top, site, last);
}

void add(inout Hull hull, ivec2 site, bool above) {
  bool is_site = is_row(site.y), hides = is_site && hides_top(hull, site);
  do {
    if (hides) pop(hull, above);
    hides = hides && hides_top(hull, site);
  } while (hides);
  if (!is_site) return;
  hull.kept.w |= 1u << (site.x & (CHUNK - 1));
  hull.second = hull.top;
  hull.top = site;
}

void main() {
  ivec2 size = imageSize(words).xy;
  int spans = (size.x + SPAN - 1) / SPAN, index = int(gl_GlobalInvocationID.x);
  word = index / spans;
  layer = int(gl_WorkGroupID.y);
  if (word >= size.y) return;
  begin = index % spans * SPAN;
  Hull above = Hull(uvec4(0u), NO_VERTEX, NO_VERTEX), below = above;
  uvec4 inside = uvec4(0u);
  int columns = min(SPAN, size.x - begin), chunks = (columns + CHUNK - 1) / CHUNK;
  for (int chunk = 0; chunk < chunks + 3; ++chunk) {
    window = (chunk - 3) * CHUNK;
    int column = chunk * CHUNK, end = min(column + CHUNK, columns);
    if (column < end) {
      do {
        Column sites = column_at(column);
        if (sites.bits != 0u) inside.w |= 1u << (column & (CHUNK - 1));
        add(above, site_of(column, sites, true), true);
        add(below, site_of(column, sites, false), false);
      } while (++column < end);
    }
    uvec4 kept_columns = inside | above.kept | below.kept;
    if (chunk >= 3) imageStore(kept, ivec3(begin / CHUNK + chunk - 3, word, layer), uvec4(kept_columns.x));
    above.kept = uvec4(above.kept.yzw, 0u);
    below.kept = uvec4(below.kept.yzw, 0u);
    inside = uvec4(inside.yzw, 0u);
  }
}
