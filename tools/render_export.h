// What `gnomon render --export` writes of a frame, for programs that learn from it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/render/renderer.h"
#include "tools/output_folder.h"
#include "tools/render_job.h"

namespace gnomon {

// Error when the folder holds something already.
void check_export_folder(const std::filesystem::path& folder);

// Ports ("node.port") of the technique's maps of depth from the lights, to be kept as captures.
std::vector<std::string> shadow_map_ports(const RenderJob& job);

// Writes depth, normal, albedo and position of the surface that each pixel shows, the visibility of the
// technique and of the reference, the shadow maps at `ports`, and frame.json, which says what each file
// holds. Traces the reference. `seconds`: of the scene's time, that the renderer has shown last.
void write_export(OutputFolder& folder, const RenderJob& job, Renderer& renderer, const Image& visibility,
                  const std::vector<std::string>& ports, double seconds);

}  // namespace gnomon
