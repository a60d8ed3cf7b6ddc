// Reads what a technique shows and writes it.
#include "tools/render_frames.h"

#include <fmt/format.h>

#include "bench/error/truth.h"
#include "bench/run/row.h"
#include "engine/vulkan/shader.h"

namespace gnomon {

RenderedImages read_images(Renderer& renderer, const RenderJob& job) {
  RenderedImages images;
  images.visibility = renderer.read("visibility");
  if (job.graph.outputs.count("color") != 0) images.color = renderer.read("color");
  for (const Capture& capture : job.captures)
    images.captured.emplace_back(capture.file, renderer.read(capture.port));
  return images;
}

void write_images(OutputFolder& folder, const RenderedImages& images) {
  if (images.color) {
    write_png_srgb(folder.file("color.png"), rgb_of(*images.color));
    write_exr(folder.file("color.exr"), *images.color);
  }
  write_exr(folder.file("visibility.exr"), images.visibility);
}

uint64_t count_nonfinite(const RenderedImages& images) {
  return count_nonfinite(images.visibility) + (images.color ? count_nonfinite(*images.color) : 0);
}

FrameReader::FrameReader(const RenderJob& job, Renderer& renderer, OutputFolder& folder)
    : job_(job), renderer_(renderer), folder_(folder), progress_("frames " + job.scene->name) {
  if (job.samples)
    truth_.emplace(job.scene, reference_settings(job), cache_folder(), job.settings.frame_seconds);
}

void FrameReader::read(uint32_t index, double frame_ms) {
  const bool last = index + 1 == job_.frames;
  images = last ? read_images(renderer_, job_) : frame_images();
  nonfinite += count_nonfinite(images);
  if (job_.write_frames) write(index);
  if (truth_)
    result.add(truth_->at(index), frame_ms, images.visibility);
  else
    result.add(renderer_.seconds(), frame_ms);
  progress_.update(double(index + 1) / job_.frames);
}

RenderedImages FrameReader::frame_images() const {
  RenderedImages frame;
  frame.visibility = renderer_.read("visibility");
  if (job_.write_frames && job_.graph.outputs.count("color") != 0) frame.color = renderer_.read("color");
  return frame;
}

void FrameReader::write(uint32_t index) {
  const std::string name = fmt::format("frame_{:04}_", index);
  write_exr(folder_.file(name + "visibility.exr"), images.visibility);
  if (images.color) write_png_srgb(folder_.file(name + "color.png"), rgb_of(*images.color));
}

}  // namespace gnomon
