// gnomon reference: the ray-traced truth as an EXR.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "bench/run/progress.h"
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "engine/scene/animation.h"
#include "engine/scene/camera.h"
#include "engine/truth/reference.h"
#include "tools/cli.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

constexpr uint32_t kMaxSamples = 1 << 20;

struct Options {
  std::string scene, size = "1280x720";
  std::filesystem::path out;
  uint32_t samples = 0, camera = 0;
  double time = 0, light_scale = 1;
};

void reference_command(const Options& options) {
  ReferenceSettings settings;
  const Extent size = parse_size(options.size);
  settings.width = size.width;
  settings.height = size.height;
  settings.samples = options.samples;
  settings.camera = options.camera;
  if (options.out.extension() != ".exr")
    fail("the file's name must end in .exr", options.out.string(), "--out");
  if (options.samples > kMaxSamples)
    fail(fmt::format("{} samples: at most {}", options.samples, kMaxSamples), {}, "--samples");
  if (!std::isfinite(options.time)) fail("the time is not a finite number", {}, "--time");
  auto scene = open_scene(options.scene, options.light_scale);
  if (scene->animation) scene = std::make_shared<const Scene>(posed(*scene, options.time));
  const Camera& camera = camera_of(*scene, options.camera);
  if (const std::string told = aspect_warning(camera, double(size.width) / size.height); !told.empty())
    warn(told);
  Progress progress("reference " + scene->name, 5);
  settings.progress = [&](double share) { progress.update(share); };
  const Reference reference = ReferenceTracer(*scene).trace(settings);
  progress.done();
  if (options.out.has_parent_path()) std::filesystem::create_directories(options.out.parent_path());
  write_exr(options.out, to_image(reference));
  print("{}: {}x{}, {} light{}, {} sample{} each, noise floor {:.2g}\n", options.out.string(),
        reference.width, reference.height, reference.lights, reference.lights == 1 ? "" : "s",
        reference.samples, reference.samples == 1 ? "" : "s", reference.noise_floor);
}

}  // namespace

void add_reference(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("reference", "trace the visibility on the CPU (Embree) and write it as EXR");
  command
      ->add_option("SCENE", options->scene, "a .glb or .gltf file, or the name of a scene in assets/scenes")
      ->required();
  command->add_option("--out", options->out, "the EXR to write")->required()->type_name("FILE.exr");
  command->add_option("--size", options->size, "pixels")->type_name("WxH")->capture_default_str();
  command
      ->add_option("--samples", options->samples,
                   "samples on each area light; 0: hard shadows of the lights' centres")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--camera", options->camera, "index of the scene's camera")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option(
          "--time", options->time,
          "seconds of the scene's animations; before the first and after the last key frame nothing moves")
      ->type_name("S")
      ->capture_default_str();
  add_light_scale(*command, options->light_scale);
  command->footer(
      R"(Channels: Y, light1.Y, ... visibility (0 umbra, 1 lit); domain, light1.domain, ... 0 where the
error is counted, 1 no geometry, 2 faces away, 3 outside the light, 4 edge-on to the light; Z depth along the
view axis, P position relative to the eye, N geometric normal (world units).

Example:
  gnomon reference fence --size 640x360 --out fence.exr)");
  command->callback([options, &status] {
    reference_command(*options);
    status = exit_done;
  });
}

}  // namespace gnomon
