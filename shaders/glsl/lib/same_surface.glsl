// Do two points lie on one surface? Pure function.
#ifndef GNOMON_SAME_SURFACE
#define GNOMON_SAME_SURFACE

// `p`, `n`: a point and its unit geometric normal; `q`: the other point. `tolerance`: distance of `q` from the tangent plane of
// `p` that still counts, as a share of the view depth of `p`, because a pixel covers a part of the world in proportion to it.
// Related to the receiver's plane rather than to a difference of window depths (Macedo 2018, ch. 4.2.2, uses 2.5e-3 of that), so
// that neither slope nor distance changes what is told apart.
bool same_surface(vec3 p, vec3 n, vec3 q, float view_depth_p, float tolerance) {
  return abs(dot(n, q - p)) <= tolerance * view_depth_p;
}

// The same for points that may lie apart: `bend` is the sine of the angle above the tangent plane that a curved surface may turn
// between the two.
bool same_surface(vec3 p, vec3 n, vec3 q, float view_depth_p, float tolerance, float bend) {
  return abs(dot(n, q - p)) <= tolerance * view_depth_p + bend * distance(p, q);
}

#endif
