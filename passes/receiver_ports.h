// What every technique that tests camera pixels against a shadow map has in common: ports and bias
// parameters, as shaders/glsl/shadow_query.glsl uses them.
#pragma once

#include "engine/context.h"
#include "engine/pass.h"

namespace gnomon {

// Parameter of the shadow map and of its readers; both must have the same value.
void declare_encoding(Declaration& d);
std::string declare_bias(Declaration& d);

// Inputs `depth`, `geometric`, `shadow_map`; parameters `encoding`, `bias`, `bias_constant`, `bias_slope`,
// `bias_normal`. Returns the shape of a visibility image: one layer a light.
ImageShape declare_receiver(Declaration& d);

// A compute shader that includes shadow_query.glsl, run for one light at a time.
class PerLight {
 public:
  void prepare(Environment& e, const std::string& file, const Defines& defines = {});
  void dispatch_over(Context& c, uint32_t light, Extent pixels) const;
  void dispatch_indirect(Context& c, uint32_t light, const std::string& port) const;

 private:
  const Pipeline& ready(Context& c, uint32_t light) const;  // with its push constants
  Pipeline one_face_, six_faces_;                           // only those that the scene's lights need
};

// Puts the biases' size in world units into run.json, at the middle of each map face's depth range.
void report_bias(Environment& e);

}  // namespace gnomon
