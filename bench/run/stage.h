// The harness' stage on a Vulkan device: renderers, and the error against the ray-traced reference.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "bench/run/harness.h"

namespace gnomon {

// Each Stage loads the scene and traces its reference, or reads it from `cache`. `progress`: of the tracing,
// 0..1 and the scene's name; may be empty. `out`: the folder of results.jsonl, in whose folder images a suite
// with `images` gets its PNGs (bench/report/report_images.h).
StageMaker device_stages(const std::shared_ptr<Device>& device, const std::filesystem::path& cache,
                         const std::function<void(double, const std::string&)>& progress = {},
                         const std::filesystem::path& out = {});

}  // namespace gnomon
