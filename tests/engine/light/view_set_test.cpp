// Sets of light views: which views are whose, and what counts as changed.
#include "engine/light/view_set.h"

#include <gtest/gtest.h>

#include "engine/light/light_fit.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

LightView view_of(uint32_t light, double far) {
  LightView view;
  view.light = light;
  view.far = far;
  return view;
}

TEST(ViewSet, RangesFollowTheLights) {
  const ViewSet set = view_set({view_of(0, 2), view_of(1, 3), view_of(1, 4), view_of(1, 5), view_of(2, 6)});
  ASSERT_EQ(set.of_light.size(), 3u);
  const uint32_t first[] = {0, 1, 4}, count[] = {1, 3, 1};
  for (size_t light = 0; light < 3; ++light) {
    EXPECT_EQ(set.of_light[light].first, first[light]);
    EXPECT_EQ(set.of_light[light].count, count[light]);
  }
  EXPECT_EQ(set.changed, (std::vector<bool>{true, true, true}));
}

TEST(ViewSet, ChangesAreThoseOfLightsThatMoveAndOfViewsWithOtherValues) {
  const std::vector<LightView> views{view_of(0, 2), view_of(1, 3), view_of(2, 4)};
  const ViewSet set = view_set(views);
  EXPECT_EQ(next_view_set(set, views, {false, false, false}).changed,
            (std::vector<bool>{false, false, false}));
  EXPECT_EQ(next_view_set(set, views, {false, true, false}).changed, (std::vector<bool>{false, true, false}));
  std::vector<LightView> others = views;
  others[2].far = 5;
  const ViewSet next = next_view_set(set, others, {true, false, false});
  EXPECT_EQ(next.changed, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(next.views[2].far, 5);
  EXPECT_EQ(next.of_light.size(), 3u);
}

// A caster that rises comes nearer to the light than anything was: the range of depths is another. One that
// moves aside leaves it.
TEST(ViewSet, AMovingCasterChangesTheViewsWhoseRangeItSets) {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {0.5, 7, 0.5}));
  analytic::add(scene, analytic::square(0.3f), {0.5, 3, 0.5});
  scene.instances[1].moving = true;
  const LightFit fit(scene, 32, 1);
  const ViewSet before = view_set(fit.views(scene));
  scene.instances[1].world_from_object[3].x += 0.1;
  EXPECT_FALSE(next_view_set(before, fit.views(scene), {false}).changed[0]);
  scene.instances[1].world_from_object[3].y += 4;
  const ViewSet after = next_view_set(before, fit.views(scene), {false});
  EXPECT_TRUE(after.changed[0]);
  EXPECT_LT(after.views[0].near, before.views[0].near);
}

}  // namespace
}  // namespace gnomon
