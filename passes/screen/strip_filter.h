// What the separable, edge-aware filters of a visibility image have in common: they work in place, along x,
// then along y, on the strips of the image where visibility changes within the filter's reach. See
// shaders/glsl/screen/strip_filter.glsl.
#pragma once

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/vulkan/pipeline.h"

namespace gnomon {

class StripFilter : public Pass {
 public:
  void declare(Declaration& d) const override;
  Need need(const SceneFacts& facts, const Params& params) const override;
  void prepare(Environment& e) override;
  void record(Context& c) override;

 protected:
  // `shader`: one direction of the filter; includes strip_filter_line.glsl. `soft`: the same with a width for
  // each pixel; includes strip_filter_soft.glsl.
  StripFilter(std::string shader, std::string soft)
      : shader_(std::move(shader)), soft_shader_(std::move(soft)) {}

 private:
  std::string shader_, soft_shader_;
  Pipeline classify_, list_y_, list_x_, along_x_, along_y_;
  bool tiled_ = false;         // knows which tiles are not plain
  mutable bool soft_ = false;  // as declared: a width for each pixel
  float reference_depth_ = 1;  // world units
};

}  // namespace gnomon
