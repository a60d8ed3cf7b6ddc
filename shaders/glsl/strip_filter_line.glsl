// Separable filters: one strip of the image, 64 pixels along the filter's direction and 8 across, with what the filter reaches
// at both ends. Included by the filters after they are told the direction (ALONG_Y_AXIS).
#include "strip_filter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;  // x: line of the strip; y: part of the line

const int LINES = 8, PARTS = 8;
const int SPAN = LENGTH + 2 * MAX_HALF + 2;   // places of a line at most; one spare at each end
const int BITS = 32;                          // of a word
const int EDGE_WORDS = SPAN / BITS + 2;       // with one spare at each end

// Bit p of a line, after its first word: there is an edge between its places p - 1 and p.
shared uint edges[LINES * EDGE_WORDS];

#ifdef ALONG_Y_AXIS
const ivec2 ALONG = ivec2(0, 1);
#else
const ivec2 ALONG = ivec2(1, 0);
#endif

int line() { return int(gl_LocalInvocationID.x); }
int part() { return int(gl_LocalInvocationID.y); }

// False for workgroups beyond the list's end. `origin`: the strip's first pixel.
bool strip_at(out ivec2 origin, out int light) {
  uint index = tile_index(gl_WorkGroupID);
#ifdef ALONG_Y_AXIS
  bool listed = index < control[ALONG_Y + 3];
  uint packed = listed ? strips_y[index] : 0u;
#else
  bool listed = index < control[ALONG_X + 3];
  uint packed = listed ? strips_x[index] : 0u;
#endif
  ivec2 strip = unpack_tile(packed).origin / TILE;
  origin = strip * (ALONG * LENGTH + ALONG.yx * CELL);
  light = unpack_tile(packed).layer;
  return listed;
}

// Places run from `reach + 1` before the strip to as many behind it.
ivec2 pixel_of(ivec2 origin, int reach, int place) { return origin + ALONG * (place - reach - 1) + ALONG.yx * line(); }

// Can the filter change anything in the cell that begins at `corner`? Not where all cells in its reach are alike.
bool changes(ivec2 corner, int light) {
  ivec2 cells = cells_of(image_size()), cell = corner / CELL;
  int around = int(control[REACH]) / CELL + 1;
#ifdef ALONG_Y_AXIS
  ivec2 sides = ivec2(around);
#else
  ivec2 sides = ivec2(around, 0);
#endif
  ivec2 first = max(cell - sides, ivec2(0)), last = min(cell + sides, cells - 1);
  uint seen = 0u;  // a bit for each state
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) seen |= 1u << cell_states[(light * cells.y + y) * cells.x + x];
  return seen != 1u << CELL_UMBRA && seen != 1u << CELL_LIT;
}

float source_at(ivec2 pixel, int light) {
  ivec3 at = ivec3(clamp(pixel, ivec2(0), image_size() - 1), light);
#ifdef ALONG_Y_AXIS
  return imageLoad(rows, at).x;
#else
  return imageLoad(visibility, at).x;
#endif
}

void store(ivec2 pixel, int light, float v) {
  if (any(greaterThanEqual(pixel, image_size()))) return;
#ifdef ALONG_Y_AXIS
  imageStore(visibility, ivec3(pixel, light), vec4(v));
#else
  imageStore(rows, ivec3(pixel, light), vec4(v));
#endif
}

void clear_edges() {
  for (int i = int(gl_LocalInvocationIndex); i < LINES * EDGE_WORDS; i += LINES * PARTS) edges[i] = 0u;
}
void set_edge(int place) { atomicOr(edges[line() * EDGE_WORDS + place / BITS + 1], 1u << uint(place % BITS)); }

// The 32 bits of the line that end with that of `place`, which becomes bit 31.
uint edges_up_to(int place) {
  int word = line() * EDGE_WORDS + place / BITS + 1;
  uint shift = uint(place % BITS);
  return edges[word] << (31u - shift) | (edges[word - 1] >> shift) >> 1;
}

// Where the window of a pixel at `place` begins that reaches `limit` places, at most 32, before it: at the last edge there.
int window_begin(int place, int limit) {
  int back = 31 - findMSB(edges_up_to(place));  // 32: no edge
  return place - min(back, limit);
}
// Where the window ends that reaches `limit` places, at most 32, behind it: before the next edge.
int window_end(int place, int limit) {
  uint next = edges_up_to(place + BITS);
  int ahead = next != 0u ? findLSB(next) : BITS;
  return place + min(ahead, limit);
}
