// The receiver's tangent plane in the shadow map, depth encodings and octahedral vectors, against double
// precision.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

#include "engine/light/light_view.h"
#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::test {
namespace {

struct GpuView {  // LightView of lib/light_view.glsl
  glm::mat4 clip{1.0f};
  glm::vec4 rows[3]{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  glm::vec4 range{0.5f, 50.0f, 0.8f, 0.8f};  // near, far, half width, half height
  glm::uvec4 info{0, 0, 0, 0};
};
static_assert(sizeof(GpuView) == 144);

GpuView perspective_view() { return {}; }
GpuView orthographic_view() {
  GpuView view;
  view.range = {0.5f, 50.0f, 20.0f, 15.0f};
  view.info.y = 1;
  return view;
}

struct Job {
  glm::vec4 q{0};       // point in the view's frame
  glm::vec4 n{0};       // unit normal
  glm::vec2 offset{0};  // from the point, texels
  float size = 1024, bias = 0;
  uint32_t view = 0, linear = 0, unused[2] = {};
};
static_assert(sizeof(Job) == 64);

struct Answer {
  float depth, slope, z, base;
  float texel[2], gradient[2];
};

constexpr const char* kPlaneKernel = R"(
const float MAX_SLOPE = 20.0;
#include "lib/receiver_plane.glsl"
layout(local_size_x = 64) in;
struct Job { vec4 q, n; vec2 offset; float size, bias; uvec4 view_linear; };
struct Answer { float depth, slope, z, base; vec2 texel, gradient; };
layout(set = 0, binding = 0, std430) readonly buffer Views { LightView views[]; };
layout(set = 0, binding = 1, std430) readonly buffer Jobs { Job jobs[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Answers { Answer answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= jobs.length()) return;
  Job job = jobs[i];
  LightView view = views[job.view_linear.x];
  Receiver r = make_receiver(view, job.q.xyz, job.n.xyz, job.size);
  if (job.bias != 0.0) r = bias_receiver(view, r, job.bias);
  float depth = receiver_depth(view, r, r.texel + job.offset, job.view_linear.y != 0u);
  answers[i] = Answer(depth, r.slope, r.z, r.base, r.texel, r.gradient);
}
)";

std::vector<Answer> planes(const std::vector<GpuView>& views, const std::vector<Job>& jobs) {
  const Kernel kernel("receiver_plane", kPlaneKernel, 3);
  return kernel.run<Answer>({bytes_of(views), bytes_of(jobs)}, jobs.size());
}

// ---- Double precision. ----

double encode(const GpuView& view, double z, bool linear) {
  const double n = view.range.x, f = view.range.y;
  return linear || view.info.y ? (z - n) / (f - n) : f / (f - n) - f * n / (z * (f - n));
}
double decode(const GpuView& view, double d, bool linear) {
  const double n = view.range.x, f = view.range.y;
  return linear || view.info.y ? n + d * (f - n) : f * n / (f - d * (f - n));
}
// Largest |d depth / d z| at z.
double encode_slope(const GpuView& view, double z, bool linear) {
  const double n = view.range.x, f = view.range.y;
  return linear || view.info.y ? 1 / (f - n) : f * n / (z * z * (f - n));
}

glm::dvec2 map_position(const GpuView& view, glm::dvec3 q) {
  const double scale = view.info.y ? 1 : -q.z;
  return {0.5 + 0.5 * q.x / (view.range.z * scale), 0.5 - 0.5 * q.y / (view.range.w * scale)};
}

// Depth along the axis where the light's ray through the map position meets the plane.
double intersect(const GpuView& view, glm::dvec3 q, glm::dvec3 n, glm::dvec2 uv) {
  const glm::dvec2 lateral{(2 * uv.x - 1) * view.range.z, (1 - 2 * uv.y) * view.range.w};
  if (view.info.y) {  // from (lateral, 0) along -z
    return dot(n, glm::dvec3(lateral, 0) - q) / n.z;
  }
  return dot(n, q) / dot(n, glm::dvec3(lateral, -1));
}

// A point that the view sees, at depth z, and a unit normal of the given slope (tangent against the texels)
// and azimuth.
Job make_job(const GpuView& view, glm::dvec2 uv, double z, double slope, double azimuth) {
  const double scale = view.info.y ? 1 : z;
  const glm::dvec3 q((2 * uv.x - 1) * view.range.z * scale, (1 - 2 * uv.y) * view.range.w * scale, -z);
  const glm::dvec2 direction(std::cos(azimuth), std::sin(azimuth));
  // Orthographic: |n.xy| / n.z = slope. Perspective: |n.xy| z / -(n . q) = slope, solved for n.z with |n.xy|
  // = 1.
  const double nz = view.info.y ? 1 / slope : (1 / slope + dot(direction, glm::dvec2(q)) / z);
  const glm::dvec3 n = normalize(glm::dvec3(direction, nz));
  Job job;
  job.q = glm::vec4(glm::vec3(q), 1);
  job.n = glm::vec4(glm::vec3(n), 0);
  return job;
}

std::vector<Job> random_jobs(const std::vector<GpuView>& views, double least_slope, double most_slope,
                             int count) {
  std::mt19937 random(3);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
  std::vector<Job> jobs;
  for (int i = 0; i < count; ++i) {
    const uint32_t view = uint32_t(i) % uint32_t(views.size());
    const double slope = std::exp(uniform(std::log(least_slope), std::log(most_slope)));
    Job job = make_job(views[view], {uniform(0.05, 0.95), uniform(0.05, 0.95)}, uniform(2, 20), slope,
                       uniform(0, 2 * std::numbers::pi));
    job.view = view;
    job.linear = uint32_t(i / int(views.size())) % 2;
    job.offset = {std::round(uniform(-8, 8)), std::round(uniform(-8, 8))};
    jobs.push_back(job);
  }
  return jobs;
}

// Depths at texels are those of the true intersections. Float error: the map position is good to 2 ulp of
// 1024 texels (1.2e-4 texel), the plane's distance from the light, a cancellation, to slope * 8 ulp.
TEST(GpuReceiverPlane, depth_at_texels_is_that_of_the_ray_and_plane_intersection) {
  const std::vector<GpuView> views{perspective_view(), orthographic_view()};
  const auto jobs = random_jobs(views, 0.01, 19.9, 4000);
  const auto answers = planes(views, jobs);
  double worst = 0;
  for (size_t i = 0; i < jobs.size(); ++i) {
    const GpuView& view = views[jobs[i].view];
    const glm::dvec3 q(jobs[i].q), n(jobs[i].n);
    const glm::dvec2 uv = map_position(view, q) + glm::dvec2(jobs[i].offset) / 1024.0;
    const double z = intersect(view, q, n, uv);
    const double texel = 2 * view.range.z * (view.info.y ? 1 : -q.z) / 1024;
    const double moved = answers[i].slope * texel * length(glm::dvec2(jobs[i].offset));
    if (z <= 0 || z > view.range.y || moved > 0.5 * -q.z)
      continue;  // behind the light, or extremely distorted
    constexpr double kUlp = 1.2e-7;
    const double tolerance_z = 8 * kUlp * z + 1.2e-4 * answers[i].slope * texel +
                               16 * kUlp * (1 + answers[i].slope) * std::abs(z + q.z) * z / -q.z;
    const double tolerance = 4 * kUlp + encode_slope(view, z, jobs[i].linear) * tolerance_z;
    EXPECT_NEAR(answers[i].depth, encode(view, z, jobs[i].linear), tolerance)
        << "z " << z << ", slope " << answers[i].slope;
    worst = std::max(worst, std::abs(answers[i].depth - encode(view, z, jobs[i].linear)) / tolerance);
    EXPECT_NEAR(answers[i].z, -q.z, 1e-6 * -q.z);
    EXPECT_NEAR(answers[i].texel[0], map_position(view, q).x * 1024, 2.5e-4);
    EXPECT_NEAR(answers[i].texel[1], map_position(view, q).y * 1024, 2.5e-4);
  }
  RecordProperty("worst_share_of_tolerance", std::to_string(worst));
}

TEST(GpuReceiverPlane, slope_is_the_tangent_against_the_texels_and_is_clamped) {
  for (const GpuView& view : {perspective_view(), orthographic_view()})
    for (const double slope : {0.1, 1.0, 5.0, 19.0, 25.0, 80.0, 400.0}) {
      std::vector<Job> jobs;
      for (int k = 0; k < 8; ++k)
        for (const glm::vec2 offset : {glm::vec2(0), glm::vec2(1, 0), glm::vec2(0, 1)}) {
          jobs.push_back(make_job(view, {0.6, 0.45}, 10, slope, k * 0.7 + 0.1));
          jobs.back().offset = offset;
        }
      const auto answers = planes({view}, jobs);
      for (size_t i = 0; i < jobs.size(); i += 3) {
        const double clamped = std::min(slope, 20.0);
        EXPECT_NEAR(answers[i].slope, clamped, 2e-4 * clamped);
        // Followed along the clamped slope: dz per lateral world unit, from the gradient of post-projective
        // depth per texel.
        const double z = 10, half_x = view.range.z, half_y = view.range.w, scale = view.info.y ? 1 : z;
        const double per_value = 1 / encode_slope(view, z, false);
        const glm::dvec2 dz(per_value * answers[i].gradient[0] * 1024 / (2 * half_x * scale),
                            per_value * answers[i].gradient[1] * 1024 / (2 * half_y * scale));
        EXPECT_NEAR(length(dz), clamped, 2e-4 * clamped);
        // And in the plane's own direction: depth grows where the normal points away from the neighbour.
        const glm::dvec2 normal = normalize(glm::dvec2(jobs[i].n.x, -jobs[i].n.y));
        EXPECT_NEAR(dot(dz / clamped, normal), 1, 1e-3);
      }
    }
}

// A plane in clip space is the plane times the inverse transpose of the projection, whatever that is.
TEST(GpuReceiverPlane, gradient_is_that_of_the_plane_in_clip_space) {
  const std::vector<GpuView> views{perspective_view(), orthographic_view()};
  const auto jobs = random_jobs(views, 0.1, 10, 400);
  const auto answers = planes(views, jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const GpuView& seen = views[jobs[i].view];
    LightView view;
    view.orthographic = seen.info.y != 0;
    view.near = seen.range.x, view.far = seen.range.y;
    view.half_width = seen.range.z, view.half_height = seen.range.w;
    const glm::dvec3 n(jobs[i].n), q(jobs[i].q);
    const glm::dvec4 plane = glm::inverse(glm::transpose(view.clip_from_light())) * glm::dvec4(n, -dot(n, q));
    const glm::dvec2 gradient = -2.0 / 1024 * glm::dvec2(plane) / plane.z;
    const double tolerance = 1e-4 * length(gradient);
    EXPECT_NEAR(answers[i].gradient[0], gradient.x, tolerance);
    EXPECT_NEAR(answers[i].gradient[1], gradient.y, tolerance);
    // And the plane holds the receiver, at its depth.
    const glm::dvec2 at = 2.0 * glm::dvec2(answers[i].texel[0], answers[i].texel[1]) / 1024.0 - 1.0;
    const double depth = -(dot(glm::dvec2(plane), at) + plane.w) / plane.z;
    EXPECT_NEAR(1.0 + answers[i].base, depth, 1e-4);
  }
}

// The plane is moved towards the light, along the axis, by exactly the stated distance at the receiver, and
// by a constant of post-projective depth elsewhere.
TEST(GpuReceiverPlane, bias_shifts_by_world_units) {
  const std::vector<GpuView> views{perspective_view(), orthographic_view()};
  for (const float bias : {1e-3f, 0.02f, 0.3f}) {
    auto plain = random_jobs(views, 0.1, 10, 400);
    for (Job& job : plain) job.offset = {0, 0};
    auto biased = plain;
    for (Job& job : biased) job.bias = bias;
    const auto before = planes(views, plain), after = planes(views, biased);
    for (size_t i = 0; i < plain.size(); ++i) {
      const GpuView& view = views[plain[i].view];
      const double z = -plain[i].q.z;
      const bool linear = plain[i].linear != 0;
      const double tolerance = 1e-6 + 4e-6 * z * encode_slope(view, z - bias, linear);
      EXPECT_NEAR(after[i].depth, encode(view, z - bias, linear), tolerance);
      EXPECT_NEAR(before[i].depth, encode(view, z, linear), tolerance);
      EXPECT_EQ(after[i].gradient[0], before[i].gradient[0]);
      EXPECT_EQ(after[i].gradient[1], before[i].gradient[1]);
      EXPECT_LT(after[i].depth, before[i].depth);
    }
  }
}

// Empty texels hold depth 1: a plane beyond the far distance, or behind the light, must not come out in their
// shadow.
TEST(GpuReceiverPlane, depth_is_at_most_that_of_an_empty_texel) {
  const std::vector<GpuView> views{perspective_view(), orthographic_view()};
  std::vector<Job> jobs;
  for (uint32_t view = 0; view < 2; ++view)
    for (uint32_t linear = 0; linear < 2; ++linear)
      for (int k = 0; k < 16; ++k) {
        Job job = make_job(views[view], {0.5, 0.5}, 49.5, 19, k * std::numbers::pi / 8);
        job.view = view, job.linear = linear;
        job.offset = 400.0f * glm::vec2(std::cos(float(k)), std::sin(float(k)));
        jobs.push_back(job);
      }
  const auto answers = planes(views, jobs);
  int at_far = 0;
  for (const Answer& a : answers) {
    EXPECT_LE(a.depth, 1);
    at_far += a.depth == 1;
  }
  EXPECT_GT(at_far, int(answers.size() / 4));
}

constexpr const char* kDepthKernel = R"(
#include "lib/light_view.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Views { LightView views[]; };
layout(set = 0, binding = 1, std430) readonly buffer Depths { vec2 depths[]; };  // view, z
layout(set = 0, binding = 2, std430) writeonly buffer Answers { vec4 answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= depths.length()) return;
  LightView view = views[int(depths[i].x)];
  float z = depths[i].y;
  float a = encode_linear(view, z), b = encode_perspective(view, 1.0 / z);
  answers[i] = vec4(a, decode_linear(view, a), b, decode_perspective(view, b));
}
)";

// Encode and decode round trips. Linear: some ulp of the far distance. Perspective: an ulp of the encoded
// depth near 1 is a relative error of ulp * z / near in z.
TEST(GpuReceiverPlane, depth_encodings_and_round_trips_up_to_ratio_1e6) {
  std::vector<GpuView> views;
  std::vector<glm::vec2> depths;
  for (const float ratio : {2.0f, 1e2f, 1e4f, 1e6f}) {
    GpuView view;
    view.range.x = 0.05f, view.range.y = 0.05f * ratio;
    for (int k = 0; k <= 50; ++k)
      depths.push_back({float(views.size()), view.range.x * std::pow(ratio, float(k) / 50)});
    views.push_back(view);
  }
  const Kernel kernel("depth", kDepthKernel, 3);
  const auto answers = kernel.run<glm::vec4>({bytes_of(views), bytes_of(depths)}, depths.size());
  constexpr double kUlp = 1.2e-7;
  for (size_t i = 0; i < depths.size(); ++i) {
    const GpuView& view = views[size_t(depths[i].x)];
    const double z = depths[i].y, n = view.range.x, f = view.range.y;
    SCOPED_TRACE("z " + std::to_string(z) + " in " + std::to_string(n) + ".." + std::to_string(f));
    const double span = f / (f - n);  // below 2: the subtractions cost no more than this
    EXPECT_NEAR(answers[i][0], encode(view, z, true), 4 * kUlp * span);
    EXPECT_NEAR(answers[i][2], encode(view, z, false), 4 * kUlp * span);
    EXPECT_NEAR(answers[i][1], z, 4 * kUlp * f);
    EXPECT_NEAR(answers[i][3], z, 4 * kUlp * z * (1 + z / n));
    EXPECT_NEAR(decode(view, answers[i][2], false), z, 4 * kUlp * z * (1 + z / n));
  }
}

constexpr const char* kOctahedralKernel = R"(
#include "lib/octahedral.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Vectors { vec4 vectors[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { vec4 answers[]; };  // two for each vector
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= vectors.length()) return;
  vec2 e = octahedral_encode(vectors[i].xyz);
  answers[2u * i] = vec4(octahedral_decode(e), max(abs(e.x), abs(e.y)));
  answers[2u * i + 1u] = vec4(octahedral_decode(unpackSnorm2x16(packSnorm2x16(e))), 0.0);
}
)";

double angle(glm::dvec3 a, glm::dvec3 b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

// Quantisation moves each coordinate by at most h = 1 / 65534. The vector before normalisation moves by at
// most sqrt(6) h (both coordinates alike, the third by their sum) where it is shortest, 1 / sqrt(3), in the
// middle of an octant: sqrt(18) h = 6.5e-5 rad.
TEST(GpuOctahedral, round_trip_in_float_and_in_16_bit) {
  std::vector<glm::vec4> vectors;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x || y || z) vectors.push_back(glm::vec4(normalize(glm::vec3(x, y, z)), 0));
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  while (vectors.size() < 50000) {
    const glm::vec3 v(normal(random), normal(random), normal(random));
    vectors.push_back(glm::vec4(normalize(v), 0));
  }
  const Kernel kernel("octahedral", kOctahedralKernel, 2);
  const auto answers = kernel.run<glm::vec4>({bytes_of(vectors)}, 2 * vectors.size());
  double worst = 0;
  for (size_t i = 0; i < vectors.size(); ++i) {
    const glm::dvec3 v(vectors[i]);
    EXPECT_LE(answers[2 * i].w, 1.0f + 1e-6f);
    EXPECT_LT(angle(v, glm::dvec3(answers[2 * i])), 1e-6);
    worst = std::max(worst, angle(v, glm::dvec3(answers[2 * i + 1])));
  }
  EXPECT_LT(worst, std::sqrt(18.0) / 65534 + 1e-6);
  EXPECT_GT(worst, 0.5 * std::sqrt(18.0) / 65534);  // it is quantised
}

}  // namespace
}  // namespace gnomon::test
