// Of a light that throws no shadow on what the camera sees: no blocker, no penumbra.
#include "lib/soft_shadow.glsl"

layout(push_constant) uniform Push { uint light; } push;
layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(blocker).xy))) return;
  imageStore(blocker, ivec3(at, push.light), vec4(NO_BLOCKER));
  imageStore(width, ivec3(at, push.light), vec4(0.0));
}
