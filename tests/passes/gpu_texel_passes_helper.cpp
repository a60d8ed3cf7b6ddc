// Passes that give tests a map of any size, layers and channels, and take one apart again.
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>

#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"
#include "tests/passes/texel_passes.h"

namespace gnomon::test {
namespace {

class Texels : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Texels that a test gives.");
    d.darkens_lit_surfaces();
    const auto layers = uint32_t(d.integer("layers", 1, 1, 64, "layers", "of the map"));
    const int64_t channels = d.integer("channels", 1, 1, 4, "channels", "of the map: 1, 2 or 4");
    const VkFormat format = channels == 1   ? VK_FORMAT_R32_SFLOAT
                            : channels == 2 ? VK_FORMAT_R32G32_SFLOAT
                                            : VK_FORMAT_R32G32B32A32_SFLOAT;
    d.output("texels", Access::transfer_write, true, {d.setting().viewport, layers, 1, format}, "the texels");
  }
  void prepare(Environment& e) override {
    texels_ = e.upload(std::as_bytes(std::span(given_texels())), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  }
  void record(Context& c) override { c.copy(texels_, "texels"); }

 private:
  Buffer texels_;
};
GNOMON_PASS("test_texels", Texels);

class PickTexels : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("One level, layer and channel of a map.");
    d.input("source", Access::sampled, true, "the map");
    d.integer("layer", 0, 0, 63, "1", "shown");
    d.integer("level", 0, 0, 15, "1", "shown");
    d.integer("channel", 0, 0, 3, "1", "shown");
    d.output("picked", Access::storage_write, false, {d.setting().viewport, 1, 1, VK_FORMAT_R32_UINT},
             "the bits");
  }
  void prepare(Environment& e) override {
    const auto file = scratch_folder() / "test_pick.glsl";
    std::ofstream(file) << R"(
layout(local_size_x = 8, local_size_y = 8) in;
uvec4 bits(uvec4 v) { return v; }
uvec4 bits(vec4 v) { return floatBitsToUint(v); }
void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(picked)))) return;
  uint word = 0u;
#ifdef LEVELS
  if (all(lessThan(at, textureSize(source, params.level).xy))) word = bits(source_at(at, params.layer, params.level))[params.channel];
#else
  if (all(lessThan(at, textureSize(source, 0).xy))) word = bits(source_at(at, params.layer))[params.channel];
#endif
  imageStore(picked, at, uvec4(word));
}
)";
    pipeline_ = e.compute(file.string(), e.shape("source").mips > 1 ? Defines{{"LEVELS", "1"}} : Defines{});
  }
  void record(Context& c) override { c.dispatch_over(pipeline_, c.shape("picked").extent); }

 private:
  Pipeline pipeline_;
};
GNOMON_PASS("test_pick", PickTexels);

}  // namespace

std::vector<float>& given_texels() {
  static std::vector<float> texels;
  return texels;
}

std::vector<std::vector<uint32_t>> picked(Extent size, int layers, int channels, const std::string& nodes,
                                          const std::string& port, const std::vector<Pick>& picks) {
  if (given_texels().size() != size_t(size.width) * size.height * size_t(layers) * size_t(channels))
    throw std::logic_error("a test gives a wrong number of texels");
  const auto text = [](int value) { return std::to_string(value); };
  std::string graph = R"({ "schema": 1, "name": "texels", "passes": [
    { "id": "texels", "type": "test_texels", "params": { "layers": )" +
                      text(layers) + R"(, "channels": )" + text(channels) + " } }" + nodes;
  std::string outputs;
  for (size_t i = 0; i < picks.size(); ++i) {
    const std::string id = "pick" + std::to_string(i);
    graph += R"(, { "id": ")" + id + R"(", "type": "test_pick", "in": { "source": ")" + port +
             R"(" }, "params": { "layer": )" + text(picks[i].layer) + R"(, "level": )" +
             text(picks[i].level) + R"(, "channel": )" + text(picks[i].channel) + " } }";
    outputs += (i ? ", \"" : "\"") + id + "\": \"" + id + ".picked\"";
  }
  graph += "], \"outputs\": { " + outputs + " } }";
  RenderSettings settings;
  settings.width = size.width, settings.height = size.height;
  static const auto scene =
      std::make_shared<Scene>(analytic::square_over_plane(analytic::light(LightType::spot, {1.5, 7, 1})));
  const auto device = hard_shadow::device();
  const size_t messages = validation_messages(*device).size();
  Renderer renderer(device, scene, parse_graph(graph, "texels"), settings);
  renderer.render(TimingMode::none);
  std::vector<std::vector<uint32_t>> words;
  for (size_t i = 0; i < picks.size(); ++i) words.push_back(renderer.read_words("pick" + std::to_string(i)));
  const auto& all = validation_messages(*device);
  for (size_t i = messages; i < all.size(); ++i) ADD_FAILURE() << all[i];
  return words;
}

}  // namespace gnomon::test
