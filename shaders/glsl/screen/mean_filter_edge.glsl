// Where the mean filter's window ends. After screen/strip_filter_line.glsl.
// Between neighbouring pixels: each may see the other's surface edge-on, so either plane will do.
bool edge_between(Receiving a, Receiving b) {
  if (!a.receives || !b.receives) return true;
  float tolerance = params.depth_tolerance;
  return !same_surface(a.position, a.normal, b.position, a.depth, tolerance) &&
         !same_surface(b.position, b.normal, a.position, b.depth, tolerance);
}
