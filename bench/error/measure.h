// The error of one rendered image against the ray-traced reference.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/light/ambient.h"
#include "engine/scene/scene.h"
#include "engine/truth/metrics.h"
#include "engine/truth/reference.h"

namespace gnomon {

// "Y", "light1.Y", ...: a light's channel of a visibility image.
std::string visibility_channel(uint32_t light);

struct LightError : ErrorMetrics {
  std::string reason;  // why no pixel counts; empty where some do
};

// The `error` object of a result row.
struct MeasuredError {
  std::vector<LightError> lights;  // one per light of the reference
  // Over the lights: counts are summed, `max` is the largest, the rest are means over the lights with counted
  // pixels (NaN when there are none, or when any light has non-finite results).
  LightError all;
  std::optional<std::map<std::string, std::array<double, 2>>> intervals;  // error_intervals()
  std::optional<double> reference_noise;  // of soft shadows: Reference::noise_floor
  std::optional<double> flicker;          // of a sequence's frame: mean over the lights
};
// The means and sums over the lights.
LightError over_lights(const std::vector<LightError>& lights);

// "no pixel counts: 12 face away from the light, 3 lie outside its map, 85 show no geometry"; empty when some
// pixel of the domain (Reference::domain) counts.
std::string why_none_counts(std::span<const uint8_t> domain);

// What acne and leak need beyond the two images. Without a tracer they are absent.
struct EdgeSettings {
  const ReferenceTracer* tracer = nullptr;  // of the scene that the reference shows
  Camera camera;                            // that the reference was traced with
  uint32_t map_size = 1024;                 // texels a side of the shadow map
  double acne_texels = 2;                   // acne is further than this from any true edge,
  double leak_texels = 16;                  // leak further than this
};

// `visibility` as Renderer::read gives it: channels "Y", "light1.Y", ... Error when a channel is missing or
// the size differs. `deep`: of each light, the pixels that leak is measured over, from deep_umbra().
MeasuredError measure_visibility(const Image& visibility, const Reference& reference,
                                 const EdgeSettings& edges = {},
                                 std::span<const std::vector<uint32_t>> deep = {});

// Pixels in umbra further than edges.leak_texels from any true edge on the receiver's plane, of an even
// sample of at most 8192 pixels in umbra: where light is leak, not filtering. Depends on the reference alone.
std::vector<uint32_t> deep_umbra(const Reference& reference, uint32_t light, const EdgeSettings& edges);

// Share of counted pixels that are wrongly shadowed (result < 0.5, reference 1) further than
// edges.acne_texels from any true edge on the receiver's plane.
double measure_acne(std::span<const float> result, const Reference& reference, uint32_t light,
                    const EdgeSettings& edges);

// The image that perfect visibility gives: albedo / pi x sum over lights of irradiance x visibility, linear
// RGB without ambient, black where there is no geometry. Lambert with the interpolated normal; spot falloff
// and range as in KHR_lights_punctual. `camera`: that the reference was traced with.
Image shade_reference(const Scene& scene, const Camera& camera, const Reference& reference,
                      const Ambient& ambient = {});

// `all`, and each light of `lights`. Metrics that do not apply are left out; NaN becomes null.
nlohmann::json to_json(const MeasuredError& error);

}  // namespace gnomon
