// Unit vectors in two numbers (Cigolle et al. 2014, A Survey of Efficient Representations for Independent Unit Vectors).
#ifndef GNOMON_OCTAHEDRAL
#define GNOMON_OCTAHEDRAL

vec2 octahedral_fold(vec2 p) { return (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0); }

// Unit vector -> [-1, 1]^2.
vec2 octahedral_encode(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  return n.z < 0.0 ? octahedral_fold(p) : p;
}

// [-1, 1]^2 -> unit vector.
vec3 octahedral_decode(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = octahedral_fold(p);
  return normalize(n);
}

#endif
