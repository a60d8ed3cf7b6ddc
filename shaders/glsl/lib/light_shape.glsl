// The shapes of lights as maps of the square [-1, 1]^2, so that an even set of points on it becomes one on the light. Pure
// functions.
#ifndef GNOMON_LIGHT_SHAPE
#define GNOMON_LIGHT_SHAPE

const float QUARTER_TURN = 0.785398163;  // radians, of the square's diagonal against its side

// From the square to the unit disc; keeps relative areas (Shirley and Chiu 1997).
vec2 disc_of_square(vec2 p) {
  bool along_x = abs(p.x) > abs(p.y);
  float radius = along_x ? p.x : p.y, across = along_x ? p.y : p.x;
  float angle = radius == 0.0 ? 0.0 : QUARTER_TURN * across / radius;
  vec2 way = radius * vec2(cos(angle), sin(angle));
  return along_x ? way : way.yx;
}

// Its inverse.
vec2 square_of_disc(vec2 p) {
  bool along_x = abs(p.x) > abs(p.y);
  float major = along_x ? p.x : p.y, minor = along_x ? p.y : p.x;
  float radius = length(p) * (major < 0.0 ? -1.0 : 1.0);
  float across = major == 0.0 ? 0.0 : radius * atan(minor / major) / QUARTER_TURN;
  return along_x ? vec2(radius, across) : vec2(across, radius);
}

// Point (i, j) of side^2 on the square: one in the middle of every cell, moved so that no two share a row or a column of the
// finer grid of side^2 cells (Kensler 2013, the canonical arrangement): a straight edge meets them one by one.
vec2 lattice_point(int i, int j, int side) {
  float cells = float(side);
  vec2 place = (vec2(i, j) + (vec2(j, i) + 0.5) / cells) / cells;
  return 2.0 * place - 1.0;
}

#endif
