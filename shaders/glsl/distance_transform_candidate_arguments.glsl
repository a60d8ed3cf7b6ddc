// The workgroups of the search of the candidates: of the one that the frame's radius asks for, and none of the other.
#include "distance_transform_radius.glsl"
#include "lib/tiles.glsl"

layout(local_size_x = 1) in;

void main() {
  uvec3 groups = tile_workgroups(candidate_arguments[3]);
  bool is_far = frame_radius() > MOST_NEAR_RADIUS;
  for (int i = 0; i < 3; ++i) {
    candidate_arguments[i] = is_far ? 0u : groups[i];
    candidate_arguments[4 + i] = is_far ? groups[i] : 0u;
  }
}
