// Bindings, `params` and source_at() come from what the pass declares.
layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(visibility).xy;
  if (any(greaterThanEqual(at.xy, size))) return;
  float sum = 0.0;
  for (int y = -params.radius; y <= params.radius; ++y)
    for (int x = -params.radius; x <= params.radius; ++x)
      sum += source_at(clamp(at.xy + ivec2(x, y), ivec2(0), size - 1), at.z).x;
  float side = float(2 * params.radius + 1);
  imageStore(visibility, at, vec4(sum / (side * side)));
}
