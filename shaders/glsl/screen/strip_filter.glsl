// What the separable filters of a visibility image share: the strips of the image that need filtering, and the shared-memory
// line buffers of one strip. The filters run along x, then along y, in place: whatever lies further from any change of
// visibility than the filter reaches is not touched.
//
// Edges: a filter's window ends where the surface does, so that objects do not blur into each other (Macedo 2018, ch. 4.2.3),
// and where the receiver turns away from the light.
//
// The width is that of (4.4) and (4.5): (4.4) has no unit; here `width` is in pixels at view depth `reference_depth`, and goes
// with 1 / depth (image_depth()). With an image `width` it is what the penumbra covers at the pixel's depth.
#include "frame/receiving.glsl"
#include "lib/same_surface.glsl"
#include "lib/soft_shadow.glsl"
#include "lib/tiles.glsl"

layout(push_constant) uniform Push { float reference_depth; } push;  // world units

// A strip is STRIP cells long and one wide. The content of a cell, CELL pixels a side, is classified.
const int LENGTH = STRIP * CELL;  // pixels
const int MAX_HALF = 31;        // pixels that a filter reaches to each side at most

// What a cell holds, as bits; none: it is as plain as its neighbours are.
const uint HOLDS_LIGHT = 1u, HOLDS_SHADOW = 2u, HOLDS_BOTH = 3u;
uint content_of(float visibility) {
  if (KEEP_ALL == 1) return HOLDS_BOTH;
  return (visibility > 0.0 ? HOLDS_LIGHT : 0u) | (visibility < 1.0 ? HOLDS_SHADOW : 0u);
}

// Words of `control`: the arguments of the strips along x and along y, and the reach of the widest filter in this frame.
const int ALONG_X = 0, ALONG_Y = 4, REACH = 8;

// Pixels to each side, whole and in part.
#ifdef HAS_WIDTH
float half_width(ivec2 pixel, int layer, float view_depth) {
  float half_tangent = 0.5 * frame.viewport.y * length(frame.ray_dy.xyz);
  float pixels = screen_width(width_at(pixel, layer).x, frame.viewport.y, half_tangent, view_depth);
  return clamp(0.5 * (pixels - 1.0), 0.0, float(params.largest));
}
#else
float half_width(float view_depth) {
  float width = params.width * push.reference_depth / view_depth;
  return clamp(0.5 * (width - 1.0), 0.0, float(MAX_HALF));
}
#endif

ivec2 image_size() { return imageSize(visibility).xy; }
ivec2 cells_of(ivec2 size) { return (size + CELL - 1) / CELL; }
ivec2 strips_along_x(ivec2 cells) { return ivec2((cells.x + STRIP - 1) / STRIP, cells.y); }
ivec2 strips_along_y(ivec2 cells) { return ivec2(cells.x, (cells.y + STRIP - 1) / STRIP); }

// Cells that the widest filter of the frame, and one pixel more, touches to each side of a cell.
int cells_around() { return int(control[REACH]) / CELL + 1; }

// Do the cells from `first` to `last` (inclusive, cut off at the image) hold light and shadow both?
bool changes(ivec2 first, ivec2 last, int light) {
  ivec2 cells = cells_of(image_size());
  first = max(first, ivec2(0));
  last = min(last, cells - 1);
  uint seen = 0u;
  int y = first.y;
  do {
    int x = first.x;
    do {
      seen |= cell_states[(light * cells.y + y) * cells.x + x];
    } while (++x <= last.x);
  } while (++y <= last.y);
  return seen == HOLDS_BOTH;
}
