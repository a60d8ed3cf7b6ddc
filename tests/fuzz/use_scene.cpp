// What is done with a scene: loaded, posed, looked at, traced and written.
#include <algorithm>

#include "engine/light/light_fit.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/scene/animation.h"
#include "engine/truth/reference.h"
#include "tests/fuzz/target.h"
#include "tools/scene_export.h"

namespace gnomon::fuzz {
namespace {

// Larger ones take time and show nothing else.
constexpr uint64_t kMostTriangles = 4096;
constexpr size_t kMostLights = 8;

void look_at(const Scene& scene) {
  for (const Camera& camera : scene.cameras) scene_facts(scene, camera, 16.0 / 9, 9);
  constexpr uint32_t map_size = 64, border = 2;  // texels
  for (const LightView& view : light_views(scene, map_size, border)) area_view(scene, view);
}

}  // namespace

void use_scene(const std::filesystem::path& file) {
  const Scene scene = load_scene(file);
  if (scene.triangles() > kMostTriangles || scene.lights.size() > kMostLights) return;
  look_at(scene);
  to_glb(scene);
  const ReferenceTracer tracer(scene);
  for (const uint32_t samples : {0u, 2u}) tracer.trace({.width = 6, .height = 4, .samples = samples});
  if (!scene.animation) return;
  const double end = duration(*scene.animation);
  for (const double share : {0.3, 1.0}) look_at(posed(scene, share * end));
}

}  // namespace gnomon::fuzz
