// Runs one graph on one scene on one device, frame by frame, and measures it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/graph.h"
#include "engine/image/image.h"
#include "engine/light/light_view.h"
#include "engine/render/left_out.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"
#include "engine/vulkan/device_info.h"

namespace gnomon {

struct Plan;

enum class TimingMode {
  none,        // no timestamps at all: what a frame costs
  overlapped,  // stamps at pass boundaries, barriers as planned
  isolated     // full barrier between passes: attribution
};

struct PassTiming {
  std::string id, type;     // of a part of a pass (Context::section): "id.part"
  uint32_t iteration = 0;   // of its loop; 0 outside loops
  double gpu_ms = 0;        // stamp to stamp, barriers included: passes add up to their segment
  double cpu_ms = 0;        // recording
  double host_wait_ms = 0;  // host waiting for this pass' segment (host-read edges)
};
struct FrameTiming {
  double frame_ms = 0;   // submit to completion, wall clock, recording included
  double record_ms = 0;  // CPU recording of the whole frame
  double gpu_ms = 0;     // first to last stamp, summed over segments; 0 in mode none
  std::vector<PassTiming> passes;
};

struct MemoryUse {
  uint64_t peak_bytes = 0, transient_bytes = 0, transient_bytes_without_aliasing = 0;
};

class Renderer {
 public:
  // Compiles the graph, its shaders and uploads the scene; without one (nullptr) for graphs whose passes draw
  // none. Error for what cannot run here.
  Renderer(std::shared_ptr<Device> device, std::shared_ptr<const Scene> scene, const Graph& graph,
           const RenderSettings& settings);
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  FrameTiming render(TimingMode mode);  // one frame; returns when it is done
  // The scene's time of the next frame and of those after it; 0 at first. Clamped to the animation's key
  // frames.
  void seek(double seconds);
  // Begins a sequence: the frames so far are forgotten (history is zero, frames count from 0 again), the next
  // frame is at time 0 and each one after it RenderSettings::frame_seconds later, until seek().
  void play();
  double seconds() const;  // the scene's time of the last frame
  // A graph output ("visibility", "color") or captured port after render(). Channels: one image channel per
  // component and layer: "Y" for layer 0 of a one-channel image, "light1.Y", ...; RGB(A) as
  // "R","G","B"(,"A").
  Image read(const std::string& output);
  // The same of one-component 32-bit images, bit for bit: layer after layer, row 0 at the top.
  std::vector<uint32_t> read_words(const std::string& output);

  // Of an output or captured port ("node.port") whose layers show what lights see: their views in the last
  // frame, and what the pass says of the image. Nothing where no light's views stand behind it.
  struct MapViews {
    std::vector<LightView> views;  // a layer each
    Values traits;
  };
  std::optional<MapViews> map_views(const std::string& port) const;

  MemoryUse memory() const;
  std::vector<LeftOutPass> left_out() const;    // passes, then parts of those that run
  std::vector<std::string> warnings() const;    // passes' own ("open mesh 'leaves' in shadow_volumes")
  std::map<std::string, double> facts() const;  // passes' own figures: "shade.bias_world", ...
  const Plan& plan() const;                     // as compiled for the scene
  // Names of passes in execution order.
  std::vector<std::string> passes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon
