// Traces a scene's visibility and shading, pixel by pixel.
#include "engine/truth/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/sobol.h"
#include "engine/scene/area_light.h"
#include "engine/scene/wide_spot.h"
#include "engine/truth/reference_light.h"
#include "engine/truth/reference_tracer.h"

namespace gnomon {
namespace {

constexpr uint32_t kMaxSide = 1u << 15;
constexpr uint32_t kMaxSamples = 1u << 20;

// Rays through pixel centres; their parameter is the distance along the view axis.
struct PrimaryRays {
  glm::dvec3 eye{0};  // relative to the scene's origin
  glm::dvec3 right{0}, up{0}, forward{0};
  double tan_x = 1, tan_y = 1, near = 0, far = 0;  // half width and height of an orthographic camera's image
  uint32_t width = 1, height = 1;
  bool parallel = false;  // orthographic

  PrimaryRays(const Camera& camera, const glm::dvec3& origin, uint32_t w, uint32_t h)
      : near(camera.near),
        far(camera.far.value_or(std::numeric_limits<double>::infinity())),
        width(w),
        height(h),
        parallel(camera.span.has_value()) {
    eye = glm::dvec3(camera.world_from_camera[3]) - origin;
    right = glm::dvec3(camera.world_from_camera[0]);
    up = glm::dvec3(camera.world_from_camera[1]);
    forward = -glm::dvec3(camera.world_from_camera[2]);
    const double aspect = static_cast<double>(w) / h;
    tan_y = half_extent(camera, aspect).y;
    tan_x = tan_y * aspect;
  }
  struct Ray {
    glm::dvec3 start, direction;
  };
  Ray at(uint32_t x, uint32_t y) const {
    const double sx = 2 * (x + 0.5) / width - 1, sy = 1 - 2 * (y + 0.5) / height;
    const glm::dvec3 across = sx * tan_x * right + sy * tan_y * up;
    if (parallel) return {eye + across, forward};
    return {eye, forward + across};
  }
};

// Is a point inside what the light shines on: its cone and square map frustum (spot), its range (spot,
// point)?
bool inside_light(const Light& light, const glm::dvec3& from_light) {
  if (light.type == LightType::directional) return true;
  const double distance = glm::length(from_light);
  if (light.range && distance > *light.range) return false;
  if (light.type == LightType::point) return true;
  const glm::dvec3 p = glm::transpose(glm::dmat3(light.world_from_light)) * from_light;  // rigid
  const double depth = -p.z, half = std::tan(0.5 * light.map_fov) * depth;
  const bool framed = depth > 0 && std::abs(p.x) <= half && std::abs(p.y) <= half;
  if (!framed && !is_cut(light)) return false;
  return std::atan2(std::hypot(p.x, p.y), depth) <= light.outer_cone;
}

// Squared differences of two half sets of samples.
struct NoiseSum {
  double sum = 0;
  uint64_t count = 0;
};

// How many Sobol points a pixel needs at most, roughly: those of a polygon's bounding rectangle that are not
// on it are skipped.
uint32_t table_size(const Scene& scene, uint32_t samples) {
  double needed = samples;
  for (const Light& light : scene.lights)
    if (is_area(light, samples) && light.area->shape == AreaLight::Shape::polygon)
      needed = std::max(needed, 1.1 * samples / std::max(coverage(*light.area), kLeastCoverage));
  return static_cast<uint32_t>(std::min<double>(needed, kMaxSamples));
}

class PixelShader {
 public:
  PixelShader(const Scene& scene, const RayScene& rays, uint32_t samples)
      : scene_(scene), rays_(rays), samples_(samples), sobol_(table_size(scene, samples)) {
    for (const Light& light : scene.lights)
      areas_.push_back(is_area(light, samples)
                           ? std::optional<AreaSampler>(std::in_place, scene, light, centre_of(light, rays))
                           : std::nullopt);
  }

  void shade(Reference& result, const SurfaceHit& hit, size_t pixel, NoiseSum& noise) const {
    for (uint32_t i = 0; i < result.lights; ++i) {
      const Light& light = scene_.lights[i];
      const ShadowTarget centre = centre_of(light, rays_);
      const glm::dvec3 to_light = centre.infinite ? centre.value : centre.value - hit.position;
      uint8_t& domain = result.domain[i][pixel];
      float& visibility = result.visibility[i][pixel];
      const double facing = glm::dot(hit.normal, glm::normalize(to_light));
      if (!(facing >= Reference::least_facing)) {
        domain = facing > -Reference::least_facing ? Reference::edge_on : Reference::faces_away;
        visibility = 0;
        continue;
      }
      domain = inside_light(light, -to_light) ? Reference::counted : Reference::outside_light;
      if (areas_[i]) {
        visibility = area_visibility(*areas_[i], hit, static_cast<uint32_t>(pixel), i, noise);
      } else {
        visibility = rays_.occluded(hit.position, hit.normal, centre, hit.triangle) ? 0.0f : 1.0f;
      }
    }
  }

 private:
  // Share of the light's emission, by luminance, that reaches a surface point.
  float area_visibility(const AreaSampler& light, const SurfaceHit& hit, uint32_t pixel, uint32_t light_index,
                        NoiseSum& noise) const {
    const AreaView view = light.seen_from(hit.position);
    if (view.surrounds()) return 1;
    const uint32_t seed = hash_combine(hash_combine(0x5bd1e995u, pixel), light_index);
    const uint32_t half = samples_ / 2;
    double all[2] = {0, 0}, lit[2] = {0, 0};  // emission of either half of the samples
    uint32_t lit_count = 0;
    glm::dvec3 targets[RayScene::packet];
    double weight[RayScene::packet];
    bool later[RayScene::packet];  // of the second half
    int count = 0;
    const auto flush = [&] {
      if (count == 0) return;
      const uint32_t mask =
          rays_.occluded(hit.position, hit.normal, targets, count, view.infinite(), hit.triangle);
      for (int k = 0; k < count; ++k) {
        if ((mask >> k & 1) != 0) continue;
        lit[later[k]] += weight[k];
        ++lit_count;
      }
      count = 0;
    };
    for (uint32_t i = 0, taken = 0; taken < samples_; ++i) {
      const std::optional<LightSample> sample = view.sample(sobol_.scrambled(i, seed));
      if (!sample) continue;  // not on the light
      const bool second = taken++ >= half;
      all[second] += sample->weight;
      const glm::dvec3 to_sample = view.infinite() ? sample->target : sample->target - hit.position;
      if (!(glm::dot(hit.normal, to_sample) > 0)) continue;  // behind the surface: unlit
      targets[count] = sample->target;
      weight[count] = sample->weight;
      later[count++] = second;
      if (count == RayScene::packet) flush();
    }
    flush();
    if (all[0] + all[1] == 0)
      return static_cast<float>(double(lit_count) / samples_);  // only black parts met
    const double total = lit[0] + lit[1], most = all[0] + all[1];
    if (all[0] > 0 && all[1] > 0 && total > 0 && lit_count < samples_) {
      const double difference = lit[0] / all[0] - lit[1] / all[1];
      noise.sum += 0.25 * difference * difference;
      ++noise.count;
    }
    return static_cast<float>(total / most);
  }

  const Scene& scene_;
  const RayScene& rays_;
  uint32_t samples_;
  SobolPoints sobol_;
  std::vector<std::optional<AreaSampler>> areas_;  // by light; nothing: a point
};

Reference empty_reference(uint32_t width, uint32_t height, uint32_t lights) {
  Reference r;
  r.width = width, r.height = height, r.lights = lights;
  const size_t size = size_t{width} * height;
  r.visibility.assign(lights, std::vector<float>(size, 1.0f));
  r.domain.assign(lights, std::vector<uint8_t>(size, Reference::no_geometry));
  r.depth.assign(size, std::numeric_limits<float>::infinity());
  r.position.assign(size, glm::vec3(0));
  r.normal.assign(size, glm::vec3(0));
  r.shading_normal.assign(size, glm::vec3(0));
  r.albedo.assign(size, glm::vec3(0));
  return r;
}

void store_surface(Reference& r, const SurfaceHit& hit, const glm::dvec3& eye, size_t pixel) {
  r.depth[pixel] = static_cast<float>(hit.distance);
  r.position[pixel] = glm::vec3(hit.position - eye);
  r.normal[pixel] = glm::vec3(hit.normal);
  r.shading_normal[pixel] = hit.shading_normal;
  r.albedo[pixel] = hit.albedo;
}

void check_settings(const Scene& scene, const ReferenceSettings& s) {
  if (s.width == 0 || s.height == 0 || s.width > kMaxSide || s.height > kMaxSide)
    fail(fmt::format("cannot trace {} x {} pixels: 1 to {} a side", s.width, s.height, kMaxSide));
  if (s.camera >= scene.cameras.size())
    fail(fmt::format("no camera {}: the scene has {}", s.camera, scene.cameras.size()), scene.file.string());
  if (s.samples > kMaxSamples) fail(fmt::format("{} samples: at most {}", s.samples, kMaxSamples));
}

// Standard error of the visibility in penumbrae. A half set's error is sqrt(2) that of the whole set at
// least, and the halves of a Sobol set are anti-correlated if anything: half their RMS difference bounds the
// whole's error from above.
double noise_floor(const std::vector<NoiseSum>& rows, bool any_area, uint32_t samples) {
  if (!any_area) return 0;
  if (samples < 2) return 0.5;  // one sample is 0 or 1: the standard deviation is at most this
  NoiseSum all;
  for (const NoiseSum& row : rows) all.sum += row.sum, all.count += row.count;
  return all.count ? std::sqrt(all.sum / static_cast<double>(all.count)) : 0.0;
}

}  // namespace

bool is_area(const Light& light, uint32_t samples) { return samples > 0 && has_size(light); }

std::shared_ptr<const RayScene> ReferenceTracer::Impl::rays_of(const Camera& camera) const {
  const glm::dvec3 eye(camera.world_from_camera[3]);
  const std::lock_guard lock(mutex_);
  if (!rays_ || rays_->origin() != eye) rays_ = std::make_shared<const RayScene>(scene, eye);
  return rays_;
}

ShadowTarget centre_of(const Light& light, const RayScene& rays) {
  if (light.type == LightType::directional)
    return {glm::normalize(glm::dvec3(light.world_from_light[2])), true};
  return {glm::dvec3(light.world_from_light[3]) - rays.origin(), false};
}

ReferenceTracer::ReferenceTracer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
ReferenceTracer::~ReferenceTracer() = default;
ReferenceTracer::ReferenceTracer(ReferenceTracer&&) noexcept = default;

Reference ReferenceTracer::trace(const ReferenceSettings& settings) const {
  const Scene& scene = impl_->scene;
  check_settings(scene, settings);
  const bool any_area = std::any_of(scene.lights.begin(), scene.lights.end(),
                                    [&](const Light& light) { return is_area(light, settings.samples); });
  Reference result =
      empty_reference(settings.width, settings.height, static_cast<uint32_t>(scene.lights.size()));
  result.samples = any_area ? settings.samples : 1;
  const Camera& camera = scene.cameras[settings.camera];
  const std::shared_ptr<const RayScene> rays = impl_->rays_of(camera);
  const PrimaryRays primary(camera, rays->origin(), settings.width, settings.height);
  const PixelShader shader(scene, *rays, any_area ? settings.samples : 0);
  std::vector<NoiseSum> noise(settings.height);
  parallel_rows(settings.height, settings.progress, [&](uint32_t y) {
    for (uint32_t x = 0; x < settings.width; ++x) {
      const PrimaryRays::Ray ray = primary.at(x, y);
      const auto hit = rays->first_hit(ray.start, ray.direction, primary.near);
      if (!hit || hit->distance > primary.far) continue;
      const size_t pixel = size_t{y} * settings.width + x;
      store_surface(result, *hit, primary.eye, pixel);
      shader.shade(result, *hit, pixel, noise[y]);
    }
  });
  result.noise_floor = noise_floor(noise, any_area, settings.samples);
  return result;
}

}  // namespace gnomon
