// Separable filters: one strip of the image, 64 pixels along the filter's direction and 8 across, with what the filter reaches
// at both ends. Included by the filters after they are told the direction (ALONG_Y_AXIS).
//
// What the pixels show is read from the G-buffer along x only, and kept in `surfaces` for the filter along y.
#include "screen/strip_filter.glsl"

layout(local_size_x = 8, local_size_y = 4) in;  // x: line of the strip; y: part of the line

const int LINES = 8, PARTS = 4;
const int SPAN = LENGTH + 2 * MAX_HALF + 2;   // places of a line at most; one spare at each end

#ifdef ALONG_Y_AXIS
const ivec2 ALONG = ivec2(0, 1);
#else
const ivec2 ALONG = ivec2(1, 0);
#endif

int line() { return int(gl_LocalInvocationID.x); }
int part() { return int(gl_LocalInvocationID.y); }

struct Strip {
  ivec2 origin;    // first pixel
  int layer;
  Light light;     // of the layer
  LightView view;  // its widest
  uint needed;     // cells whose result is needed, a bit each; none beyond the list's end
  int reach;       // pixels, of the widest filter in the frame
  int places;      // of a line; they run from `reach` + 1 before the strip to as many behind it
};

Strip strip_of_workgroup() {
  uint index = tile_index(gl_WorkGroupID, gl_NumWorkGroups);
  ivec2 cells = cells_of(image_size());
  Strip strip;
#ifdef ALONG_Y_AXIS
  bool listed = index < control[ALONG_Y + 3];
  Tile tile = unpack_tile(listed ? strips_y[index] : 0u);
  ivec2 at = tile.origin / TILE, strips = strips_along_y(cells);
  uint needed = needed_y[(tile.layer * strips.y + at.y) * strips.x + at.x];
#else
  bool listed = index < control[ALONG_X + 3];
  Tile tile = unpack_tile(listed ? strips_x[index] : 0u);
  ivec2 at = tile.origin / TILE, strips = strips_along_x(cells);
  uint needed = needed_x[(tile.layer * strips.y + at.y) * strips.x + at.x];
#endif
  strip.origin = at * (ALONG * LENGTH + ALONG.yx * CELL);
  strip.layer = tile.layer;
  strip.light = lights[light_of(tile.layer)];
  strip.view = widest_view(light_of(tile.layer));
  strip.needed = listed ? needed : 0u;
  strip.reach = int(control[REACH]);
  strip.places = listed ? LENGTH + 2 * strip.reach + 2 : 0;
  return strip;
}

ivec2 pixel_of(Strip strip, int place) { return strip.origin + ALONG * (place - strip.reach - 1) + ALONG.yx * line(); }
bool is_needed(Strip strip, int cell) { return (strip.needed >> cell & 1u) != 0u; }

// Do needed cells read any of the places from `first` up to but not including `end`? Cell c reads from 8 c on, up to the reach
// and one more behind it.
bool any_needed(Strip strip, int first, int end) {
  int least = max(first - 2 * strip.reach - 2, 0) / CELL, last = min((end - 1) / CELL, STRIP - 1);
  return (strip.needed & (2u << last) - 1u) >> min(least, STRIP) != 0u;
}

// Can the filter of this direction change anything in the strip's cell?
bool changes_along(Strip strip, int cell) {
  ivec2 at = strip.origin / CELL + ALONG * cell;
#ifdef ALONG_Y_AXIS
  return true;  // of those that are needed
#else
  ivec2 sides = ALONG * cells_around();
  return changes(at - sides, at + sides, strip.layer);
#endif
}

ivec3 clamped(ivec2 pixel, int layer) { return ivec3(clamp(pixel, ivec2(0), image_size() - 1), layer); }

float source_at(ivec2 pixel, int layer) {
#ifdef ALONG_Y_AXIS
  return imageLoad(rows, clamped(pixel, layer)).x;
#else
  return imageLoad(visibility, clamped(pixel, layer)).x;
#endif
}

void store(ivec2 pixel, int layer, float v) {
  if (any(greaterThanEqual(pixel, image_size()))) return;
#ifdef ALONG_Y_AXIS
  imageStore(visibility, ivec3(pixel, layer), vec4(v));
#else
  imageStore(rows, ivec3(pixel, layer), vec4(v));
#endif
}

// In `surfaces` instead of the normal: no pair of signed normalised numbers has these bits.
const uint RECEIVES_NOT = 0x80008000u;

// What `pixel` shows; beyond the image nothing that receives. Along x, `keep` says that along y it will be asked for again.
Receiving surface_at(Strip strip, int place, bool keep) {
  ivec2 pixel = pixel_of(strip, place);
  ivec3 at = clamped(pixel, strip.layer);
  bool inside = at.xy == pixel;
#ifdef ALONG_Y_AXIS
  uvec2 packed = imageLoad(surfaces, at).xy;
  float device_depth = uintBitsToFloat(packed.x);
  Receiving r = Receiving(relative_position(at.xy, device_depth), octahedral_decode(unpackSnorm2x16(packed.y)),
                          image_depth(device_depth), packed.y != RECEIVES_NOT);
#else
  float device_depth = depth_at(at.xy).x;
  vec2 encoded = geometric_at(at.xy).xy;  // of two signed normalised 16-bit numbers: nothing is lost
  Receiving r = make_receiving(at.xy, device_depth, encoded, strip.light, strip.view);
  if (keep && inside)
    imageStore(surfaces, at, uvec4(floatBitsToUint(device_depth), r.receives ? packSnorm2x16(encoded) : RECEIVES_NOT, 0u, 0u));
#endif
  r.receives = r.receives && inside;
  return r;
}

// Is a place of a needed cell?
bool is_own(Strip strip, int place) {
  int offset = place - strip.reach - 1;
  return offset >= 0 && offset < LENGTH && is_needed(strip, offset / CELL);
}
