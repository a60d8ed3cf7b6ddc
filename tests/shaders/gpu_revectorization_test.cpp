// Revectorization against distances, relative positions and lines worked out by hand, and against a plain
// model of Macedo 2018, eq. 3.1-3.9 and 4.1-4.2.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/shaders/gpu_revectorization_helper.h"

namespace gnomon::test {
namespace {

// Light above, shadow below. One step of length 4: the silhouette is at y = 3 for x in [1, 5], below at y =
// 4, above at y = 2. L shapes on both sides.
const VisibilityMap kStep{{"........", "........", ".....###", ".#######", "########", "########"}};
// A notch of width 4 and depth 1: U shape on the lit side (row 3) and in the shadow below it (row 4).
const VisibilityMap kNotch{{"........", "........", "........", "##....##", "########", "########"}};
// A tooth of width 4 and height 1: I shape on the lit side above it (row 2) and within it (row 3).
const VisibilityMap kTooth{{"........", "........", "........", "..####..", "########", "########"}};
// A single texel in shadow, (2, 2), and a single lit one.
const VisibilityMap kIsland{{".....", ".....", "..#..", ".....", "....."}};
const VisibilityMap kHole{{"#####", "#####", "##.##", "#####", "#####"}};

struct Case {
  const char* name;
  const VisibilityMap* map;
  Point at;
  float distances[4];         // left, right, top, bottom; positive: the other visibility was found
  float r[2], filtered_r[2];  // (3.5), (4.1)
  float conservative, non_conservative, filtered;
};

// Distances run to the border of the last texel passed. Lengths are 4 along the step, notch or tooth and 1
// across.
const std::vector<Case> kCases = {
    // Lit side of the step: d_l = -(x - 1), d_r = 5 - x, d_t = -(y - 2), d_b = 3 - y, so r = ((5 - x) / 4, 3
    // - y).
    {"L lit, last texel, low",
     &kStep,
     {4.5f, 2.75f},
     {-3.5f, 0.5f, -0.75f, 0.25f},
     {.125f, .25f},
     {.125f, .25f},
     0,
     0,
     .375f},
    {"L lit, last texel, high",
     &kStep,
     {4.25f, 2.125f},
     {-3.25f, .75f, -.125f, .875f},
     {.1875f, .875f},
     {.1875f, .875f},
     1,
     1,
     1},
    {"L lit, between the lines",
     &kStep,
     {4.75f, 2.5f},
     {-3.75f, .25f, -.5f, .5f},
     {.0625f, .5f},
     {.0625f, .5f},
     0,
     1,
     .5625f},
    {"L lit, third texel",
     &kStep,
     {3.25f, 2.75f},
     {-2.25f, 1.75f, -.75f, .25f},
     {.4375f, .25f},
     {.4375f, .25f},
     0,
     1,
     .6875f},
    {"L lit, first texel, low",
     &kStep,
     {1.25f, 2.9375f},
     {-.25f, 3.75f, -.9375f, .0625f},
     {.9375f, .0625f},
     {.9375f, .0625f},
     1,
     1,
     1},
    {"L lit, first texel, lowest",
     &kStep,
     {1.75f, 2.9375f},
     {-.75f, 3.25f, -.9375f, .0625f},
     {.8125f, .0625f},
     {.8125f, .0625f},
     0,
     1,
     .875f},
    // Shadowed side: d_l = x - 1 (light found), d_r = -(5 - x), d_t = y - 3, d_b = -(4 - y): r = ((x - 1) /
    // 4, y - 3).
    {"L shadow, first texel, high",
     &kStep,
     {1.5f, 3.25f},
     {.5f, -3.5f, .25f, -.75f},
     {.125f, .25f},
     {.125f, .25f},
     0,
     1,
     .625f},
    {"L shadow, first texel, low",
     &kStep,
     {1.5f, 3.75f},
     {.5f, -3.5f, .75f, -.25f},
     {.125f, .75f},
     {.125f, .75f},
     0,
     0,
     .125f},
    {"L shadow, second texel",
     &kStep,
     {2.75f, 3.0625f},
     {1.75f, -2.25f, .0625f, -.9375f},
     {.4375f, .0625f},
     {.4375f, .0625f},
     0,
     1,
     .5f},
    {"L shadow, last texel",
     &kStep,
     {4.5f, 3.125f},
     {3.5f, -.5f, .125f, -.875f},
     {.875f, .125f},
     {.875f, .125f},
     0,
     0,
     0},
    // Lit notch: both ends found, T = -2. With m = min(x - 2, 6 - x): r_x = 2 m / 4, by (4.1) 4 m / 4; r_y =
    // 4 - y.
    {"U lit, left end",
     &kNotch,
     {2.25f, 3.5f},
     {.25f, 3.75f, -.5f, .5f},
     {.125f, .5f},
     {.25f, .5f},
     0,
     1,
     .75f},
    {"U lit, left end, low",
     &kNotch,
     {2.25f, 3.75f},
     {.25f, 3.75f, -.75f, .25f},
     {.125f, .25f},
     {.25f, .25f},
     0,
     0,
     .5f},
    {"U lit, middle",
     &kNotch,
     {3.75f, 3.75f},
     {1.75f, 2.25f, -.75f, .25f},
     {.875f, .25f},
     {1.75f, .25f},
     1,
     1,
     1},
    {"U lit, right half",
     &kNotch,
     {4.75f, 3.75f},
     {2.75f, 1.25f, -.75f, .25f},
     {.625f, .25f},
     {1.25f, .25f},
     0,
     1,
     1},
    // Below the notch both walks leave the silhouette: T = 0, r_x = 0, as it was.
    {"U shadow", &kNotch, {2.5f, 4.125f}, {-.5f, -3.5f, .125f, -.875f}, {0, .125f}, {0, .125f}, 0, 0, 0},
    // Above the tooth both walks leave the silhouette: T = 0.
    {"I lit", &kTooth, {2.25f, 2.75f}, {-.25f, -3.75f, -.75f, .25f}, {0, .25f}, {0, .25f}, 1, 1, 1},
    // Within the tooth light is found on both ends: T = -2, r_x = -2 m / 4 by (3.5) and 4 m / 4 by (4.1); r_y
    // = y - 3.
    {"I shadow, corner",
     &kTooth,
     {2.25f, 3.125f},
     {.25f, 3.75f, .125f, -.875f},
     {-.125f, .125f},
     {.25f, .125f},
     0,
     1,
     .625f},
    {"I shadow, right half",
     &kTooth,
     {5.25f, 3.25f},
     {3.25f, .75f, .25f, -.75f},
     {-.375f, .25f},
     {.75f, .25f},
     0,
     0,
     0},
    // A lone texel: T = -2 both ways with lengths 1: |r| = 2 m, by (4.1) 4 m.
    {"island, corner",
     &kIsland,
     {2.125f, 2.0625f},
     {.125f, .875f, .0625f, .9375f},
     {-.25f, -.125f},
     {.5f, .25f},
     0,
     1,
     .25f},
    {"island, middle", &kIsland, {2.5f, 2.25f}, {.5f, .5f, .25f, .75f}, {-1, -.5f}, {2, 1}, 0, 0, 0},
    {"hole, corner",
     &kHole,
     {2.125f, 2.0625f},
     {.125f, .875f, .0625f, .9375f},
     {.25f, .125f},
     {.5f, .25f},
     0,
     0,
     .75f},
    {"hole, middle", &kHole, {2.5f, 2.25f}, {.5f, .5f, .25f, .75f}, {1, .5f}, {2, 1}, 1, 1, 1},
};

void expect_equal(const Revectorized& got, const Case& want) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(got.distances[i], want.distances[i], 1e-6f) << "distance " << i;
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(got.r[i], want.r[i], 1e-6f) << "r " << i;
    EXPECT_NEAR(got.filtered_r[i], want.filtered_r[i], 1e-6f) << "r of (4.1) " << i;
  }
  EXPECT_EQ(got.conservative, want.conservative);
  EXPECT_EQ(got.non_conservative, want.non_conservative);
  EXPECT_NEAR(got.filtered, want.filtered, 1e-6f);
}

Case transformed(const Symmetry& s, const Case& c) {
  Revectorized v{};
  std::copy(c.distances, c.distances + 4, v.distances);
  std::copy(c.r, c.r + 2, v.r), std::copy(c.filtered_r, c.filtered_r + 2, v.filtered_r);
  v = s(v);
  Case result = c;
  std::copy(v.distances, v.distances + 4, result.distances);
  std::copy(v.r, v.r + 2, result.r), std::copy(v.filtered_r, v.filtered_r + 2, result.filtered_r);
  return result;
}

// Centres of a grid of `per_texel` x `per_texel` positions a texel over [x0, x1) x [y0, y1) texels.
std::vector<Point> grid(int x0, int x1, int y0, int y1, int per_texel) {
  std::vector<Point> points;
  const float step = 1.0f / float(per_texel);
  for (int j = y0 * per_texel; j < y1 * per_texel; ++j)
    for (int i = x0 * per_texel; i < x1 * per_texel; ++i)
      points.push_back({(float(i) + 0.5f) * step, (float(j) + 0.5f) * step});
  return points;
}

// Height of the revectorized silhouette (y, shadow below) over x; compared outside `margin` of it, where
// float rounding may fall either way.
using Line = std::function<double(double x)>;
int count_wrong(const std::vector<Point>& points, const std::vector<Revectorized>& values,
                float Revectorized::*visibility, const Line& line, double margin = 1e-5) {
  int wrong = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double above = line(points[i].x) - points[i].y;
    if (std::abs(above) < margin) continue;
    wrong += values[i].*visibility != (above > 0 ? 1.0f : 0.0f);
  }
  return wrong;
}

TEST(GpuRevectorization, distances_positions_and_visibility_of_every_shape_in_every_orientation) {
  for (const Symmetry& s : all_symmetries())
    for (const VisibilityMap* map : {&kStep, &kNotch, &kTooth, &kIsland, &kHole}) {
      std::vector<Case> cases;
      std::vector<Point> points;
      for (const Case& c : kCases)
        if (c.map == map) cases.push_back(c), points.push_back(s(*map, c.at));
      const auto values = revectorize_on_device(s(*map), points, 16);
      for (size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(std::string(cases[i].name) + (s.transpose ? ", transposed" : "") +
                     (s.mirror_x ? ", mirrored in x" : "") + (s.mirror_y ? ", mirrored in y" : ""));
        expect_equal(values[i], transformed(s, cases[i]));
      }
    }
}

// Away from the silhouette the shadow test's own answer stands.
TEST(GpuRevectorization, texels_without_discontinuity_keep_the_shadow_test) {
  const auto values = revectorize_on_device(kStep, {{1.5f, 0.5f}, {2.5f, 5.5f}}, 16);
  for (const auto& [value, v] : {std::pair(values[0], 1.0f), std::pair(values[1], 0.0f)}) {
    EXPECT_EQ(value.discontinuous, 0);
    EXPECT_EQ(value.conservative, v);
    EXPECT_EQ(value.non_conservative, v);
    EXPECT_EQ(value.filtered, v);
  }
}

// Over the step the conservative line is (5 - x) / 4 + (3 - y) = 1: from the lower outer corner (1, 3) to the
// upper inner one (5, 2). The non-conservative one has 1/2 on both sides: from (1, 3.5) through the step's
// middle (3, 3) to (5, 2.5).
double conservative_step(double x) { return 3 - (x - 1) / 4; }
double middle_step(double x) { return 3 - (x - 3) / 4; }

TEST(GpuRevectorization, lines_over_a_long_step_join_the_right_corners) {
  const auto points = grid(1, 5, 2, 4, 16);
  for (const Symmetry& s : all_symmetries()) {
    std::vector<Point> moved;
    for (const Point& p : points) moved.push_back(s(kStep, p));
    const auto values = revectorize_on_device(s(kStep), moved, 16);
    EXPECT_EQ(count_wrong(points, values, &Revectorized::conservative, conservative_step), 0);
    EXPECT_EQ(count_wrong(points, values, &Revectorized::non_conservative, middle_step), 0);
    for (size_t i = 0; i < points.size(); ++i) {
      // (4.2): the ramp of slope 1 across the conservative and its mirror line, continuous over the
      // silhouette.
      const double x = points[i].x, y = points[i].y;
      const double expected = y < 3 ? (5 - x) / 4 + 3 - y : 1 - ((x - 1) / 4 + y - 3);
      EXPECT_NEAR(values[i].filtered, std::clamp(expected, 0.0, 1.0), 1e-5) << x << " " << y;
    }
  }
}

// A library that mirrors the sub-texel coordinate (one of the two "1 -" of listing A.3 dropped) must not pass
// the test above: per texel it draws a line of the other slope. A good share of the band is then wrong.
TEST(GpuRevectorization, mirrored_sub_texel_coordinate_is_told_apart) {
  const auto points = grid(1, 5, 2, 4, 16);
  const auto values = revectorize_on_device(kStep, points, 16, true);
  EXPECT_GT(count_wrong(points, values, &Revectorized::conservative, conservative_step),
            int(points.size() / 16));
  EXPECT_GT(count_wrong(points, values, &Revectorized::non_conservative, middle_step),
            int(points.size() / 16));
}

TEST(GpuRevectorization, notch_and_tooth_lines) {
  const auto m = [](double x) { return std::min(x - 2, 6 - x); };
  const auto notch_points = grid(2, 6, 3, 5, 16);
  const auto notch = revectorize_on_device(kNotch, notch_points, 16);
  // m / 2 + 4 - y = 1 (conservative), = 1/2 (non-conservative)
  EXPECT_EQ(
      count_wrong(notch_points, notch, &Revectorized::conservative, [&](double x) { return 3 + m(x) / 2; }),
      0);
  EXPECT_EQ(count_wrong(notch_points, notch, &Revectorized::non_conservative,
                        [&](double x) { return std::min(3.5 + m(x) / 2, 4.0); }),
            0);
  // The tooth's corners are cut by m / 2 + y - 3 = 1/2; the conservative form leaves it alone.
  const auto tooth_points = grid(2, 6, 2, 4, 16);
  const auto tooth = revectorize_on_device(kTooth, tooth_points, 16);
  EXPECT_EQ(count_wrong(tooth_points, tooth, &Revectorized::conservative, [](double) { return 3.0; }), 0);
  EXPECT_EQ(count_wrong(tooth_points, tooth, &Revectorized::non_conservative,
                        [&](double x) { return std::max(3.5 - m(x) / 2, 3.0); }),
            0);
}

// A step of 20 texels and walks of 8: the length is clamped to 8 (A.4), so the line is that of a step of 8
// and beyond 8 texels the plain silhouette stays. No jump: at the limit r = 1, which is the plain silhouette
// too.
TEST(GpuRevectorization, walk_limit_clamps_the_length_without_a_jump) {
  const int limit = 8;
  VisibilityMap map{
      {std::string(24, '.'), std::string(22, '.') + "##", ".." + std::string(22, '#'), std::string(24, '#')}};
  const auto points = grid(2, 22, 1, 3, 16);
  const auto values = revectorize_on_device(map, points, limit);
  const auto conservative = [](double x) { return 2 - std::max(1 - (22 - x) / 8, 0.0); };
  // (22 - x) / 8 + 2 - y = 1/2 on the lit side, (x - 2) / 8 + y - 2 = 1/2 in the shadow
  const auto middle = [](double x) {
    return 2 - std::max(0.5 - (22 - x) / 8, 0.0) + std::max(0.5 - (x - 2) / 8, 0.0);
  };
  EXPECT_EQ(count_wrong(points, values, &Revectorized::conservative, conservative), 0);
  EXPECT_EQ(count_wrong(points, values, &Revectorized::non_conservative, middle), 0);
  for (size_t i = 1; i < points.size(); ++i) {
    if (points[i].y != points[i - 1].y) continue;
    // The filtered ramp has slope 1 / 8 along the step: neighbours 1/16 texel apart differ by at most 1/128.
    EXPECT_LE(std::abs(values[i].filtered - values[i - 1].filtered), 1.0f / 128 + 1e-5f)
        << points[i].x << " " << points[i].y;
  }
}

// At a texel's very border the distance is zero, which has no sign: the result is the limit from inside the
// texel.
TEST(GpuRevectorization, position_on_a_texel_border_is_the_limit_from_inside) {
  for (const Symmetry& s : all_symmetries()) {
    std::vector<Point> border, inside;
    for (float y = 0; y < 5; y += 0.25f)
      for (float x = 0; x < 5; x += 0.25f)
        border.push_back({x, y}), inside.push_back({x + 1e-5f, y + 1.7e-5f});
    for (const VisibilityMap* map : {&kIsland, &kHole}) {
      const auto at = revectorize_on_device(s(*map), border, 16),
                 near = revectorize_on_device(s(*map), inside, 16);
      for (size_t i = 0; i < at.size(); ++i) {
        EXPECT_NEAR(at[i].filtered, near[i].filtered, 2e-4f) << border[i].x << " " << border[i].y;
        const float sum = std::abs(near[i].r[0]) + std::abs(near[i].r[1]);
        SCOPED_TRACE(std::to_string(border[i].x) + " " + std::to_string(border[i].y));
        if (std::abs(sum - 1) > 1e-3f) {
          EXPECT_EQ(at[i].conservative, near[i].conservative);
        }
        if (std::abs(sum - 0.5f) > 1e-3f) {
          EXPECT_EQ(at[i].non_conservative, near[i].non_conservative);
        }
      }
    }
  }
}

// A half-plane whose border falls by 1/k, digitised at texel centres: every step is k long, and the border
// meets the rows' centre lines at most 1/2 texel from where the steps are (offset o). Non-conservative
// revectorization draws the parallel line through the middles of the steps: its error is |o| / k texels of
// area per texel of length. The staircase's is the mean of |u + o / k| over u in [-1/2, 1/2]: 1/4 + (o /
// k)^2.
TEST(GpuRevectorization, digitised_line_is_recovered_through_the_middles_of_its_steps) {
  for (int k = 2; k <= 12; ++k)
    for (const double o : {0.0, 0.125, -0.375}) {
      SCOPED_TRACE("slope 1/" + std::to_string(k) + ", offset " + std::to_string(o));
      const int height = 7, width = height * k;
      const double shift =
          k % 2 ? -0.5 : 0;  // with it the border meets the rows' centre lines between texels at o = 0
      VisibilityMap map;
      for (int y = 0; y < height; ++y) {
        std::string row;
        for (int x = 0; x < width; ++x) row += x + 0.5 > k * (height - (y + 0.5)) + o + shift ? '#' : '.';
        map.rows.push_back(row);
      }
      const auto truth = [&](double x) { return height - (x - o - shift) / k; };
      const auto middles = [&](double x) { return height - (x - shift) / k; };
      auto points = grid(2 * k, 5 * k, 0, height, 16);
      for (Point& p : points) p.y += 0.0037f;  // off the line: no ties
      const auto values = revectorize_on_device(map, points, 16);
      EXPECT_EQ(count_wrong(points, values, &Revectorized::non_conservative, middles), 0);
      const double area_of_one = 1.0 / (16 * 16) / (3 * k);
      const double error =
          count_wrong(points, values, &Revectorized::non_conservative, truth, 0) * area_of_one;
      const double plain = count_wrong(points, values, &Revectorized::lit, truth, 0) * area_of_one;
      EXPECT_NEAR(error, std::abs(o) / k, 1.0 / 64);
      EXPECT_NEAR(plain, 0.25 + (o / k) * (o / k), 1.0 / 64);
      EXPECT_LT(error, 0.8 * plain);
    }
}

VisibilityMap random_map(std::mt19937& random) {
  const double density = std::uniform_real_distribution(0.25, 0.75)(random);
  std::bernoulli_distribution shadow(density), repeat(0.5);
  VisibilityMap map{std::vector<std::string>(8, std::string(8, '.'))};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)  // runs, so that walks are longer than one texel
      map.rows[size_t(y)][size_t(x)] = x > 0 && repeat(random) ? map.rows[size_t(y)][size_t(x - 1)]
                                       : shadow(random)        ? '#'
                                                               : '.';
  return map;
}

std::vector<Point> random_points(std::mt19937& random, int count) {
  // Multiples of 2^-12, off the texels' borders: exact in float and under mirroring.
  std::uniform_int_distribution<int> texel(0, 7), part(1, 4095);
  std::vector<Point> points;
  for (int i = 0; i < count; ++i)
    points.push_back({float(texel(random)) + float(part(random)) / 4096,
                      float(texel(random)) + float(part(random)) / 4096});
  return points;
}

bool near_threshold(const Revectorized& v, float threshold) {
  return std::abs(std::abs(v.r[0]) + std::abs(v.r[1]) - threshold) < 1e-5f;
}

void expect_same(const Revectorized& got, const Revectorized& want) {
  EXPECT_EQ(got.lit, want.lit);
  EXPECT_EQ(got.discontinuous, want.discontinuous);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(got.distances[i], want.distances[i], 1e-5f);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(got.r[i], want.r[i], 1e-5f);
    EXPECT_NEAR(got.filtered_r[i], want.filtered_r[i], 1e-5f);
  }
  if (!near_threshold(want, 1)) {
    EXPECT_EQ(got.conservative, want.conservative);
  }
  if (!near_threshold(want, 0.5f)) {
    EXPECT_EQ(got.non_conservative, want.non_conservative);
  }
  EXPECT_NEAR(got.filtered, want.filtered, 1e-5f);
}

TEST(GpuRevectorization, agrees_with_the_equations_on_random_maps) {
  std::mt19937 random(20180301);
  int shapes[3] = {};
  for (int n = 0; n < 60; ++n) {
    const VisibilityMap map = random_map(random);
    const int limit = std::array{16, 16, 3, 2}[size_t(n % 4)];
    const auto points = random_points(random, 500);
    const auto values = revectorize_on_device(map, points, limit);
    for (size_t i = 0; i < points.size(); ++i) {
      const Revectorized want = revectorize_by_equations(map, points[i], limit);
      ++shapes[want.distances[0] > 0 ? (want.distances[1] > 0 ? 0 : 2) : (want.distances[1] > 0 ? 2 : 1)];
      expect_same(values[i], want);
      if (::testing::Test::HasFailure()) {
        for (const auto& row : map.rows) std::cout << row << "\n";
        FAIL() << "at " << points[i].x << " " << points[i].y << ", limit " << limit;
      }
    }
  }
  for (const int count : shapes) EXPECT_GT(count, 1000) << "a shape is hardly covered";
}

TEST(GpuRevectorization, commutes_with_rotations_and_mirror_images) {
  std::mt19937 random(7);
  for (int n = 0; n < 4; ++n) {
    const VisibilityMap map = random_map(random);
    const auto points = random_points(random, 500);
    const auto original = revectorize_on_device(map, points, 16);
    for (const Symmetry& s : all_symmetries()) {
      std::vector<Point> moved;
      for (const Point& p : points) moved.push_back(s(map, p));
      const auto values = revectorize_on_device(s(map), moved, 16);
      for (size_t i = 0; i < points.size(); ++i) expect_same(values[i], s(original[i]));
    }
  }
}

// (3.9) as one formula against (3.7) and (3.8), and (3.6), over a plane of relative positions: pure
// arithmetic of the model, which the device is compared with.
TEST(RevectorizationModel, is_the_union_of_both_sides) {
  const auto points = grid(1, 5, 2, 4, 8);
  for (const Point& p : points) {
    const Revectorized v = revectorize_by_equations(kStep, p, 16);
    const float sum = std::abs(v.r[0]) + std::abs(v.r[1]), product = v.r[0] * v.r[1];
    if (std::abs(sum - 0.5f) < 1e-6f) continue;
    const bool shadow = v.lit == 0 ? product == 0 || sum > 0.5f : product > 0 && sum < 0.5f;
    EXPECT_EQ(v.non_conservative, shadow ? 0 : 1);
  }
}

}  // namespace
}  // namespace gnomon::test
