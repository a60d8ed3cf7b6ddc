// The workgroups of an indirect dispatch, from the number of elements counted in a list's last argument.
#include "lib/tiles.glsl"

layout(local_size_x = 1) in;

void main() {
  uvec3 groups = tile_workgroups((ARGUMENTS[3] + uint(PER_GROUP) - 1u) / uint(PER_GROUP));
  for (int i = 0; i < 3; ++i) ARGUMENTS[i] = groups[i];
}
