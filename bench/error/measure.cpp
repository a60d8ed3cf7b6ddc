// The error of one rendered image against the ray-traced reference, with acne and leak.
#include "bench/error/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "bench/error/error_fields.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
using OptionalFigure = std::optional<double> ErrorMetrics::*;
using Figure = double ErrorMetrics::*;

constexpr Figure kFigures[] = {&ErrorMetrics::rmse,
                               &ErrorMetrics::mae,
                               &ErrorMetrics::max,
                               &ErrorMetrics::bias,
                               &ErrorMetrics::misclassified,
                               &ErrorMetrics::wrongly_lit,
                               &ErrorMetrics::wrongly_shadowed};
constexpr OptionalFigure kOptionalFigures[] = {
    &ErrorMetrics::penumbra_rmse, &ErrorMetrics::umbra_light, &ErrorMetrics::leak, &ErrorMetrics::over_shadow,
    &ErrorMetrics::acne,          &ErrorMetrics::ssim,        &ErrorMetrics::flip};

std::optional<double> mean_of(const std::vector<const LightError*>& lights, OptionalFigure field) {
  double sum = 0;
  size_t count = 0;
  for (const LightError* m : lights)
    if (m->*field) sum += *(m->*field), ++count;
  return count ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

double mean_of(const std::vector<const LightError*>& lights, Figure field) {
  double sum = 0;
  for (const LightError* m : lights) sum += m->*field;
  return lights.empty() ? kNan : sum / static_cast<double>(lights.size());
}

// KHR_lights_punctual, "inner and outer cone angles".
double spot_falloff(const Light& light, double cosine) {
  const double outer = std::cos(light.outer_cone);
  const double scale = 1 / std::max(0.001, std::cos(light.inner_cone) - outer);
  const double falloff = std::clamp((cosine - outer) * scale, 0.0, 1.0);
  return falloff * falloff;
}

// KHR_lights_punctual, "range property".
double range_window(const Light& light, double distance) {
  return light.range ? std::clamp(1 - std::pow(distance / *light.range, 4), 0.0, 1.0) : 1.0;
}

// Irradiance per unit of the light's colour, unshadowed. `position` relative to the camera's eye.
double irradiance(const Light& light, const glm::dvec3& eye, const glm::dvec3& position,
                  const glm::dvec3& normal) {
  const glm::dvec3 backward = glm::normalize(glm::dvec3(light.world_from_light[2]));
  if (light.type == LightType::directional)
    return light.intensity * std::max(0.0, glm::dot(normal, backward));
  const glm::dvec3 to_light = (glm::dvec3(light.world_from_light[3]) - eye) - position;
  const double distance = glm::length(to_light);
  if (!(distance > 0)) return 0;
  const glm::dvec3 direction = to_light / distance;
  double intensity = light.intensity * range_window(light, distance) / (distance * distance);
  if (light.type == LightType::spot) intensity *= spot_falloff(light, glm::dot(direction, backward));
  return intensity * std::max(0.0, glm::dot(normal, direction));
}

constexpr double kMostDeepSamples = 8192;  // an even sample of the umbra: each costs hundreds of rays

std::optional<double> mean_over(std::span<const float> result, const std::vector<uint32_t>& pixels) {
  double sum = 0;
  for (const uint32_t i : pixels) sum += result[i];
  return pixels.empty() ? std::nullopt : std::optional(sum / static_cast<double>(pixels.size()));
}

}  // namespace

LightError over_lights(const std::vector<LightError>& lights) {
  LightError all;
  std::vector<const LightError*> used;
  for (const LightError& m : lights) {
    all.pixels += m.pixels;
    all.excluded += m.excluded;
    all.nonfinite += m.nonfinite;
    all.out_of_range += m.out_of_range;
    if (m.pixels > 0 || m.nonfinite > 0) used.push_back(&m);
  }
  for (const Figure field : kFigures) all.*field = mean_of(used, field);
  for (const OptionalFigure field : kOptionalFigures) all.*field = mean_of(used, field);
  for (const LightError* m : used)
    if (!std::isnan(all.max)) all.max = std::max(all.max, m->max);
  if (all.pixels == 0 && !lights.empty()) all.reason = lights.front().reason;
  return all;
}

std::string why_none_counts(std::span<const uint8_t> domain) {
  struct Kind {
    uint8_t domain;
    const char* what;
  };
  constexpr Kind kinds[] = {{Reference::faces_away, "face away from the light"},
                            {Reference::outside_light, "lie outside of what it shines on"},
                            {Reference::no_geometry, "show no geometry"}};
  const auto count = [&](uint8_t kind) { return std::count(domain.begin(), domain.end(), kind); };
  if (count(Reference::counted) > 0) return {};
  std::string text = "no pixel counts";
  const char* before = ": ";
  for (const auto& [kind, what] : kinds)
    if (const auto pixels = count(kind); pixels > 0)
      text += fmt::format("{}{} {}", std::exchange(before, ", "), pixels, what);
  return text;
}

std::string visibility_channel(uint32_t light) { return light == 0 ? "Y" : fmt::format("light{}.Y", light); }

double measure_acne(std::span<const float> result, const Reference& reference, uint32_t light,
                    const EdgeSettings& edges) {
  std::vector<uint32_t> suspects;
  uint64_t counted = 0;
  for (uint32_t i = 0; i < result.size(); ++i) {
    if (reference.domain[light][i] != Reference::counted) continue;
    ++counted;
    if (result[i] < 0.5f && reference.visibility[light][i] == 1) suspects.push_back(i);
  }
  const auto away = edges.tracer->away_from_edges(reference, light, edges.camera, suspects, edges.acne_texels,
                                                  edges.map_size);
  const auto wrong = std::count(away.begin(), away.end(), true);
  return counted ? static_cast<double>(wrong) / static_cast<double>(counted) : kNan;
}

std::vector<uint32_t> deep_umbra(const Reference& reference, uint32_t light, const EdgeSettings& edges) {
  std::vector<uint32_t> umbra, sample, deep;
  for (uint32_t i = 0; i < reference.visibility[light].size(); ++i)
    if (reference.domain[light][i] == Reference::counted && reference.visibility[light][i] == 0)
      umbra.push_back(i);
  const double step = std::max(1.0, static_cast<double>(umbra.size()) / kMostDeepSamples);
  for (double k = 0; k < static_cast<double>(umbra.size()); k += step)
    sample.push_back(umbra[static_cast<size_t>(k)]);
  const auto away = edges.tracer->away_from_edges(reference, light, edges.camera, sample, edges.leak_texels,
                                                  edges.map_size);
  for (size_t k = 0; k < sample.size(); ++k)
    if (away[k]) deep.push_back(sample[k]);
  return deep;
}

MeasuredError measure_visibility(const Image& visibility, const Reference& reference,
                                 const EdgeSettings& edges, std::span<const std::vector<uint32_t>> deep) {
  if (visibility.width != reference.width || visibility.height != reference.height)
    fail(fmt::format("the result has {} x {} pixels, the reference {} x {}", visibility.width,
                     visibility.height, reference.width, reference.height));
  MeasuredError error;
  for (uint32_t i = 0; i < reference.lights; ++i) {
    const auto result = visibility.plane(visibility_channel(i));
    LightError m{compare_visibility(result, reference.visibility[i], reference.domain[i], reference.width,
                                    reference.height),
                 why_none_counts(reference.domain[i])};
    const bool measurable = m.nonfinite == 0 && m.pixels > 0;
    if (edges.tracer && m.nonfinite > 0) m.acne = kNan;
    if (edges.tracer && measurable) m.acne = measure_acne(result, reference, i, edges);
    if (i < deep.size() && measurable) m.leak = mean_over(result, deep[i]);
    error.lights.push_back(m);
  }
  error.all = over_lights(error.lights);
  return error;
}

Image shade_reference(const Scene& scene, const Camera& camera, const Reference& reference,
                      const Ambient& ambient) {
  if (scene.lights.size() != reference.lights)
    fail(fmt::format("the reference has {} lights, the scene {}", reference.lights, scene.lights.size()),
         scene.file.string());
  Image image(reference.width, reference.height, {"R", "G", "B"});
  const glm::dvec3 eye(camera.world_from_camera[3]);
  const glm::dvec3 sky = sky_radiance(scene, ambient);
  for (size_t i = 0; i < reference.depth.size(); ++i) {
    if (std::isinf(reference.depth[i])) {
      for (int c = 0; c < 3; ++c) image.plane(c)[i] = static_cast<float>(sky[c]);
      continue;
    }
    glm::dvec3 sum = hemisphere_irradiance(double{reference.shading_normal[i].y}, ambient.ground) * sky;
    for (uint32_t k = 0; k < reference.lights; ++k)
      if (const double visibility = reference.visibility[k][i]; visibility > 0)
        sum += visibility * scene.lights[k].color *
               irradiance(scene.lights[k], eye, glm::dvec3(reference.position[i]),
                          glm::dvec3(reference.shading_normal[i]));
    const glm::dvec3 radiance = glm::dvec3(reference.albedo[i]) / std::numbers::pi * sum;
    for (int c = 0; c < 3; ++c) image.plane(c)[i] = static_cast<float>(radiance[c]);
  }
  return image;
}

nlohmann::json to_json(const MeasuredError& error) { return FieldWriter::written(error); }

}  // namespace gnomon
