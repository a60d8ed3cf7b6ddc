// How a graph is rendered: size, camera, memory.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

struct Image;  // engine/image/image.h

struct RenderSettings {
  uint32_t width = 1280, height = 720;  // pixels
  uint32_t camera = 0;                  // index into Scene::cameras
  // Camera depth: reversed (1 near, 0 at infinity) or standard. Orthographic cameras have linear depth, which
  // floats tell apart best where they are small: standard, whatever is asked for.
  bool reversed_z = true;
  bool alias = true;                    // transient memory aliasing
  bool keep_all = false;                // leave nothing out
  uint64_t memory = uint64_t{1} << 30;  // bytes that a technique's shadow maps may take at a time
  double frame_seconds = 1.0 / 30;      // of the scene's time, from frame to frame of Renderer::play()
  std::vector<std::string> captures;    // "node.port" besides the outputs
  // What passes of type image_source show, by their id: the first channel, of the viewport's size.
  std::map<std::string, std::shared_ptr<const Image>> images;
};

}  // namespace gnomon
