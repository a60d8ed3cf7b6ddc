// The screen-space kernel, against rays and planes in double precision.
#include <gtest/gtest.h>

#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::test {
namespace {

struct Job {
  glm::mat4 clip;
  glm::vec4 p, n, light;  // light.w: 1 when directional
  glm::vec4 x, y;         // w of x: offset along x; of y: along y
};

constexpr const char* kKernel = R"(
#include "lib/light_parallel.glsl"
layout(local_size_x = 64) in;
struct Job { mat4 clip; vec4 p, n, light, x, y; };
layout(set = 0, binding = 0, std430) readonly buffer Jobs { Job jobs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { vec4 answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= jobs.length()) return;
  Job j = jobs[i];
  ParallelImage image = parallel_image(j.clip, vec2(640.0, 360.0), j.p.xyz, j.n.xyz, j.light.xyz, j.light.w != 0.0, j.x.xyz, j.y.xyz);
  vec2 place;
  bool seen = parallel_place(image, vec2(j.x.w, j.y.w), place);
  answers[i] = vec4(place, seen ? 1.0 : 0.0, 0.0);
}
)";

TEST(LightParallel, ShowsWhereTheRayMeetsTheTangentPlane) {
  std::mt19937 engine(5);
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const glm::dmat4 clip = glm::perspective(1.0, 640.0 / 360.0, 0.1, 100.0);
  std::vector<Job> jobs;
  std::vector<glm::dvec2> wanted;
  while (jobs.size() < 400) {
    const glm::dvec3 p(any(-2, 2), any(-1, 1), any(-8, -5)), light(any(-3, 3), any(4, 8), any(-6, -2));
    const glm::dvec3 n = glm::normalize(glm::dvec3(any(-0.5, 0.5), 1, any(-0.5, 0.5)));
    const bool directional = jobs.size() % 3 == 0;
    const glm::dvec3 way = directional ? glm::normalize(glm::dvec3(any(-0.5, 0.5), -1, any(-0.5, 0.5)))
                                       : glm::normalize(p - light);
    const glm::dvec3 x = glm::normalize(glm::cross(way, glm::dvec3(0, 0, 1))), y = glm::cross(x, way);
    const glm::dvec2 o(any(-0.5, 0.5), any(-0.5, 0.5));
    const glm::dvec3 moved = p + o.x * x + o.y * y, ray = directional ? way : moved - light;
    const glm::dvec3 met = moved + ray * (glm::dot(n, p - moved) / glm::dot(n, ray));
    const glm::dvec4 place = clip * glm::dvec4(met, 1);
    if (place.w <= 0.5) continue;
    wanted.push_back((0.5 + 0.5 * glm::dvec2(place) / place.w) * glm::dvec2(640, 360));
    jobs.push_back({glm::mat4(clip), glm::vec4(p, 1), glm::vec4(n, 0),
                    glm::vec4(directional ? way : light, directional ? 1.0f : 0.0f), glm::vec4(x, o.x),
                    glm::vec4(y, o.y)});
  }
  const Kernel kernel("light_parallel", kKernel, 2);
  const auto answers = kernel.run<glm::vec4>({bytes_of(jobs)}, jobs.size());
  for (size_t i = 0; i < jobs.size(); ++i) {
    ASSERT_EQ(answers[i].z, 1.0f) << i;
    ASSERT_NEAR(answers[i].x, wanted[i].x, 0.01) << i;  // pixels
    ASSERT_NEAR(answers[i].y, wanted[i].y, 0.01) << i;
  }
}

}  // namespace
}  // namespace gnomon::test
