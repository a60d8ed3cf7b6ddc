// The geometry of soft shadows, against what rays, projections and matrices say in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::test {
namespace {

using Job = std::array<glm::vec4, 2>;

// `body` maps a job (vec4 a, vec4 b) to a vec4.
std::vector<glm::vec4> run(const std::string& name, const std::string& body, const std::vector<Job>& jobs) {
  const Kernel kernel("soft_shadow_" + name,
                      R"(
#include "lib/soft_shadow.glsl"
layout(local_size_x = 64) in;
struct Job { vec4 a, b; };
layout(set = 0, binding = 0, std430) readonly buffer Jobs { Job jobs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { vec4 answers[]; };
vec4 answer(vec4 a, vec4 b) {)" +
                          body +
                          R"(}
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < jobs.length()) answers[i] = answer(jobs[i].a, jobs[i].b);
}
)",
                      2);
  return kernel.run<glm::vec4>({bytes_of(jobs)}, jobs.size());
}

// Uniform numbers, the same in every run.
class Random {
 public:
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

 private:
  std::mt19937 engine_{11};
};

constexpr int kCases = 400;
constexpr double kRelative = 2e-6;  // a few roundings of a float

void expect_close(double is, double wanted, double relative = kRelative, double absolute = 1e-12) {
  EXPECT_NEAR(is, wanted, relative * std::abs(wanted) + absolute);
}

// Lateral place at depth z of the line through a point `u` of the light (depth 0) and the receiver (p, z_p).
double on_ray(double u, double p, double z_p, double z) { return u + (p - u) * z / z_p; }

struct Scene1D {  // a light of width w, near and far plane, a receiver and a blocker
  float w, n, f, z_p, z_b, p;
  Job job() const { return {glm::vec4(w, n, f, p), glm::vec4(z_p, z_b, 0, 0)}; }
};
std::vector<Scene1D> random_scenes() {
  Random random;
  std::vector<Scene1D> all;
  for (int i = 0; i < kCases; ++i) {
    const double n = std::exp(random(-3, 1)), z_b = n * random(1.01, 30), z_p = z_b * random(1.01, 8);
    all.push_back({float(std::exp(random(-3, 2))), float(n), float(z_p * random(1.1, 4)), float(z_p),
                   float(z_b), float(random(-5, 5))});
  }
  return all;
}
std::vector<Job> jobs_of(const std::vector<Scene1D>& scenes) {
  std::vector<Job> jobs;
  for (const Scene1D& s : scenes) jobs.push_back(s.job());
  return jobs;
}

// The blocker's edge throws the rays from the light's two ends onto the receiver's plane: what lies between.
TEST(GpuSoftShadow, PenumbraLiesBetweenTheRaysFromTheLightsEnds) {
  const auto scenes = random_scenes();
  const auto is = run("penumbra",
                      "return vec4(penumbra_width(a.x, b.x, b.y), "
                      "kernel_of_penumbra(penumbra_width(a.x, b.x, b.y), a.y, b.x), 0.0, 0.0);",
                      jobs_of(scenes));
  for (size_t i = 0; i < scenes.size(); ++i) {
    const auto [w, n, f, z_p, z_b, p] = scenes[i];
    const double edge = 0.7;  // of the blocker; any
    const auto shadow = [&](double u) { return u + (edge - u) * double(z_p) / z_b; };
    const double wanted = std::abs(shadow(-0.5 * w) - shadow(0.5 * w));
    const double cancelled = 1e-7 * z_p / (z_p - z_b);  // of the depths' difference
    expect_close(is[i].x, wanted, kRelative + cancelled);
    expect_close(is[i].y, wanted * n / z_p, kRelative + cancelled);
  }
}

TEST(GpuSoftShadow, KernelIsWhatTheRaysToTheLightCoverAtTheBlockersDepth) {
  const auto scenes = random_scenes();
  const auto is = run("kernel",
                      "return vec4(kernel_width(a.x, a.y, b.x, b.y), first_search_width(a.x, a.y, b.x), "
                      "kernel_point(vec2(0.25, -0.5) * a.x, a.y, b.x, b.y));",
                      jobs_of(scenes));
  for (size_t i = 0; i < scenes.size(); ++i) {
    const auto [w, n, f, z_p, z_b, p] = scenes[i];
    const auto on_near = [&, n = n, p = p, z_p = z_p](double u, double z) {
      return on_ray(u, p, z_p, z) * n / z - double(p) * n / z_p;
    };
    // Float keeps 1e-7 of the depths, of which a difference is taken.
    const double tolerance = kRelative + 1e-7 * z_p / (z_p - z_b);
    expect_close(is[i].x, on_near(0.5 * w, z_b) - on_near(-0.5 * w, z_b), tolerance);
    expect_close(is[i].y, on_near(0.5 * w, n) - on_near(-0.5 * w, n), kRelative + 1e-7 * z_p / (z_p - n));
    expect_close(is[i].z, on_near(0.25 * w, z_b), tolerance, 1e-6 * std::abs(p) * n / z_p);
    expect_close(is[i].w, on_near(-0.5 * w, z_b), tolerance, 1e-6 * std::abs(p) * n / z_p);
  }
}

// In device depth, that of (3.6), the kernel is linear.
TEST(GpuSoftShadow, KernelOfDeviceDepthIsThatOfLinearDepth) {
  const auto scenes = random_scenes();
  std::vector<Job> jobs;
  for (const Scene1D& s : scenes) {
    const auto device = [&](double z) { return double(s.f) / (s.f - s.n) * (1.0 - s.n / z); };
    jobs.push_back({glm::vec4(s.w, s.n, s.f, 0), glm::vec4(device(s.z_p), device(s.z_b), 0, 0)});
  }
  const auto is = run(
      "device", "return vec4(kernel_width_of_device_depth(a.x, a.y, a.z, b.x, b.y), 0.0, 0.0, 0.0);", jobs);
  for (size_t i = 0; i < scenes.size(); ++i) {
    const auto [w, n, f, z_p, z_b, p] = scenes[i];
    const double wanted = double(w) * n * (1.0 / z_b - 1.0 / z_p);
    EXPECT_NEAR(is[i].x, wanted, 3e-7 * w + kRelative * wanted);  // depths near 1 have steps of 6e-8
  }
}

// Whatever near plane, field of view and map: the same part of the world.
TEST(GpuSoftShadow, TexelsOfAKernelDependOnNoPlane) {
  std::vector<Job> jobs;
  for (const float n : {0.01f, 0.1f, 1.0f, 4.0f})
    for (const float tangent : {0.2f, 1.0f, 3.0f})
      for (const float side : {64.0f, 1024.0f, 4096.0f})
        jobs.push_back({glm::vec4(0.8f, n, tangent, side), glm::vec4(9.0f, 4.0f, 0, 0)});
  const auto is = run(
      "texels", "return vec4(kernel_texels(kernel_width(a.x, a.y, b.x, b.y), a.y, a.z, a.w), 0.0, 0.0, 0.0);",
      jobs);
  for (size_t i = 0; i < jobs.size(); ++i)
    expect_close(is[i].x * 2.0 * jobs[i][0].z / jobs[i][0].w, 0.8 * (1.0 / 4 - 1.0 / 9));
}

TEST(GpuSoftShadow, DirectionalLightsShineFromACone) {
  Random random;
  std::vector<Job> jobs;
  for (int i = 0; i < kCases; ++i) {
    const double z_b = random(1, 50);
    jobs.push_back(
        {glm::vec4(random(0.001, 1), 0, 0, 0), glm::vec4(z_b + random(1, 50), z_b, random(1, 99), 1024)});
  }
  const auto is = run("directional", R"(
  float size = directional_size(tan(0.5 * a.x)), penumbra = directional_penumbra_width(size, b.x, b.y);
  return vec4(size, penumbra, directional_kernel_texels(penumbra, b.z, b.w), 0.0);)",
                      jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const double tangent = std::tan(0.5 * double(jobs[i][0].x)), z_p = jobs[i][1].x, z_b = jobs[i][1].y;
    const double wanted =
        (z_p - z_b) * tangent - (z_p - z_b) * -tangent;  // between the cone's two outer rays
    expect_close(is[i].x, 2 * tangent, 1e-5);            // tan() of Vulkan is within a few ulp
    expect_close(is[i].y, wanted, 1e-5);
    expect_close(is[i].z, wanted / jobs[i][1].z * jobs[i][1].w, 1e-5);
  }
}

// The line from P through Q meets the light's plane there.
TEST(GpuSoftShadow, BackProjectionFollowsTheLineToTheLight) {
  Random random;
  std::vector<Job> jobs;
  for (int i = 0; i < kCases; ++i) {
    const double z_s = random(1, 10);
    jobs.push_back({glm::vec4(random(-3, 3), random(-3, 3), random(-3, 3), random(-3, 3)),
                    glm::vec4(z_s, z_s * random(1.1, 5), 0, 0)});
  }
  const auto is = run("back_project", "return vec4(back_project(a.xy, b.x, a.zw, b.y), 0.0, 0.0);", jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const glm::dvec3 q(jobs[i][0].x, jobs[i][0].y, jobs[i][1].x), p(jobs[i][0].z, jobs[i][0].w, jobs[i][1].y);
    const glm::dvec3 met = p + (q - p) * (p.z / (p.z - q.z));
    const double size = (std::abs(q.x) + std::abs(q.y) + std::abs(p.x) + std::abs(p.y)) * p.z / (p.z - q.z);
    EXPECT_NEAR(is[i].x, met.x, 1e-6 * size);
    EXPECT_NEAR(is[i].y, met.y, 1e-6 * size);
    EXPECT_NEAR(met.z, 0.0, 1e-12 * p.z);
  }
}

// Part of a light of width w (along x) that is left of nothing but the half plane x < s at depth z_s.
double seen_beside_half_plane(double s, double z_s, double p, double z_p, double w) {
  const double border = (s * z_p - p * z_s) / (z_p - z_s);  // on the light; what lies beyond x = s is open
  return std::clamp(0.5 - border / w, 0.0, 1.0);
}

// Whatever the receiver's slope: the plane through P parallel to the light is what counts.
TEST(GpuSoftShadow, HalfPlaneIsExact) {
  Random random;
  std::vector<Job> jobs;
  for (int i = 0; i < kCases; ++i) {
    const double z_s = random(1, 10), z_p = z_s * random(1.05, 5), w = random(0.05, 3), s = random(-3, 3);
    const double penumbra = w * (z_p - z_s) / z_s;
    jobs.push_back(
        {glm::vec4(s, z_s, s * z_p / z_s + random(-0.8, 0.8) * penumbra, z_p), glm::vec4(w, 0, 0, 0)});
  }
  const auto is = run("half_plane", R"(
  vec2 site = slide_site(vec2(a.x, 0.0), a.y, a.w);
  return vec4(half_plane_visibility(distance(vec2(a.z, 0.0), site), penumbra_width(b.x, a.w, a.y), a.z > site.x), site, 0.0);)",
                      jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const glm::vec4 a = jobs[i][0];
    const double wanted = seen_beside_half_plane(a.x, a.y, a.z, a.w, jobs[i][1].x);
    EXPECT_NEAR(is[i].x, wanted, 1e-4) << i;
    expect_close(is[i].y, double(a.x) * a.w / a.y);
  }
}

TEST(GpuSoftShadow, NoPenumbraIsAStep) {
  const std::vector<Job> jobs{
      {glm::vec4(0.3f, 0, 1, 0), {}}, {glm::vec4(0.3f, 0, 0, 0), {}}, {glm::vec4(0, 0, 1, 0), {}}};
  const auto is = run("step", "return vec4(half_plane_visibility(a.x, a.y, a.z > 0.5));", jobs);
  EXPECT_EQ(is[0].x, 1.0f);
  EXPECT_EQ(is[1].x, 0.0f);
  EXPECT_EQ(is[2].x, 1.0f);
}

TEST(GpuSoftShadow, OffsetsAreMeasuredAtTheReceiversDepth) {
  const std::vector<Job> jobs{{glm::vec4(1, 2, 4, 0), glm::vec4(3, -1, 8, 0)}};
  const auto is = run("offset", "return vec4(parallel_offset(a.xy, a.z, b.xy, b.z), 0.0, 0.0);", jobs);
  expect_close(is[0].x, 1.0 * 8 / 4 - 3);
  expect_close(is[0].y, 2.0 * 8 / 4 + 1);
}

// The half axes' ends are on the border of {d: |J d| <= w / 2}, at right angles, and nothing of it is further
// or nearer.
TEST(GpuSoftShadow, ScreenKernelIsTheEllipseThatTheDerivativeMapsToADisc) {
  Random random;
  std::vector<Job> jobs{{glm::vec4(1, 0, 0, 1), glm::vec4(2)},
                        {glm::vec4(3, 0, 0, 0.5), glm::vec4(2)},
                        {glm::vec4(0.5, 0, 0, 3), glm::vec4(2)}};
  for (int i = 0; i < kCases; ++i)
    jobs.push_back(
        {glm::vec4(random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1)), glm::vec4(random(0.1, 3))});
  const auto is =
      run("screen", "ScreenKernel k = screen_kernel(a.xy, a.zw, b.x); return vec4(k.major, k.minor);", jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const glm::dmat2 j{glm::dvec2(jobs[i][0].x, jobs[i][0].y), glm::dvec2(jobs[i][0].z, jobs[i][0].w)};
    const double half = 0.5 * jobs[i][1].x, bend = std::abs(glm::determinant(j));
    if (bend < 1e-2) continue;  // float tells little of a plane seen nearly edge-on
    const glm::dvec2 major(is[i].x, is[i].y), minor(is[i].z, is[i].w);
    double least = 1e300, most = 0;
    for (int k = 0; k < 3600; ++k) {
      const double angle = 2 * M_PI * k / 3600;
      const double radius = half / length(j * glm::dvec2(std::cos(angle), std::sin(angle)));
      least = std::min(least, radius), most = std::max(most, radius);
    }
    const double tolerance = 1e-4 / bend;
    EXPECT_NEAR(length(j * major), half, tolerance * half);
    EXPECT_NEAR(length(j * minor), half, tolerance * half);
    EXPECT_NEAR(dot(major, minor), 0.0, tolerance * length(major) * length(minor));
    EXPECT_NEAR(length(major), most, 1e-3 * most + tolerance * most);
    EXPECT_NEAR(length(minor), least, 1e-3 * least + tolerance * least);
  }
}

// A length that faces the camera covers its share of what the image shows at its depth.
TEST(GpuSoftShadow, ScreenWidthIsTheShareOfTheImagesHeight) {
  const std::vector<Job> jobs{{glm::vec4(0.7f, 720, 0.4f, 5), {}}, {glm::vec4(2, 90, 1, 100), {}}};
  const auto is = run("isotropic", "return vec4(screen_width(a.x, a.y, a.z, a.w));", jobs);
  expect_close(is[0].x, 720 * 0.7 / (2 * 0.4 * 5));
  expect_close(is[1].x, 90 * 2.0 / (2 * 1 * 100));
}

TEST(GpuSoftShadow, EqualDepthIsLitAndUmbraNeedsTheKernelInside) {
  const std::vector<Job> jobs{{glm::vec4(0.5f, 0.5f, 3, 3), glm::vec4(3, 3, 0, 0)},
                              {glm::vec4(0.4f, 0.5f, 3, 3), glm::vec4(3, 3.5, 0, 0)}};
  const auto is =
      run("blocks",
          "return vec4(blocks(a.x, a.y) ? 1.0 : 0.0, holds_kernel(a.zw, b.xy) ? 1.0 : 0.0, 0.0, 0.0);", jobs);
  EXPECT_EQ(is[0], glm::vec4(0, 1, 0, 0));
  EXPECT_EQ(is[1], glm::vec4(1, 0, 0, 0));
}

}  // namespace
}  // namespace gnomon::test
