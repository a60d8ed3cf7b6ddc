// Ray-traced truth: what every technique is measured against. Embree on the CPU, independent of any GPU
// result.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/scene.h"

namespace gnomon {

// Per camera pixel and light, at pixel centres. Planes are width * height, row 0 at the top.
struct Reference {
  enum : uint8_t {  // domain of one pixel and light (DESIGN, "the domain of the error")
    counted = 0,
    no_geometry = 1,
    faces_away = 2,
    outside_light = 3,
    edge_on = 4  // the geometric normal is at right angles to the light's direction, within least_facing
  };
  // Cosine of the angle to the light below which rounding decides whether a surface faces it: twice the
  // largest error of an octahedral normal of 16 bits (6.5e-5), which the G-buffer rounds the triangle's to
  // once more.
  static constexpr double least_facing = 1.4e-4;

  uint32_t width = 0, height = 0, lights = 0, samples = 1;  // samples per light (1: point, hard)
  std::vector<std::vector<float>>
      visibility;  // [light]: 0 = umbra, 1 = lit; faces_away and edge_on 0, no_geometry 1
  std::vector<std::vector<uint8_t>> domain;  // [light]
  std::vector<float> depth;               // distance along the view axis, world units; infinity: no geometry
  std::vector<glm::vec3> position;        // relative to the camera's eye
  std::vector<glm::vec3> normal;          // geometric, turned to the camera on double-sided meshes
  std::vector<glm::vec3> shading_normal;  // interpolated, unit, on the side of `normal`; zero: no geometry
  std::vector<glm::vec3> albedo;          // linear RGB: base colour factor x texture x COLOR_0
  double noise_floor = 0;                 // standard error of the visibility (area lights), else 0
};

struct ReferenceSettings {
  uint32_t width = 1280, height = 720;
  uint32_t samples =
      0;  // 0: hard shadows of the lights' centres; N: N Owen-scrambled Sobol samples on lights with a size
  uint32_t camera = 0;                   // index into Scene::cameras
  std::function<void(double)> progress;  // 0..1; may be empty
};

class ReferenceTracer {  // keeps the Embree scene, so that several questions can be asked
 public:
  explicit ReferenceTracer(const Scene& scene);
  ~ReferenceTracer();
  ReferenceTracer(ReferenceTracer&&) noexcept;

  Reference trace(const ReferenceSettings& settings) const;

  // For each pixel asked: is every point of the receiver's tangent plane within `texels` shadow texels lit
  // (value 1) or unlit (value 0) like the pixel itself in the reference? Tested on a grid of half-texel
  // spacing (whole texels when texels > 4) on the plane through the pixel's position, spanned by the light's
  // map axes, with map_size texels a side of the light's map face. Used by acne (texels = 2) and light leak
  // (texels = 16). `pixels`: indices y * width + x.
  std::vector<bool> away_from_edges(const Reference& reference, uint32_t light, const Camera& camera,
                                    const std::vector<uint32_t>& pixels, double texels,
                                    uint32_t map_size) const;

  struct Impl;  // internal: engine/truth/reference_tracer.h

 private:
  std::unique_ptr<Impl> impl_;
};

// EXR with channels Y, light1.Y, ... (visibility), Z (depth), N.x N.y N.z, P.x P.y P.z, Ns.x Ns.y Ns.z
// (shading normal), albedo.R albedo.G albedo.B, domain, light1.domain, ..., and the constant planes samples
// and noise_floor.
Image to_image(const Reference& reference);
Reference reference_from_image(const Image& image, const std::filesystem::path& file_for_errors);

// Key of everything the reference depends on: scene bytes, view, lights, size, samples, tracer version.
std::string reference_key(const Scene& scene, const ReferenceSettings& settings);
// Traces, or reads `cache/<key>.exr` when it is there.
Reference cached_reference(const Scene& scene, const ReferenceSettings& settings,
                           const std::filesystem::path& cache);

}  // namespace gnomon
