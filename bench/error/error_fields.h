// The members of a measured error by the names that they have in result rows.
#pragma once

#include <limits>

#include "bench/error/measure.h"
#include "engine/base/json_fields.h"

namespace gnomon {

template <class Io>
void fields(Io& io, typename Io::template Of<LightError>& m) {
  if constexpr (Io::reads) {  // what is not there is no figure
    const double none = std::numeric_limits<double>::quiet_NaN();
    m.rmse = m.mae = m.max = m.bias = m.misclassified = m.wrongly_lit = m.wrongly_shadowed = none;
  }
  io("rmse", m.rmse);
  io("mae", m.mae);
  io("max", m.max);
  io("bias", m.bias);
  io("misclassified", m.misclassified);
  io("wrongly_lit", m.wrongly_lit);
  io("wrongly_shadowed", m.wrongly_shadowed);
  io.unless_empty("penumbra_rmse", m.penumbra_rmse);
  io.unless_empty("umbra_light", m.umbra_light);
  io.unless_empty("leak", m.leak);
  io.unless_empty("over_shadow", m.over_shadow);
  io.unless_empty("acne", m.acne);
  io.unless_empty("ssim", m.ssim);
  io.unless_empty("flip", m.flip);
  io("pixels", m.pixels);
  io("excluded", m.excluded);
  io("nonfinite", m.nonfinite);
  io("out_of_range", m.out_of_range);
  io.unless_empty("reason", m.reason);
}

template <class Io>
void fields(Io& io, typename Io::template Of<MeasuredError>& error) {
  fields(io, error.all);
  io.unless_empty("lights", error.lights);
  io.unless_empty("ci95", error.intervals);
  io.unless_empty("reference_noise", error.reference_noise);
  io.unless_empty("flicker", error.flicker);
}

}  // namespace gnomon
