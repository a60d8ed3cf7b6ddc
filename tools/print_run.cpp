// Prints a measurement.
#include "tools/print_run.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/terminal.h"

namespace gnomon {
namespace {

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string("-");
}

std::string median_of(const std::optional<Summary>& summary) {
  return summary ? number(summary->median, 3) : std::string("-");
}

void print_passes(const std::vector<PassFigures>& passes) {
  print("  {:<24}{:<24}{:>10}{:>10}{:>10}\n", "pass", "type", "gpu ms", "isolated", "cpu ms");
  for (const PassFigures& pass : passes) {
    const std::string id = pass.iteration > 0 ? fmt::format("{} #{}", pass.id, pass.iteration) : pass.id;
    print("  {:<24}{:<24}{:>10}{:>10}{:>10.3f}\n", id, pass.type, median_of(pass.gpu_ms.overlapped),
          median_of(pass.gpu_ms.isolated), pass.cpu_ms);
  }
}

void print_error(const MeasuredError& error) {
  const auto share = [&](const char* name) {
    const auto value = figure_of(error, name);
    return value ? fmt::format("{:.4f} %", 100 * *value) : std::string("-");
  };
  print("  error: {} misclassified ({} wrongly lit, {} wrongly shadowed), acne {}, RMSE {}\n",
        share("misclassified"), share("wrongly_lit"), share("wrongly_shadowed"), share("acne"),
        number(error.all.rmse, 4));
  for (size_t light = 0; light < error.lights.size(); ++light)
    if (const std::string& reason = error.lights[light].reason; !reason.empty())
      print("  light {}: {}\n", light, reason);
}

void print_sequence(const SequenceFigures& sequence) {
  const auto text = [](const std::optional<Spread>& spread) {
    return spread && std::isfinite(spread->mean)
               ? fmt::format("{:.4f} (largest {:.4f})", spread->mean, spread->max)
               : std::string("-");
  };
  print("  {} frames: mean RMSE {}, mean flicker {}\n", sequence.frames, text(sequence.rmse),
        text(sequence.flicker));
}

}  // namespace

void print_run(const Row& row) {
  print("{} on {}, {}x{}, {}\n", row.graph, row.scene, row.size.width, row.size.height, row.device.name);
  if (row.frame_ms && row.record_ms)
    print("  frame {:.3f} ms (median of {}, interval {:.3f}..{:.3f}), recorded in {:.3f} ms\n",
          row.frame_ms->median, row.frame_ms->n, row.frame_ms->low, row.frame_ms->high,
          row.record_ms->median);
  print_passes(row.passes);
  for (const LeftOutPass& one : row.left_out)
    print("  left out: {}{}{}: {}\n", one.pass, one.part.empty() ? "" : ", ", one.part, one.reason);
  if (row.error) print_error(*row.error);
  if (row.sequence) print_sequence(*row.sequence);
}

}  // namespace gnomon
