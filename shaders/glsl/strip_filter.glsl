// What the separable filters of a visibility image share: the strips of the image that need filtering, and the shared-memory
// line buffers of one strip. The filters run along x, then along y, in place: whatever lies further from any change of
// visibility than the filter reaches is not touched.
//
// Edges: a filter's window ends where the surface does, so that objects do not blur into each other (Macedo 2018, ch. 4.2.3),
// and where the receiver turns away from the light.
//
// The width is that of (4.4) and (4.5): (4.4) has no unit; here `width` is in pixels at view depth `reference_depth`, and goes
// with 1 / depth.
#include "frame.glsl"
#include "lib/octahedral.glsl"
#include "lib/same_surface.glsl"
#include "lib/tiles.glsl"

layout(push_constant) uniform Push { float reference_depth; } push;  // world units

const int CELL = 8;             // side of the squares whose content is classified, pixels
const int STRIP = 8;            // cells along a strip; it is one cell wide
const int LENGTH = STRIP * CELL;
const int MAX_HALF = 31;        // pixels that a filter reaches to each side at most

const uint CELL_UMBRA = 0u, CELL_LIT = 1u, CELL_MIXED = 2u;

// Words of `control`: the arguments of the strips along x and along y, and the reach of the widest filter in this frame.
const int ALONG_X = 0, ALONG_Y = 4, REACH = 8;

// Pixels to each side, whole and in part.
float half_width(float view_depth) {
  float width = params.width * push.reference_depth / view_depth;
  return clamp(0.5 * (width - 1.0), 0.0, float(MAX_HALF));
}

ivec2 image_size() { return imageSize(visibility).xy; }
ivec2 cells_of(ivec2 size) { return (size + CELL - 1) / CELL; }
ivec2 strips_along_x(ivec2 cells) { return ivec2((cells.x + STRIP - 1) / STRIP, cells.y); }
ivec2 strips_along_y(ivec2 cells) { return ivec2(cells.x, (cells.y + STRIP - 1) / STRIP); }

struct Receiving {
  vec3 position, normal;
  float depth;    // along the view axis
  bool receives;  // geometry in the image that faces the light
};

Receiving receiving_at(ivec2 pixel, int light) {
  float device_depth = depth_at(clamp(pixel, ivec2(0), image_size() - 1)).x;
  Receiving r;
  r.position = relative_position(pixel, device_depth);
  r.normal = octahedral_decode(geometric_at(clamp(pixel, ivec2(0), image_size() - 1)).xy);
  r.depth = view_depth(device_depth);
  bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, image_size()));
  r.receives = inside && !is_background(device_depth) && faces_light(lights[light], r.position, r.normal);
  return r;
}

// Between neighbouring pixels: each may see the other's surface edge-on, so either plane will do.
bool edge_between(Receiving a, Receiving b) {
  if (!a.receives || !b.receives) return true;
  float tolerance = params.depth_tolerance;
  return !same_surface(a.position, a.normal, b.position, a.depth, tolerance) &&
         !same_surface(b.position, b.normal, a.position, b.depth, tolerance);
}
