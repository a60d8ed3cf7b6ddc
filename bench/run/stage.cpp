// The harness' stage on a Vulkan device: renderers and references of one scene and size.
#include "bench/run/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "bench/error/truth.h"
#include "bench/report/report_images.h"
#include "bench/run/sequence.h"
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "engine/scene/animation.h"
#include "engine/scene/area_light.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using Tell = std::function<void(double, const std::string&)>;

class DeviceSubject final : public Subject {
 public:
  explicit DeviceSubject(Renderer renderer) : renderer_(std::move(renderer)) {}
  FrameTiming render(TimingMode mode) override { return renderer_.render(mode); }
  void play() override { renderer_.play(); }
  Renderer& renderer() { return renderer_; }

  // What is measured: of a sequence its last frame, kept when it was shown.
  struct Shown {
    Image visibility;
    std::optional<Image> color;
    uint64_t nonfinite = 0;  // of a sequence's earlier frames' visibility too
  };
  void show(const SuiteConfig& config) {
    shown_.visibility = renderer_.read("visibility");
    if (config.graph.outputs.count("color") != 0) shown_.color = renderer_.read("color");
    shown_.nonfinite += count_nonfinite(shown_.visibility);
    if (shown_.color) shown_.nonfinite += count_nonfinite(*shown_.color);
  }
  Shown& shown() { return shown_; }
  SequenceResult sequence;

 private:
  Renderer renderer_;
  Shown shown_;
};

bool keeps_history(const std::vector<GraphNode>& nodes) {
  return std::any_of(nodes.begin(), nodes.end(), [](const GraphNode& node) {
    return keeps_history(node.body) ||
           std::any_of(node.in.begin(), node.in.end(), [](const auto& in) { return in.second.previous; });
  });
}

struct Sequence {       // of a suite
  uint32_t frames = 0;  // 0: none
  SequenceTruth truth;
};

class DeviceStage final : public Stage {
 public:
  // `truth`: of the frame whose error is the row's.
  DeviceStage(std::shared_ptr<Device> device, std::shared_ptr<const Scene> scene,
              const RenderSettings& settings, Truth truth, Sequence sequence, const Suite& suite,
              fs::path images_of)
      : device_(std::move(device)),
        scene_(std::move(scene)),
        settings_(settings),
        truth_(std::move(truth)),
        sequence_(std::move(sequence)),
        repeat_(suite.repeat),
        samples_(suite.samples),
        images_of_(std::move(images_of)) {}

  std::unique_ptr<Subject> open(const SuiteConfig& config) override {
    return std::make_unique<DeviceSubject>(Renderer(device_, scene_, config.graph, settings_));
  }

  void frame(const SuiteConfig& config, Subject& given, uint32_t index, double frame_ms) override {
    auto& subject = dynamic_cast<DeviceSubject&>(given);
    if (index + 1 == sequence_.frames) {
      subject.show(config);
      subject.sequence.add(sequence_.truth.at(index), frame_ms, subject.shown().visibility);
    } else {
      const Image visibility = subject.renderer().read("visibility");
      subject.shown().nonfinite += count_nonfinite(visibility);
      subject.sequence.add(sequence_.truth.at(index), frame_ms, visibility);
    }
  }

  void finish(const SuiteConfig& config, Subject& given, Row& row) override {
    auto& subject = dynamic_cast<DeviceSubject&>(given);
    describe_renderer(row, subject.renderer());
    for (const std::string& message : scene_->warnings.messages) row.warnings.push_back(message);
    if (sequence_.frames > 0)
      describe_sequence(row, subject.sequence);
    else
      show_still(config, subject);
    const auto& shown = subject.shown();
    row.nonfinite = shown.nonfinite;
    const bool finite_color = shown.color && count_nonfinite(*shown.color) == 0;
    row.error = truth_.error(shown.visibility, finite_color ? &*shown.color : nullptr, config.graph);
    row.reference = RowReference{samples_};
    if (!images_of_.empty())
      row.images =
          write_row_images(images_of_, row, truth_, shown.visibility, shown.color ? &*shown.color : nullptr);
  }

 private:
  // What accumulates over frames is shown as it is after as many as the suite's `repeat`: how many frames
  // were timed may depend on the machine.
  void show_still(const SuiteConfig& config, DeviceSubject& subject) const {
    if (keeps_history(config.graph.nodes)) {
      subject.renderer().play();
      subject.renderer().seek(0);
      for (uint32_t i = 0; i < repeat_; ++i) subject.renderer().render(TimingMode::none);
    }
    subject.show(config);
  }

  std::shared_ptr<Device> device_;
  std::shared_ptr<const Scene> scene_;
  RenderSettings settings_;
  Truth truth_;
  Sequence sequence_;
  uint32_t repeat_;     // frames after which a technique with history is measured
  uint32_t samples_;    // of the reference
  fs::path images_of_;  // folder of results.jsonl; empty: no images
};

}  // namespace

StageMaker device_stages(const std::shared_ptr<Device>& device, const fs::path& cache, const Tell& progress,
                         const fs::path& out) {
  return [=](const Suite& suite, const SuitePlace& place) -> std::unique_ptr<Stage> {
    auto scene = std::make_shared<const Scene>(with_light_scale(load_scene(place.scene), place.light_scale));
    if (suite.camera >= scene->cameras.size())
      fail(fmt::format("camera {} does not exist: the scene has {}", suite.camera, scene->cameras.size()),
           place.scene.string());
    ReferenceSettings reference;
    reference.width = place.size.width;
    reference.height = place.size.height;
    reference.samples = suite.samples;
    reference.camera = suite.camera;
    if (progress)
      reference.progress = [=](double share) {
        progress(share, fmt::format("{}: reference {:.0f} %", scene->name, 100 * share));
      };
    RenderSettings settings;
    settings.width = place.size.width;
    settings.height = place.size.height;
    settings.camera = suite.camera;
    settings.memory = suite.memory;
    settings.frame_seconds = 1.0 / suite.fps;
    const double last = suite.frames > 0 ? (suite.frames - 1) * settings.frame_seconds : 0.0;
    const auto shown =
        last > 0 && scene->animation ? std::make_shared<const Scene>(posed(*scene, last)) : scene;
    return std::make_unique<DeviceStage>(
        device, scene, settings, Truth(shown, reference, cache),
        Sequence{suite.frames, SequenceTruth(scene, reference, cache, settings.frame_seconds)}, suite,
        suite.images ? out : fs::path());
  };
}

}  // namespace gnomon
