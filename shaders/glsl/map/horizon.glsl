// After map/light_kernel.glsl.

// Does the receiver's own surface hide some of the light?
bool crosses_light(Horizon horizon) { return abs(horizon.slope.x) + abs(horizon.slope.y) >= horizon.height; }
