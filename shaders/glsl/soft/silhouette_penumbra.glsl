// EDTSSM (Macedo 2018, algorithm 4): the penumbra beside the hard shadow's silhouette, which is as wide as the light and what hides it
// ask for (5.2), by the distance to the silhouette (5.3).
//
// Readings. The silhouette lies on the cracks between pixels of different visibility, not on the pixels. Around the nearest silhouette
// pixel they are taken for a line where they lie along one, which tells its place more exactly than any of them. Both it and the
// receiver are measured in the light's frame, the silhouette slid along the ray through the light's centre to the receiver's depth,
// and the penumbra is that of the receiver's own depth and the blocker at the silhouette: exact beside a straight edge for any tilt of the
// receiver, with beta = 1.
#include "frame/receiving.glsl"
#include "lib/distance_transform.glsl"
#include "lib/light_shape.glsl"
#include "lib/same_surface.glsl"
#include "lib/soft_shadow.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const int AROUND = 2;           // pixels about the nearest silhouette pixel, whose cracks count
const float STRAIGHT = 0.12;    // mean squared distance of cracks to a line, pixels^2, up to which they are one

const float FAR = 0.75;  // of the penumbra beside the nearest silhouette pixel: further away no crack around it makes any, half of which it is

struct Cracks {
  int count;
  vec2 sum;        // of their middles, pixels from the nearest silhouette pixel's corner
  vec3 products;   // of their coordinates: xx, xy, yy
  float nearest;   // squared distance in pixels of that which is nearest to the receiver
  vec2 nearest_at;
  float blocker, blockers;  // sum of depths, number
};

void add_crack(inout Cracks cracks, vec2 middle, vec2 receiver, float blocker_a, float blocker_b) {
  ++cracks.count;
  cracks.sum += middle;
  cracks.products += vec3(middle.x * middle.x, middle.x * middle.y, middle.y * middle.y);
  vec2 way = middle - receiver;
  if (dot(way, way) < cracks.nearest) {
    cracks.nearest = dot(way, way);
    cracks.nearest_at = middle;
  }
  float b = blocker_a != NO_BLOCKER ? blocker_a : blocker_b;
  if (b != NO_BLOCKER) {
    cracks.blocker += b;
    cracks.blockers += 1.0;
  }
}

// Is what the pixel shows part of the receiver's surface?
bool related(Receiving p, ivec2 pixel) {
  float device_depth = depth_at(pixel).x;
  return !is_background(device_depth) &&
         same_surface(p.position, p.normal, relative_position(pixel, device_depth), p.depth, params.depth_tolerance, params.bend);
}

Cracks cracks_around(ivec2 site, ivec2 pixel, Receiving p, int layer) {
  Cracks cracks = Cracks(0, vec2(0.0), vec3(0.0), 1e30, vec2(0.0), 0.0, 0.0);
  ivec2 last = textureSize(source, 0).xy - 1;
  vec2 receiver = vec2(pixel - site) + 0.5;
  for (int y = -AROUND; y <= AROUND; ++y)
    for (int x = -AROUND; x <= AROUND; ++x) {
      ivec2 at = clamp(site + ivec2(x, y), ivec2(0), last), right = min(at + ivec2(1, 0), last), below = min(at + ivec2(0, 1), last);
      bool lit = source_at(at, layer).x >= 0.5, lit_right = source_at(right, layer).x >= 0.5, lit_below = source_at(below, layer).x >= 0.5;
      if (lit == lit_right && lit == lit_below) continue;
      if (!related(p, at)) continue;
      float own = blocker_at(at, layer).x;
      vec2 corner = vec2(at - site);
      if (lit != lit_right && related(p, right)) {
        float other = blocker_at(right, layer).x;
        add_crack(cracks, corner + vec2(1.0, 0.5), receiver, lit ? other : own, lit ? own : other);
      }
      if (lit != lit_below && related(p, below)) {
        float other = blocker_at(below, layer).x;
        add_crack(cracks, corner + vec2(0.5, 1.0), receiver, lit ? other : own, lit ? own : other);
      }
    }
  return cracks;
}

// Where the receiver's plane is seen at a place in the image, slid to the receiver's depth from the light.
vec2 slid(Receiving p, LightView view, float z_p, vec2 place) {
  vec3 s = light_space(view, vec4(plane_position(p.position, p.normal, place), 1.0));
  return is_orthographic(view) ? s.xy : slide_site(s.xy, max(-s.z, 1e-6 * z_p), z_p);
}

// Larger side of the light: world units; of a directional one that of (G5).
float light_size(Light light) {
  return is_directional(light) ? directional_size(light.size.w) : 2.0 * max(light.size.x, light.size.y);
}

float penumbra_here(LightView view, float size, float z_p, float z_b) {
  z_b = min(z_b, z_p);
  return is_orthographic(view) ? directional_penumbra_width(size, z_p, z_b) : penumbra_width(size, z_p, z_b);
}

float soft(ivec2 pixel, ivec2 site, Receiving p, bool lit, int layer) {
  Light light = lights[light_of(layer)];
  uvec2 range = views_of(light_of(layer));
  LightView view = views[view_of(light, range.x, range.y, p.position)];
  vec3 q = light_space(view, vec4(p.position, 1.0));
  float z_p = -q.z, size = light_size(light), of_site = blocker_at(site, layer).x;
  if (of_site != NO_BLOCKER) {
    vec2 there = slid(p, view, z_p, vec2(site) + 0.5), beside = slid(p, view, z_p, vec2(site) + 1.5);
    if (distance(q.xy, there) > FAR * penumbra_here(view, size, z_p, of_site) + float(AROUND + 1) * distance(there, beside))
      return lit ? 1.0 : 0.0;
  }
  Cracks cracks = cracks_around(site, pixel, p, layer);
  if (cracks.count == 0 || cracks.blockers == 0.0) return lit ? 1.0 : 0.0;
  float penumbra = penumbra_here(view, size, z_p, cracks.blocker / cracks.blockers);
  float n = float(cracks.count);
  vec2 mean = cracks.sum / n;
  vec3 spread = cracks.products / n - vec3(mean.x * mean.x, mean.x * mean.y, mean.y * mean.y);
  float half_trace = 0.5 * (spread.x + spread.z), root = length(vec2(0.5 * (spread.x - spread.z), spread.y));
  float way;
  if (cracks.count > 2 && half_trace - root <= STRAIGHT) {
    vec2 along = spread.x >= spread.z ? vec2(0.5 * (spread.x - spread.z) + root, spread.y) : vec2(spread.y, 0.5 * (spread.z - spread.x) + root);
    along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
    // The part of the line that is nearest to the receiver in the image: there its slid place counts.
    vec2 receiver = vec2(pixel - site) + 0.5, foot = mean + along * clamp(dot(receiver - mean, along), -3.0, 3.0);
    vec2 a = slid(p, view, z_p, vec2(site) + foot - along), b = slid(p, view, z_p, vec2(site) + foot + along), line = b - a;
    way = abs(line.x * (q.y - a.y) - line.y * (q.x - a.x)) / max(length(line), 1e-30);
  } else {
    way = distance(q.xy, slid(p, view, z_p, vec2(site) + cracks.nearest_at));
  }
  return half_plane_visibility(way, penumbra, lit);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at.xy, imageSize(visibility).xy))) return;
  float v = source_at(at.xy, at.z).x;
  ivec2 site;
  if (unpack_site(nearest_at(at.xy, at.z).x, site)) {
    Receiving p = receiving_at(at.xy, at.z);
    if (p.receives) v = soft(at.xy, site, p, v >= 0.5, at.z);
  }
  imageStore(visibility, at, vec4(v));
}
