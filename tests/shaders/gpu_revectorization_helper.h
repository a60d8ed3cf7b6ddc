// Visibility maps as text, revectorized on the device and by a plain model written from the paper's
// equations.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace gnomon::test {

// Visibility of the texels around a receiver: '#' in shadow, '.' lit; the first row is v = 0. Outside, the
// nearest texel counts, as in the shadow map.
struct VisibilityMap {
  std::vector<std::string> rows;
  int width() const { return int(rows.front().size()); }
  int height() const { return int(rows.size()); }
  bool lit(int x, int y) const;
};

struct Point {  // texels
  float x = 0, y = 0;
};

// The same values from the device and from the model.
struct Revectorized {
  float distances[4];   // left, right, top, bottom
  float r[2];           // (3.5)
  float filtered_r[2];  // (4.1)
  float conservative, non_conservative, filtered;
  float lit;            // V_SM
  float discontinuous;  // 1 when any component of (3.3) is
  float padding[3];
};

// `mirror_c`: the sub-texel coordinate is mirrored, as dropping one of listing A.3's two "1 -" does.
std::vector<Revectorized> revectorize_on_device(const VisibilityMap& map, const std::vector<Point>& points,
                                                int max_size, bool mirror_c = false);

Revectorized revectorize_by_equations(const VisibilityMap& map, Point point, int max_size);

// One of the eight symmetries of the square: transpose first, then mirror.
struct Symmetry {
  bool transpose = false, mirror_x = false, mirror_y = false;
  VisibilityMap operator()(const VisibilityMap& map) const;
  Point operator()(const VisibilityMap& original, Point p) const;
  // What an answer for the original becomes: distances and r change places.
  Revectorized operator()(Revectorized value) const;
};
std::array<Symmetry, 8> all_symmetries();

}  // namespace gnomon::test
