// What pre-filtered shadow maps compute per pixel, against double precision,
// sums and brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <random>

#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::test {
namespace {

// `body` maps a job (vec4 a, vec4 b) to a vec4.
std::vector<glm::vec4> run(const std::string& name, const std::string& body,
                           const std::vector<std::array<glm::vec4, 2>>& jobs) {
  const Kernel kernel(name,
                      R"(
#include "lib/moment_warp.glsl"
#include "lib/variance_shadow.glsl"
#include "lib/moment_shadow.glsl"
#include "lib/convolution_shadow.glsl"
layout(local_size_x = 64) in;
struct Job { vec4 a, b; };
layout(set = 0, binding = 0, std430) readonly buffer Jobs { Job jobs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { vec4 answers[]; };
vec4 answer(vec4 a, vec4 b) {)" +
                          body + R"(}
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < jobs.length()) answers[i] = answer(jobs[i].a, jobs[i].b);
}
)",
                      2);
  return kernel.run<glm::vec4>({bytes_of(jobs)}, jobs.size());
}

using Real = long double;

struct Point {
  Real z, weight;
};
using Distribution = std::vector<Point>;

Real moment(const Distribution& points, int power) {
  Real sum = 0;
  for (const Point& p : points) sum += p.weight * std::pow(p.z, power);
  return sum;
}
glm::vec4 moments(const Distribution& d) {
  return {float(moment(d, 1)), float(moment(d, 2)), float(moment(d, 3)), float(moment(d, 4))};
}

// -------------------------------------------------------------------------------
// four moments: brute force

// Least mass below `z` of all distributions on `grid` with the moments 0..4 of
// `start`, whose five points are on the grid: a linear program, solved by the
// simplex method from `start` as first basis.
class LeastMass {
 public:
  LeastMass(std::vector<Real> grid, Real z) : grid_(std::move(grid)), z_(z) {}

  Real operator()(const std::array<size_t, 5>& start, const std::array<Real, 5>& weights) {
    std::array<size_t, 5> basis = start;
    std::array<Real, 5> x = weights;
    for (int turn = 0; turn < 2000; ++turn) {
      const auto price = dual(basis);
      size_t enters = grid_.size();
      Real best = -1e-12L;
      for (size_t i = 0; i < grid_.size(); ++i) {
        Real reduced = cost(i), power = 1;
        for (int k = 0; k < 5; ++k, power *= grid_[i]) reduced -= price[k] * power;
        if (reduced < best) best = reduced, enters = i;
      }
      if (enters == grid_.size()) break;
      const auto step = column_in(basis, enters);
      int leaves = -1;
      Real most = std::numeric_limits<Real>::max();
      for (int k = 0; k < 5; ++k)
        if (step[k] > 1e-12L && x[k] / step[k] < most) most = x[k] / step[k], leaves = k;
      if (leaves < 0) break;
      for (int k = 0; k < 5; ++k) x[k] -= most * step[k];
      x[leaves] = most;
      basis[leaves] = enters;
    }
    Real mass = 0;
    for (int k = 0; k < 5; ++k) mass += cost(basis[k]) * x[k];
    return mass;
  }

 private:
  using Vector = std::array<Real, 5>;
  using Matrix = std::array<Vector, 5>;
  Real cost(size_t i) const { return grid_[i] < z_ ? 1 : 0; }

  static Vector solve(Matrix m, Vector v) {
    for (int c = 0; c < 5; ++c) {
      int pivot = c;
      for (int r = c + 1; r < 5; ++r)
        if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
      std::swap(m[c], m[pivot]), std::swap(v[c], v[pivot]);
      for (int r = 0; r < 5; ++r) {
        if (r == c) continue;
        const Real factor = m[r][c] / m[c][c];
        for (int k = c; k < 5; ++k) m[r][k] -= factor * m[c][k];
        v[r] -= factor * v[c];
      }
    }
    for (int c = 0; c < 5; ++c) v[c] /= m[c][c];
    return v;
  }
  Vector dual(const std::array<size_t, 5>& basis) const {  // costs of the basis in terms of the moments
    Matrix rows;
    Vector costs;
    for (int k = 0; k < 5; ++k) {
      for (int power = 0; power < 5; ++power) rows[k][power] = std::pow(grid_[basis[k]], power);
      costs[k] = cost(basis[k]);
    }
    return solve(rows, costs);
  }
  Vector column_in(const std::array<size_t, 5>& basis, size_t enters) const {
    Matrix columns;
    Vector target;
    for (int power = 0; power < 5; ++power) {
      for (int k = 0; k < 5; ++k) columns[power][k] = std::pow(grid_[basis[k]], power);
      target[power] = std::pow(grid_[enters], power);
    }
    return solve(columns, target);
  }

  std::vector<Real> grid_;
  Real z_;
};

std::vector<Real> grid_over(Real low, Real high, size_t count) {
  std::vector<Real> grid(count);
  for (size_t i = 0; i < count; ++i) grid[i] = low + (high - low) * Real(i) / Real(count - 1);
  return grid;
}

struct Case {
  std::array<size_t, 5> points;
  std::array<Real, 5> weights;
  Distribution distribution;
  Real z;
};

// Five points in [-1, 1], at least a tenth apart; the receiver at any place of
// the grid inside.
std::vector<Case> cases(const std::vector<Real>& grid, size_t count) {
  std::mt19937 random(7);
  std::uniform_int_distribution<size_t> any(0, grid.size() - 1);
  std::uniform_real_distribution<double> weight(0.1, 1.0);
  std::vector<Case> all;
  while (all.size() < count) {
    Case c;
    for (size_t& p : c.points) p = any(random);
    std::sort(c.points.begin(), c.points.end());
    bool good = std::abs(grid[c.points[0]]) <= 1 && std::abs(grid[c.points[4]]) <= 1;
    for (int k = 1; k < 5; ++k) good = good && grid[c.points[k]] - grid[c.points[k - 1]] >= 0.1L;
    Real sum = 0;
    for (Real& w : c.weights) sum += w = weight(random);
    for (int k = 0; k < 5; ++k) c.distribution.push_back({grid[c.points[k]], c.weights[k] /= sum});
    c.z = grid[any(random)];
    if (good && std::abs(c.z) < 0.98L) all.push_back(c);
  }
  return all;
}

// The grid is finite, so its least mass lies above the bound by about its step
// (0.005) times the slope of the bound (up to about 5 for these weights).
constexpr Real kGridError = 0.03L;

TEST(Moments, HausdorffIsTheLeastMassOfAllDistributionsInTheRange) {
  const auto grid = grid_over(-1, 1, 401);
  const auto all = cases(grid, 60);
  std::vector<std::array<glm::vec4, 2>> jobs;
  for (const Case& c : all) jobs.push_back({moments(c.distribution), glm::vec4(float(c.z))});
  const auto bounds = run("hausdorff",
                          "return vec4(hausdorff_occlusion(a, b.x), "
                          "hamburger_occlusion(a, b.x), 0, 0);",
                          jobs);
  size_t sharper = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    const Real least = LeastMass(grid, all[i].z)(all[i].points, all[i].weights);
    EXPECT_NEAR(double(bounds[i].x), double(least), double(kGridError)) << "case " << i;
    EXPECT_GE(bounds[i].x, bounds[i].y - 1e-3f) << "knowing more, Hausdorff's bound is no looser; case " << i;
    sharper += bounds[i].x > bounds[i].y + 1e-2f;
  }
  EXPECT_GT(sharper, all.size() / 10);
}

TEST(Moments, HamburgerIsTheLeastMassOfAllDistributions) {
  const auto grid = grid_over(-4, 4, 1601);
  const auto all = cases(grid, 30);
  std::vector<std::array<glm::vec4, 2>> jobs;
  for (const Case& c : all) jobs.push_back({moments(c.distribution), glm::vec4(float(c.z))});
  const auto bounds = run("hamburger",
                          "vec2 p = other_points(a, b.x); return "
                          "vec4(hamburger_occlusion(a, b.x), p, 0);",
                          jobs);
  for (size_t i = 0; i < all.size(); ++i) {
    const Real least = LeastMass(grid, all[i].z)(all[i].points, all[i].weights);
    EXPECT_LE(bounds[i].x, float(least) + 2e-3f) << "case " << i;
    const bool on_grid =
        bounds[i].y > -8 && bounds[i].z < 8;  // else the extreme distribution is out of the grid's reach
    if (on_grid) {
      EXPECT_NEAR(double(bounds[i].x), double(least), double(kGridError)) << "case " << i;
    }
  }
}

// Two points are determined by their moments, and of three the bound at one of them is sharp: it is the mass
// of those nearer. The defaults' moment bias moves that by no more than a fiftieth here.
TEST(Moments, TwoAndThreePointDistributionsAreRecovered) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.95, 0.95), weight(0.15, 1.0);
  std::vector<std::array<glm::vec4, 2>> jobs;
  std::vector<Real> expected;
  while (jobs.size() < 400) {
    Distribution d(jobs.size() % 2 ? 2 : 3);
    Real sum = 0, gap = 2, mass = 0;
    for (Point& p : d) p = {Real(place(random)), Real(weight(random))}, sum += p.weight;
    const Real z = d.size() == 3 ? d[0].z : Real(place(random));
    for (size_t i = 0; i < d.size(); ++i) {
      d[i].weight /= sum;
      if (d[i].z != z) gap = std::min(gap, std::abs(d[i].z - z));
      for (size_t k = 0; k < i; ++k) gap = std::min(gap, std::abs(d[i].z - d[k].z));
      if (d[i].z < z) mass += d[i].weight;
    }
    if (gap < 0.25L) continue;
    jobs.push_back({moments(d), glm::vec4(float(z))});
    expected.push_back(mass);
  }
  const auto bounds = run("few_points", R"(
  return vec4(hamburger_occlusion(bias_moments(a, HAMBURGER_CENTRE, SINGLE_MOMENT_BIAS), b.x),
              hausdorff_occlusion(bias_moments(a, HAUSDORFF_CENTRE, SINGLE_MOMENT_BIAS), b.x), 0, 0);)",
                          jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    EXPECT_NEAR(bounds[i].x, double(expected[i]), 0.02) << "Hamburger, case " << i;
    EXPECT_NEAR(bounds[i].y, double(expected[i]), 0.02) << "Hausdorff, case " << i;
  }
}

TEST(Moments, ConstantDepthIsAStepAndAnythingElseStaysInRange) {
  std::vector<std::array<glm::vec4, 2>> jobs;
  for (float depth = -1.0f; depth <= 1.0f; depth += 0.125f)
    for (float z = -1.0f; z <= 1.0f; z += 0.0625f)
      jobs.push_back({glm::vec4(depth, depth * depth, depth * depth * depth, depth * depth * depth * depth),
                      glm::vec4(z)});
  const auto bounds = run("constant_depth", R"(
  return vec4(hamburger_occlusion(bias_moments(a, HAMBURGER_CENTRE, SINGLE_MOMENT_BIAS), b.x),
              hausdorff_occlusion(bias_moments(a, HAUSDORFF_CENTRE, SINGLE_MOMENT_BIAS), b.x),
              hamburger_occlusion(a, b.x), hausdorff_occlusion(a, b.x));)",
                          jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      ASSERT_TRUE(std::isfinite(bounds[i][k])) << i << " " << k;
      EXPECT_TRUE(bounds[i][k] >= 0 && bounds[i][k] <= 1) << i << " " << k;
    }
    const float depth = jobs[i][0].x, z = jobs[i][1].x;
    if (std::abs(z) > 0.99f || std::abs(depth) > 0.99f) continue;  // at the ends of the range
    for (int k = 0; k < 2; ++k) {
      if (z < depth) {
        EXPECT_NEAR(bounds[i][k], 0, 0.01) << depth << " " << z << " " << k;
      }
      if (z > depth) {
        EXPECT_NEAR(bounds[i][k], 1, 0.01) << depth << " " << z << " " << k;
      }
    }
  }
}

TEST(Moments, QuantisationFitsTheUnitCubeAndRoundTrips) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> z(0, 1), part(0, 1);
  std::vector<std::array<glm::vec4, 2>> jobs;
  for (int i = 0; i <= 1000; ++i)
    jobs.push_back({glm::vec4(float(i) / 1000, z(random), part(random), 0), glm::vec4(0)});
  const char* body = R"(
  vec4 m = mix(four_moments(a.x), four_moments(a.y), a.z);
  vec4 q = quantisation_transform(four_moments(a.x));
  return vec4(distance(inverse_quantisation_transform(quantisation_transform(m)), m), min(min(q.x, q.y), min(q.z, q.w)),
              max(max(q.x, q.y), max(q.z, q.w)),
              distance(quantisation_transform(m), mix(q, quantisation_transform(four_moments(a.y)), a.z)));)";
  float least = 1, most = 0;
  for (const glm::vec4& v : run("quantisation", body, jobs)) {
    EXPECT_LE(v.x, 2e-6f) << "round trip";
    EXPECT_GE(v.y, -1e-6f);
    EXPECT_LE(v.z, 1 + 1e-6f);
    EXPECT_LE(v.w, 1e-6f) << "affine, so filtering commutes with it";
    least = std::min(least, v.y), most = std::max(most, v.z);
  }
  EXPECT_NEAR(least, 0, 1e-3);
  EXPECT_NEAR(most, 1, 1e-3);
}

// ---------------------------------------------------------------------------------------
// variance, warps

// Of the two-point distributions with mean and variance, the one with the most
// mass at or beyond t.
TEST(Variance, ChebyshevIsTheLargestTailOfTwoPointDistributions) {
  std::vector<std::array<glm::vec4, 2>> jobs;
  for (float mean = -0.4f; mean < 0.4f; mean += 0.15f)
    for (float deviation : {0.01f, 0.1f, 0.3f})
      for (float t = -0.5f; t < 0.5f; t += 0.07f)
        jobs.push_back({glm::vec4(mean, mean * mean + deviation * deviation, deviation, 0), glm::vec4(t)});
  const auto bounds = run("chebyshev", "return vec4(chebyshev_visibility(a.xy, b.x, 1e-9));", jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const double mean = jobs[i][0].x, deviation = jobs[i][0].z, t = jobs[i][1].x;
    double most = t <= mean ? 1 : 0;
    for (int k = 1; k < 20000 && t > mean; ++k) {
      const double p = k / 20000.0;  // mass of the farther point
      if (mean + deviation * std::sqrt((1 - p) / p) >= t) most = std::max(most, p);
    }
    EXPECT_NEAR(bounds[i].x, most, 2e-3) << "case " << i;
  }
}

// erfc to the approximation's stated error; the doubled tail is 1 at the mean,
// the plain one 1/2.
TEST(Variance, GaussianTails) {
  std::vector<std::array<glm::vec4, 2>> jobs;
  for (float x = -4; x <= 4; x += 0.05f) jobs.push_back({glm::vec4(x), glm::vec4(0)});
  const auto v = run("gaussian_tail", R"(
  return vec4(gaussian_visibility(vec2(0, 1), a.x, 1e-9, true), gaussian_visibility(vec2(0, 1), a.x, 1e-9, false), 0, 0);)",
                     jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const double tail = 0.5 * std::erfc(jobs[i][0].x / std::sqrt(2.0));
    EXPECT_NEAR(v[i].y, tail, 1e-6);
    EXPECT_NEAR(v[i].x, std::min(1.0, 2 * tail), 2e-6);
  }
}

// A share p of a kernel at depth near, the rest at the receiver's: in the limit
// of steep warps the answer is 1 - p.
TEST(Variance, WarpsKeepTheClosedFormAcrossTheirRange) {
  std::vector<std::array<glm::vec4, 2>> jobs;
  for (float c : {1.0f, 5.54f, 20.0f, 42.0f})
    for (float near = 0.0f; near < 1.0f; near += 0.2f)
      for (float t = 0.0f; t <= 1.0f; t += 0.1f)
        for (float p : {0.0f, 0.25f, 0.9f, 1.0f}) jobs.push_back({glm::vec4(near, t, p, c), glm::vec4(0)});
  const auto v = run("warps", R"(
  vec2 answers;
  for (int k = 0; k < 2; ++k) {
    float near = k == 0 ? positive_warp(a.x, a.w) : negative_warp(a.x, a.w);
    float t = k == 0 ? positive_warp(a.y, a.w) : negative_warp(a.y, a.w);
    vec2 m = mix(first_two_moments(t), first_two_moments(near), a.z);
    float scale = warp_scale(m.x, t);
    answers[k] = chebyshev_visibility(scale_moments(m, scale), t * scale, max(warped_variance(1e-9, t * scale, a.w), 1e-12));
  }
  return vec4(answers, 0, 0);)",
                     jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const auto [near, t, p, c] = std::array{jobs[i][0].x, jobs[i][0].y, jobs[i][0].z, jobs[i][0].w};
    for (int k = 0; k < 2; ++k) {
      ASSERT_TRUE(std::isfinite(v[i][k])) << near << " " << t << " " << p << " " << c;
      EXPECT_TRUE(v[i][k] >= 0 && v[i][k] <= 1) << v[i][k];
    }
    if (near >= t) {
      EXPECT_EQ(v[i].x, 1) << "nothing nearer";
    }
    // Two points: Chebyshev is exact, whatever the warp, where the difference
    // exceeds rounding and least variance.
    if (near < t - 0.05f && p < 1) {
      EXPECT_NEAR(v[i].x, 1 - p, 0.01) << near << " " << t << " " << p << " " << c;
      EXPECT_NEAR(v[i].y, 1 - p, 0.01) << near << " " << t << " " << p << " " << c;
    }
  }
}

TEST(Variance, LightLeakReductionCutsAndStretches) {
  const auto v =
      run("light_leak",
          "return vec4(reduce_light_leak(a.x, 0.0), "
          "reduce_light_leak(a.x, 0.2), 0, 0);",
          {{glm::vec4(0.1f), glm::vec4(0)}, {glm::vec4(0.6f), glm::vec4(0)}, {glm::vec4(1), glm::vec4(0)}});
  EXPECT_FLOAT_EQ(v[0].x, 0.1f);
  EXPECT_FLOAT_EQ(v[0].y, 0);
  EXPECT_FLOAT_EQ(v[1].x, 0.6f);
  EXPECT_NEAR(v[1].y, 0.5, 1e-6);
  EXPECT_FLOAT_EQ(v[2].x, 1);
  EXPECT_FLOAT_EQ(v[2].y, 1);
}

// --------------------------------------------------------------------------------------------
// Fourier series

// 1/2 + 2 sum of sin(c_k (z - d)) / c_k: the square wave's series, which is the
// step's within half a period.
double series(double z, double d, int terms, double ringing) {
  double sum = 0;
  for (int k = 0; k < terms; ++k) {
    const double frequency = M_PI * (2 * k + 1), part = double(k) / terms;
    sum += 2 / frequency * std::exp(-ringing * part * part) * std::sin(frequency * (z - d));
  }
  return sum;
}

TEST(Convolution, TermsSumToTheSeriesOfTheFilteredStep) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> any(0, 1);
  for (const int terms : {1, 4, 7, 16, 32}) {
    std::vector<std::array<glm::vec4, 2>> jobs;
    for (int i = 0; i < 200; ++i)
      jobs.push_back({glm::vec4(any(random), any(random), any(random), any(random)),
                      glm::vec4(float(terms), float(i % 2), 0, 0)});
    const auto v = run("fourier", R"(
  float sum = 0.0;
  vec2 first = csm_first(a.x), second = csm_first(a.y), receiver = csm_first(a.z);
  for (int k = 0; k < int(b.x); ++k) {
    sum += csm_term(mix(first, second, a.w), receiver, k, int(b.x), b.y);
    first = csm_next(first, csm_rotation(a.x));
    second = csm_next(second, csm_rotation(a.y));
    receiver = csm_next(receiver, csm_rotation(a.z));
  }
  return vec4(sum, csm_visibility(sum), 0, 0);)",
                       jobs);
    for (size_t i = 0; i < jobs.size(); ++i) {
      const auto& a = jobs[i][0];
      const double expected =
          (1 - a.w) * series(a.x, a.z, terms, i % 2) + a.w * series(a.y, a.z, terms, i % 2);
      EXPECT_NEAR(v[i].x, expected, 1e-4) << terms << " terms, case " << i;
      EXPECT_NEAR(v[i].y, std::clamp(1 + 2 * expected, 0.0, 1.0), 2e-4);
    }
  }
}

TEST(Convolution, MoreTermsComeNearerToTheStep) {
  double before = 1;
  for (const int terms : {2, 4, 8, 16, 32}) {
    double error = 0;
    for (double z = 0; z <= 1; z += 1.0 / 128)
      error += std::pow(0.5 + series(z, 0.5, terms, 0) - (z >= 0.5 ? 1 : 0), 2) / 128;
    EXPECT_LT(error, before);
    before = error;
  }
}

}  // namespace
}  // namespace gnomon::test
