// Which casters a shadow map's views need: those whose shadow may fall on what the camera sees, kept up to
// date while the scene moves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/graph/pass.h"
#include "engine/render/raster.h"

namespace gnomon {

struct Scene;    // engine/scene/scene.h
struct ViewSet;  // engine/light/view_set.h

class CasterLayers {
 public:
  // `map`: the output that shows the casters. With keep_all every view has all of them.
  void prepare(Environment& e, const std::string& map);
  // For the frame at hand. `keep`: the map still shows what `of_map()` was when it was drawn last; true when
  // that is all the frame needs, so that nothing has to be drawn.
  bool update(const Context& c, bool keep);
  const InstanceLayers& of_map() const { return layers_; }
  double draws() const { return draws_; }  // of the last frame: instances times views

 private:
  using Needed = std::vector<std::vector<bool>>;  // [view][instance]
  Needed needed(const Scene& scene, const ViewSet& views) const;
  void draw_later(const Needed& needed);

  std::optional<uint32_t> reach_;
  std::vector<std::string> shadowless_;
  bool all_ = false;
  uint32_t camera_ = 0, size_ = 1;
  double aspect_ = 1, draws_ = 0;
  Needed drawn_;
  InstanceLayers layers_;
};

}  // namespace gnomon
