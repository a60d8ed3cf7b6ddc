// EDTSM: penumbra of constant world-space width about the hard shadow's silhouette (Macedo 2018, ch. 4.2.2, eq. 4.3; Macedo and
// Apolinario 2017, eq. 1). One workgroup a tile that has silhouette pixels in reach; elsewhere the hard shadow stands.
//
// Readings. The nearest silhouette pixel is the nearest in the image; its distance is then measured in the world. Where the
// receiver is seen at an angle the silhouette's nearest point in the world is another one, so the silhouette is followed there
// along its image-space tangent, which the nearest pixel gives: it stands at right angles to the way there. Pixels beside the
// silhouette lie half a pixel and more away from it, which is added.
#include "frame/receiving.glsl"
#include "lib/distance_transform.glsl"
#include "lib/same_surface.glsl"
#include "lib/tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(push_constant) uniform Push { float world_width; } push;  // P, world units

const float STRAIGHT = 1.5;        // pixels that a silhouette may deviate from a line and still count as straight,
const float STRAIGHT_PART = 0.1;   // and share of the way along it that is added
const float BASELINE = 4.0;        // pixels between two silhouette pixels that tell its direction better than the way there
const float OWN_SIDE = 2.0;        // pixels from the silhouette where the nearest site is one of the receiver's own side
const float OUTERMOST = 0.2;       // pixels that the outermost of some pixels beside an oblique silhouette lack, in the mean
const float OBLIQUE = 0.15;        // |x| + |y| - 1 from which a direction is oblique: ten degrees
const float BESIDE_SITE = 0.25;    // pixels between a silhouette pixel's centre and the silhouette: the mean over both sides

bool related(Receiving p, vec3 q) {
  // p.depth is the same; but lavapipe 22.3 crashes on this shader unless it reads view_from_relative.
  float depth = -(frame.view_from_relative * vec4(p.position, 1.0)).z;
  return same_surface(p.position, p.normal, q, depth, params.depth_tolerance, params.bend);
}

// How far the nearest silhouette pixel's centre lies from the silhouette, in pixels along the unit direction `way`. The 3x3 test
// finds centres up to |x| + |y| away. Beside a horizontal or vertical silhouette all pixels of a row are equally far, half a
// pixel less in the mean; beside others the nearest is one of the outermost of a row that does not run along.
float beside(vec2 way) {
  float most = abs(way.x) + abs(way.y);
  return most - mix(0.5, OUTERMOST, clamp((most - 1.0) / OBLIQUE, 0.0, 1.0));
}

// Distance of `p` to the line through `a` and `b`; to `a` where they are one.
float line_distance(vec3 p, vec3 a, vec3 b) {
  vec3 along = b - a;
  return distance(p, a + along * dot(p - a, along) / max(dot(along, along), 1e-30));
}

// World distance of `p` to the silhouette, of which `site` is the pixel nearest to `pixel`; negative: not on this surface.
float world_distance(ivec2 pixel, Receiving p, ivec2 site, int light) {
  Receiving s = receiving_at(site, light);
  if (!related(p, s.position)) return -1.0;
  if (site == pixel) return BESIDE_SITE * length(plane_position(p.position, p.normal, vec2(pixel) + vec2(1.0, 0.5)) -
                                                 plane_position(p.position, p.normal, vec2(pixel) + vec2(0.0, 0.5)));
  vec2 way = normalize(vec2(site - pixel)), to_edge = 0.5 + beside(way) * way;
  vec3 edge = plane_position(s.position, s.normal, vec2(site) + to_edge);
  float nearest_distance = distance(p.position, edge);
  vec3 tangent = plane_position(s.position, s.normal, vec2(site) + to_edge + vec2(-way.y, way.x)) - edge;
  vec3 foot = edge + tangent * dot(p.position - edge, tangent) / max(dot(tangent, tangent), 1e-30);
  // Is the silhouette still there? Then the line through both places is it, more exactly than the tangent.
  vec2 place = image_place(foot);
  ivec2 last = textureSize(nearest, 0).xy - 1, other;
  ivec2 this_side = clamp(ivec2(floor(place - OWN_SIDE * way)), ivec2(0), last);
  if (!unpack_site(nearest_at(this_side, light).x, other)) return nearest_distance;
  Receiving o = receiving_at(other, light);
  if (!related(p, o.position)) return nearest_distance;
  vec3 other_edge = plane_position(o.position, o.normal, vec2(other) + to_edge);
  float baseline = distance(vec2(other), vec2(site));
  bool straight = distance(vec2(other) + to_edge, place) <= STRAIGHT + STRAIGHT_PART * baseline;
  if (!straight) return min(nearest_distance, distance(p.position, other_edge));
  return baseline < BASELINE ? distance(p.position, foot) : line_distance(p.position, edge, other_edge);
}

// (4.3). `part`: D / P.
float penumbra(bool lit, float part) { return lit ? min(0.5 + part, 1.0) : max(0.5 - part, 0.0); }

void main() {
  uint index = tile_index(gl_WorkGroupID, gl_NumWorkGroups);
  if (index >= arguments[3]) return;
  Tile tile = unpack_tile(tiles[index]);
  ivec2 pixel = tile.origin + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(visibility).xy))) return;
  ivec2 site;
  if (!unpack_site(nearest_at(pixel, tile.layer).x, site)) return;
  Receiving p = receiving_at(pixel, tile.layer);
  if (!p.receives) return;
  bool lit = imageLoad(visibility, ivec3(pixel, tile.layer)).x >= 0.5;
#if METRIC == METRIC_WORLD
#ifdef HAS_WIDTH
  // The site carries the width, as silhouette pixels do in EDTSSM (Macedo 2018, algorithm 4); where it has none, as beside the
  // edge of what blocks, the pixel's own stands.
  float of_site = width_at(site, tile.layer).x, own = width_at(pixel, tile.layer).x;
  float width_here = max(of_site > 0.0 ? of_site : own, 1e-30);  // a width that no pixel sees is a step
#else
  float width_here = push.world_width;
#endif
  float d = world_distance(pixel, p, site, tile.layer) / width_here;
#else
  // As in fig. 6 of the 2017 paper.
  vec2 way = vec2(site - pixel);
  bool here = related(p, receiving_at(site, tile.layer).position);
  float d = !here ? -1.0 : (length(way) + (site == pixel ? BESIDE_SITE : beside(normalize(way)))) / params.pixels;
#endif
  if (d >= 0.0) imageStore(visibility, ivec3(pixel, tile.layer), vec4(penumbra(lit, d)));
}
