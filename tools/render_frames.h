// The images that `gnomon render` reads and writes, and the frames of a sequence as they are shown.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/run/progress.h"
#include "bench/run/sequence.h"
#include "engine/image/image.h"
#include "engine/render/renderer.h"
#include "tools/output_folder.h"
#include "tools/render_job.h"

namespace gnomon {

struct RenderedImages {
  std::optional<Image> color;
  Image visibility;
  std::vector<std::pair<std::filesystem::path, Image>> captured;
};

RenderedImages read_images(Renderer& renderer, const RenderJob& job);
// Colour and visibility; captures are written where the user wants them.
void write_images(OutputFolder& folder, const RenderedImages& images);
uint64_t count_nonfinite(const RenderedImages& images);

// Reads, measures and writes the frames of a sequence as they are shown.
class FrameReader {
 public:
  FrameReader(const RenderJob& job, Renderer& renderer, OutputFolder& folder);
  void read(uint32_t index, double frame_ms);

  SequenceResult result;
  RenderedImages images;  // of the last frame
  uint64_t nonfinite = 0;

 private:
  RenderedImages frame_images() const;
  void write(uint32_t index);

  const RenderJob& job_;
  Renderer& renderer_;
  OutputFolder& folder_;
  Progress progress_;
  std::optional<SequenceTruth> truth_;
};

}  // namespace gnomon
