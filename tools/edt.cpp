// Distance transforms of masks, apart from any scene.
#include "tools/edt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/render/renderer.h"

namespace gnomon {
namespace {

Graph edt_graph(const EdtSettings& settings) {
  const nlohmann::json graph = {
      {"schema", 1},
      {"name", "edt"},
      {"passes",
       {{{"id", "mask"}, {"type", "image_source"}, {"params", {{"mask", settings.sites == "nonzero"}}}},
        {{"id", "transform"},
         {"type", "distance_transform"},
         {"in", {{"source", "mask.value"}}},
         {"params",
          {{"algorithm", settings.algorithm},
           {"variant", settings.variant},
           {"sites", settings.sites},
           {"radius", settings.radius}}}}}},
      {"outputs", {{"nearest", "transform.nearest"}}}};
  return parse_graph(graph.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), "edt");
}

// The pass "transform" and its parts, "transform.STEP".
void add_times(EdtRun& run, const FrameTiming& timing) {
  constexpr std::string_view name = "transform", part = "transform.";
  double all = 0;
  for (const PassTiming& pass : timing.passes) {
    const bool step = pass.id.starts_with(part);
    if (step || pass.id == name) all += pass.gpu_ms;
    if (step) run.step_ms[pass.id.substr(part.size())].push_back(pass.gpu_ms);
  }
  run.gpu_ms.push_back(all);
}

}  // namespace

EdtRun run_edt(const std::shared_ptr<Device>& device, const std::shared_ptr<const Image>& mask,
               const EdtSettings& settings) {
  RenderSettings render;
  render.width = mask->width, render.height = mask->height;
  render.memory = settings.memory;
  render.images["mask"] = mask;
  Renderer renderer(device, nullptr, edt_graph(settings), render);
  EdtRun run;
  for (uint32_t i = 0; i < settings.warmup; ++i) renderer.render(TimingMode::isolated);
  for (uint32_t i = 0; i < settings.repeat; ++i) add_times(run, renderer.render(TimingMode::isolated));
  run.nearest = renderer.read_words("nearest");
  return run;
}

Image edt_mask(const Image& image, const std::string& file_for_errors) {
  Image mask(image.width, image.height, {"Y"});
  for (size_t c = 0; c < image.channels.size(); ++c) {
    if (image.channels[c] == "A") continue;
    const auto plane = image.plane(c);
    for (size_t i = 0; i < plane.size(); ++i) {
      if (std::isnan(plane[i]))
        fail(fmt::format("pixel ({}, {}) of channel '{}' is not a number", i % image.width, i / image.width,
                         image.channels[c]),
             file_for_errors);
      if (plane[i] != 0) mask.data[i] = 1;
    }
  }
  return mask;
}

std::optional<int64_t> squared_distance(const std::vector<uint32_t>& nearest, size_t index, uint32_t width) {
  const uint32_t site = nearest[index];
  if (site == kNoSite) return std::nullopt;
  const int64_t x = int64_t(site & 0xFFFF) - int64_t(index % width),
                y = int64_t(site >> 16) - int64_t(index / width);
  return x * x + y * y;
}

Image edt_distance(const std::vector<uint32_t>& nearest, uint32_t width, uint32_t height) {
  Image distance(width, height, {"Y"});
  for (size_t i = 0; i < nearest.size(); ++i) {
    const auto squared = squared_distance(nearest, i, width);
    distance.data[i] = squared ? float(std::sqrt(double(*squared))) : std::numeric_limits<float>::infinity();
  }
  return distance;
}

EdtError edt_error(const std::vector<uint32_t>& nearest, const std::vector<uint32_t>& exact, uint32_t width) {
  EdtError error;
  for (size_t i = 0; i < exact.size(); ++i) {
    const auto is = squared_distance(nearest, i, width), should_be = squared_distance(exact, i, width);
    if (is == should_be) continue;
    ++error.wrong;
    const double difference = is && should_be
                                  ? std::abs(std::sqrt(double(*is)) - std::sqrt(double(*should_be)))
                                  : std::numeric_limits<double>::infinity();
    error.largest = std::max(error.largest, difference);
  }
  return error;
}

}  // namespace gnomon
