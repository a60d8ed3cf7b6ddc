// Area techniques test their samples' maps as hard techniques test theirs: every bias method, both encodings.
#include <gtest/gtest.h>

#include <ostream>

#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using namespace hard_shadow;

std::string passes_of(const std::string& test) {
  return R"({ "schema": 1, "name": "one", "passes": [
    { "id": "gbuffer", "type": "gbuffer" }, { "id": "views", "type": "light_views" },)" +
         test + R"(], "outputs": { "visibility": "test.visibility" } })";
}

std::string area_graph(const std::string& params) {
  return passes_of(R"({ "id": "test", "type": "area_uniform",
    "in": { "views": "views.views", "depth": "gbuffer.depth", "geometric": "gbuffer.geometric" },
    "params": { "size": 256, "samples": 1, "pattern": "grid_centres", )" +
                   params + "} }");
}

// A light without size: its centre is its only sample.
Scene scene_of(LightType type) { return analytic::square_over_plane(analytic::light(type, {1.5, 7, 1})); }

struct Case {
  const char* bias;
  const char* encoding;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.bias << ' ' << c.encoding; }

class AreaBias : public testing::TestWithParam<Case> {};

TEST_P(AreaBias, OneSampleIsTestedWithoutAcne) {
  const std::string params =
      std::string(R"("bias": ")") + GetParam().bias + R"(", "encoding": ")" + GetParam().encoding + "\"";
  for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
    const Scene scene = scene_of(type);
    const RenderSettings s = settings(true);
    const Frame area{visibility(parse_graph(area_graph(params), "area"), scene, s), {}, {}};
    const Reference reference = trace(scene, s);
    const Misclassified e = compare(area, reference);
    EXPECT_GT(e.shadowed, 200u);
    // Without its front faces the square, which is open, casts no shadow.
    const bool casts = std::string(GetParam().bias) != "back_face";
    if (casts) {
      EXPECT_LT(e.share(), 0.02) << "light type " << int(type);
    }
    // As the hard technique has it, but for rounding.
    const Frame hard = render("shadow_mapping", scene, s,
                              {{"shadow_map", int64_t{256}},
                               {"bias", std::string(GetParam().bias)},
                               {"depth", std::string(GetParam().encoding)}});
    uint64_t differs = 0;
    for (size_t i = 0; i < area.visibility[0].size(); ++i)
      differs += area.visibility[0][i] != hard.visibility[0][i];
    EXPECT_LE(differs, area.visibility[0].size() / 1000) << "light type " << int(type);
  }
}

INSTANTIATE_TEST_SUITE_P(All, AreaBias,
                         testing::Values(Case{"constant", "perspective"}, Case{"slope_scaled", "perspective"},
                                         Case{"receiver_plane", "perspective"},
                                         Case{"receiver_plane", "linear"}, Case{"normal_offset", "linear"},
                                         Case{"back_face", "perspective"}),
                         [](const auto& info) {
                           return std::string(info.param.bias) + "_" + info.param.encoding;
                         });

TEST(AreaBias, MidpointIsRefused) {
  try {
    Renderer(device(), std::make_shared<Scene>(scene_of(LightType::spot)),
             parse_graph(area_graph(R"("bias": "midpoint")"), "area"), settings(true));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'bias' is \"midpoint\""), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gnomon
