// The width of a penumbra, as passes declare and read it.
#include "passes/distance/penumbra_width.h"
#include "engine/graph/pass.h"
#include "engine/scene/scene.h"

namespace gnomon {
namespace {

ParamSpec number(const char* name, double standard, const char* unit, const char* help) {
  return {name, ParamType::number, standard, 0, 1e9, {}, unit, help};
}

std::vector<ParamSpec> penumbra_specs() {
  return {
      number("penumbra", 0, "world units", "width of the penumbra; 0: penumbra_relative counts"),
      number("penumbra_relative", 0.014, "of the scene's diagonal", "width of the penumbra"),
      number("pixels", 15, "pixels", "width of the penumbra in the screen metric"),
      number("depth_tolerance", 1e-3, "of the view depth",
             "distance from the receiver's tangent plane within which a silhouette pixel is on its surface")};
}

}  // namespace

bool declare_penumbra_width(Declaration& d, double relative) {
  const double world =
      d.number("penumbra", 0.0, 0, 1e9, "world units", "width of the penumbra; 0: penumbra_relative counts");
  return d.number("penumbra_relative", relative, 0, 10, "of the scene's diagonal", "width of the penumbra") >
             0 ||
         world > 0;
}

void set_penumbra_traits(Declaration& d, const std::string& output) {
  const Params params = d.params();
  for (const ParamSpec& spec : penumbra_specs())
    d.set_trait(output, spec.name, params.values().find(spec.name)->second);
}

void read_penumbra_traits(Declaration& d, const std::string& input) {
  for (ParamSpec& spec : penumbra_specs()) {
    const Value* said = d.trait(input, spec.name);
    if (said) spec.default_value = *said;
    if (!said && d.is_connected(input)) d.refuse_source(input, "does not say what penumbra it was made for");
    d.derived(input, std::move(spec));
  }
}

double penumbra_width(const Scene& scene, const Params& params) {
  const double world = params.number("penumbra"), relative = params.number("penumbra_relative");
  return world > 0 ? world : relative * 2.0 * scene.bounds.radius();
}

}  // namespace gnomon
