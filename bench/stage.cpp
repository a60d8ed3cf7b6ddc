#include "bench/stage.h"

#include <fmt/format.h>

#include "bench/truth.h"
#include "engine/error.h"
#include "engine/image.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using Tell = std::function<void(double, const std::string&)>;

class DeviceSubject final : public Subject {
 public:
  explicit DeviceSubject(Renderer renderer) : renderer_(std::move(renderer)) {}
  FrameTiming render(TimingMode mode) override { return renderer_.render(mode); }
  Renderer& renderer() { return renderer_; }

 private:
  Renderer renderer_;
};

class DeviceStage final : public Stage {
 public:
  DeviceStage(std::shared_ptr<Device> device, std::shared_ptr<const Scene> scene,
              const RenderSettings& settings, Truth truth)
      : device_(std::move(device)), scene_(std::move(scene)), settings_(settings), truth_(std::move(truth)) {}

  std::unique_ptr<Subject> open(const SuiteConfig& config) override {
    return std::make_unique<DeviceSubject>(Renderer(device_, scene_, config.graph, settings_));
  }

  void finish(const SuiteConfig& config, Subject& subject, Row& row) override {
    Renderer& renderer = dynamic_cast<DeviceSubject&>(subject).renderer();
    describe_renderer(row, renderer);
    for (const std::string& message : scene_->warnings.messages) row.warnings.push_back(message);
    const Image visibility = renderer.read("visibility");
    Image color;
    const bool shaded = config.graph.outputs.count("color") != 0;
    if (shaded) color = renderer.read("color");
    row.nonfinite = count_nonfinite(visibility) + count_nonfinite(color);
    const bool finite_color = shaded && count_nonfinite(color) == 0;
    row.error_json = truth_.error_json(visibility, finite_color ? &color : nullptr, config.graph.vars);
  }

 private:
  std::shared_ptr<Device> device_;
  std::shared_ptr<const Scene> scene_;
  RenderSettings settings_;
  Truth truth_;
};

}  // namespace

StageMaker device_stages(const std::shared_ptr<Device>& device, const fs::path& cache, const Tell& progress) {
  return [=](const Suite& suite, const fs::path& file, Extent size) -> std::unique_ptr<Stage> {
    auto scene = std::make_shared<const Scene>(load_scene(file));
    if (suite.camera >= scene->cameras.size())
      fail(fmt::format("camera {} does not exist: the scene has {}", suite.camera, scene->cameras.size()),
           file.string());
    ReferenceSettings reference;
    reference.width = size.width;
    reference.height = size.height;
    reference.samples = suite.samples;
    reference.camera = suite.camera;
    if (progress)
      reference.progress = [=](double share) {
        progress(share, fmt::format("{}: reference {:.0f} %", scene->name, 100 * share));
      };
    RenderSettings settings;
    settings.width = size.width;
    settings.height = size.height;
    settings.camera = suite.camera;
    return std::make_unique<DeviceStage>(device, scene, settings, Truth(scene, reference, cache));
  };
}

}  // namespace gnomon
