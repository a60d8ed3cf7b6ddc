// The ray-traced reference under area lights of every shape, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/base/error.h"
#include "engine/base/resource_root.h"
#include "engine/graph/graph.h"
#include "engine/light/scene_facts.h"
#include "engine/scene/area_light.h"
#include "engine/truth/reference.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tools/scene_generate.h"

namespace gnomon {
namespace {

using namespace analytic;
using Shape = AreaLight::Shape;

constexpr double light_height = 6;
const glm::dvec3 light_place(0.25, light_height, -0.5);

// The light faces down; its local x is the world's -x, its local y the world's z.
Light area_spot(const AreaLight& area) {
  Light l = light(LightType::spot, light_place, {light_place.x, 0, light_place.z});
  l.area = area;
  return l;
}

// A plane, and above it a blocker that covers all x < 0.
Scene half_plane(const AreaLight& area) {
  Scene scene;
  add(scene, square(20), {0, 0, 0});
  add(scene, square(8), {-8, blocker_height, 0});
  scene.cameras.push_back(camera({3.5, 3, 4}, {0.3, 0, 0}));
  scene.lights.push_back(area_spot(area));
  return scene;
}

using Truth = std::function<double(const glm::dvec3&)>;  // visibility of a ground point

struct Measured {
  double rmse = 0, noise_floor = 0;
  int penumbra = 0;
};

Measured measure(const Scene& scene, uint32_t samples, const Truth& truth) {
  ReferenceSettings settings;
  settings.width = 80, settings.height = 60, settings.samples = samples;
  const Reference r = ReferenceTracer(scene).trace(settings);
  Measured m;
  m.noise_floor = r.noise_floor;
  for (size_t i = 0; i < r.depth.size(); ++i) {
    const glm::dvec3 p = glm::dvec3(scene.cameras[0].world_from_camera[3]) + glm::dvec3(r.position[i]);
    if (std::isinf(r.depth[i]) || std::abs(p.y) > 0.5 || glm::length(p) > 5) continue;  // the blocker ends
    const double expected = truth(p), value = r.visibility[0][i];
    if (expected < 1e-4 || expected > 1 - 1e-4) {
      EXPECT_NEAR(value, expected, 3e-3) << p.x << ' ' << p.z;
      continue;
    }
    ++m.penumbra;
    m.rmse += (value - expected) * (value - expected);
  }
  m.rmse = std::sqrt(m.rmse / m.penumbra);
  return m;
}

// 1024 samples: the standard error of a net is about N^(-3/4) = 0.0055, that of random points up to 0.016.
void expect_close(const Scene& scene, const Truth& truth, double bound = 0.006) {
  const Measured m = measure(scene, 1024, truth);
  EXPECT_GT(m.penumbra, 150);
  EXPECT_LT(m.rmse, bound);
  EXPECT_GE(m.noise_floor, 0.8 * m.rmse);
  EXPECT_LE(m.noise_floor, 8 * m.rmse);
}

// World x of the blocker's edge on the light's plane, seen from a ground point, relative to the light's
// centre: what is right of it is visible.
double edge_on_light(const glm::dvec3& p) {
  return p.x + (0 - p.x) * light_height / blocker_height - light_place.x;
}

// Share of the unit disc at x > t.
double segment(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return (std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi;
}

TEST(ReferenceArea, DiscBehindAnEdgeIsACircularSegment) {
  const double radius = 0.8;
  expect_close(half_plane({Shape::disc, 2 * radius, 2 * radius, {}, {}}),
               [&](const glm::dvec3& p) { return segment(edge_on_light(p) / radius); });
}

// Through the point and the edge goes a plane; it makes the angle e with the axis to the sphere's centre, and
// cuts the tangent cone's round cross-section (half angle a, sin a = r / d) at tan e / tan a of its radius.
Truth sphere_behind_edge(double radius) {
  return [=](const glm::dvec3& p) {
    const glm::dvec3 to_centre = light_place - p, to_edge(-p.x, blocker_height, 0);
    const glm::dvec3 covered =
        glm::normalize(glm::cross(glm::dvec3(0, 0, -1), to_edge));  // towards -x ... +x
    const glm::dvec3 open = covered.x > 0 ? covered : -covered;
    const double d = glm::length(to_centre), sine = glm::dot(open, to_centre) / d;
    const double e = std::asin(sine), a = std::asin(radius / d);
    return segment(-std::tan(e) / std::tan(a));
  };
}

TEST(ReferenceArea, SphereBehindAnEdgeIsASegmentOfItsTangentCone) {
  const double radius = 0.9;
  expect_close(half_plane({Shape::sphere, 2 * radius, 2 * radius, {}, {}}), sphere_behind_edge(radius));
}

TEST(ReferenceArea, ASphereAroundAPointLightIsThatOfASpot) {
  const double radius = 0.9;
  Scene scene = half_plane({Shape::sphere, 2 * radius, 2 * radius, {}, {}});
  scene.lights[0].type = LightType::point;
  expect_close(scene, sphere_behind_edge(radius));
}

constexpr double degree = std::numbers::pi / 180;

// `towards`: from the ground to the light.
Scene half_plane_under_sun(double diameter, const glm::dvec3& towards) {
  Scene scene = half_plane(angular_disc(diameter));
  const AreaLight area = *scene.lights[0].area;
  scene.lights[0] = light(LightType::directional, towards);
  scene.lights[0].area = area;
  return scene;
}

// Directions d + s to the light, d its unit axis, s in a disc of radius t = tan(a / 2) across it: from a
// ground point p the edge is passed where p.x (d.y + s.y) + h (d.x + s.x) > 0, a half-plane in s.
Truth sun_behind_edge(double diameter, const glm::dvec3& towards) {
  return [=](const glm::dvec3& p) {
    const glm::dvec3 d = glm::normalize(towards), n(blocker_height, p.x, 0);
    const glm::dvec3 across = n - glm::dot(n, d) * d;
    return segment(-glm::dot(n, d) / (glm::length(across) * std::tan(0.5 * diameter)));
  };
}

TEST(ReferenceArea, SunBehindAnEdgeIsASegmentOfItsDisc) {
  for (const glm::dvec3& towards : {glm::dvec3(0, 1, 0), glm::dvec3(0.5, 2, -0.7)})
    expect_close(half_plane_under_sun(30 * degree, towards), sun_behind_edge(30 * degree, towards));
}

// w_p = 2 tan(a / 2) (z_p - z_b), wherever the receiver is; and far from the world's origin.
TEST(ReferenceArea, PenumbraOfTheSunIsAsWideAsItsAngle) {
  for (const double diameter : {0.53 * degree, 20 * degree}) {
    Scene scene = half_plane_under_sun(diameter, {0, 1, 0});
    const double width = 2 * std::tan(0.5 * diameter) * blocker_height;
    // The view is three penumbrae wide, seen through the gap under the blocker.
    scene.cameras[0] = camera({0, 1.5, 1e-3}, {0, 0, 0});
    scene.cameras[0].fov_y = 2 * std::atan(1.5 * width / 1.5);
    scene = moved(scene, {1e5, 0, 0});
    ReferenceSettings settings;
    settings.width = 121, settings.height = 121, settings.samples = 256;
    const Reference r = ReferenceTracer(scene).trace(settings);
    double lowest = 1e300, highest = -1e300;
    for (size_t i = 0; i < r.depth.size(); ++i) {
      const float v = r.visibility[0][i];
      if (v == 0 || v == 1) continue;
      lowest = std::min(lowest, double(r.position[i].x)),
      highest = std::max(highest, double(r.position[i].x));
    }
    const double pixel = 3 * width / 121;
    EXPECT_NEAR(highest - lowest, width, 4 * pixel);  // near its ends a disc's share is below a sample's
    EXPECT_NEAR(highest + lowest, 0, 2 * pixel);
  }
}

// Of a disc of radius r about c the share outside of the square [-1, 1] x [-1, 1], by chords.
double outside_square(const glm::dvec2& c, double r) {
  constexpr int steps = 4000;
  double inside = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = r * (2 * (i + 0.5) / steps - 1), half = std::sqrt(r * r - x * x);
    if (std::abs(c.x + x) > blocker_half) continue;
    const double low = std::max(c.y - half, -blocker_half), high = std::min(c.y + half, blocker_half);
    inside += std::max(0.0, high - low) * 2 * r / steps;
  }
  return 1 - inside / (std::numbers::pi * r * r);
}

// The square seen from a ground point is a square on the light's disc at the blocker's height.
TEST(ReferenceArea, ASquareUnderTheSunHidesASquareOfItsDisc) {
  const double diameter = 25 * degree;
  Scene scene = square_over_plane(light(LightType::directional, {0, 1, 0}));
  scene.lights[0].area = angular_disc(diameter);
  expect_close(scene, [&](const glm::dvec3& p) {
    return outside_square({p.x, p.z}, blocker_height * std::tan(0.5 * diameter));
  });
}

// A body that reaches into the sphere hides what is in front of it only: rays end where they enter it.
TEST(ReferenceArea, PointsInASphereLightSeeIt) {
  Scene scene = square_over_plane(light(LightType::spot, {0, 0.5, 0}));
  scene.lights[0].area = AreaLight{Shape::sphere, 2, 2, {}, {}};
  ReferenceSettings settings;
  settings.width = 64, settings.height = 48, settings.samples = 16;
  const Reference r = ReferenceTracer(scene).trace(settings);
  int inside = 0;
  for (size_t i = 0; i < r.depth.size(); ++i) {
    const glm::dvec3 p = glm::dvec3(scene.cameras[0].world_from_camera[3]) + glm::dvec3(r.position[i]);
    if (std::isinf(r.depth[i]) || glm::length(p - glm::dvec3(0, 0.5, 0)) > 0.99 || p.y > 0.1) continue;
    ++inside;
    EXPECT_EQ(r.visibility[0][i], 1.0f);
  }
  EXPECT_GT(inside, 3);
}

// Area of the part of an outline at x < limit (Sutherland and Hodgman 1974); exact for concave outlines too,
// as the pieces' connections have no area.
double clipped_area(const std::vector<glm::dvec2>& outline, double limit) {
  std::vector<glm::dvec2> kept;
  for (size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    if (a.x <= limit) kept.push_back(a);
    if ((a.x <= limit) != (b.x <= limit)) kept.push_back(a + (limit - a.x) / (b.x - a.x) * (b - a));
  }
  double twice = 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    const glm::dvec2 a = kept[i], b = kept[(i + 1) % kept.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

TEST(ReferenceArea, PolygonBehindAnEdgeIsAClippedPolygon) {
  const std::vector<glm::dvec2> outline = {{-0.9, -0.5}, {0.2, -0.25}, {1.0, -0.5}, {0.1, 0.75}};
  const double all = clipped_area(outline, 1e9);
  expect_close(half_plane(polygon_light(outline)), [&](const glm::dvec3& p) {
    return clipped_area(outline, -edge_on_light(p)) / all;  // local x is the world's -x
  });
  // Thin: one point of the rectangle in ten is on it.
  const std::vector<glm::dvec2> thin = {{-1, -1}, {-0.8, -1}, {1, 1}, {0.8, 1}};
  const double thin_area = clipped_area(thin, 1e9);
  expect_close(
      half_plane(polygon_light(thin)),
      [&](const glm::dvec3& p) { return clipped_area(thin, -edge_on_light(p)) / thin_area; }, 0.012);
}

TEST(ReferenceArea, EmissionWeighsWhatIsSeen) {
  Texture texture;
  texture.width = 4, texture.height = 1, texture.nearest = true;
  texture.rgba = {0,   0,   0,   255, 0,   0, 0, 255,
                  255, 255, 255, 255, 255, 0, 0, 255};  // black, black, white, red
  Scene scene = half_plane({Shape::rectangle, 1.6, 1.1, {}, 0});
  scene.textures.push_back(texture);
  const double weight[4] = {0, 0, 1, 0.2126};
  expect_close(scene, [&](const glm::dvec3& p) {
    const double seen = -edge_on_light(p);  // local x below this
    double part = 0;
    for (int i = 0; i < 4; ++i) part += weight[i] * std::clamp((seen + 0.8) / 0.4 - i, 0.0, 1.0);
    return part / 1.2126;
  });
}

TEST(ReferenceArea, OneColourAloneChangesNothing) {
  Texture texture;
  texture.rgba = {255, 255, 255, 255};
  const AreaLight plain{Shape::rectangle, 1.6, 1.1, {}, {}};
  AreaLight textured = plain;
  textured.emission = 0;
  Scene white = half_plane(textured);
  white.textures.push_back(texture);
  ReferenceSettings settings;
  settings.width = 60, settings.height = 45, settings.samples = 64;
  const Reference a = ReferenceTracer(half_plane(plain)).trace(settings),
                  b = ReferenceTracer(white).trace(settings);
  for (size_t i = 0; i < a.depth.size(); ++i) EXPECT_NEAR(a.visibility[0][i], b.visibility[0][i], 1e-6);
}

TEST(ReferenceArea, BrokenOutlinesAreErrors) {
  AreaLight area{Shape::polygon, 2, 2, {{-1, 0}, {1, 0}, {0, 0}}, {}};
  ReferenceSettings settings;
  settings.width = settings.height = 8, settings.samples = 4;
  EXPECT_THROW(ReferenceTracer(half_plane(area)).trace(settings), Error);
}

TEST(ReferenceArea, ShapesThatATypeCannotHaveDoNotCount) {
  Scene scene = half_plane({Shape::disc, 1, 1, {}, {}});
  scene.lights[0].type = LightType::point;
  ReferenceSettings settings;
  settings.width = 40, settings.height = 30, settings.samples = 64;
  const Reference r = ReferenceTracer(scene).trace(settings);
  EXPECT_EQ(r.samples, 1u);
  for (const float v : r.visibility[0]) EXPECT_TRUE(v == 0 || v == 1);
  EXPECT_EQ(scene_facts(scene, scene.cameras[0], 1).light_size[0], 0.0);
}

TEST(ReferenceArea, KeysTellShapesApart) {
  const ReferenceSettings settings;
  const AreaLight rectangle{Shape::rectangle, 1, 1, {}, {}};
  std::vector<AreaLight> areas(5, rectangle);
  areas[1].shape = Shape::disc;
  areas[2].shape = Shape::sphere;
  areas[3] = polygon_light({{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}});
  areas[4] = polygon_light({{-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}});
  std::vector<std::string> keys;
  for (const AreaLight& area : areas) keys.push_back(reference_key(half_plane(area), settings));
  Scene textured = half_plane(rectangle);
  textured.textures.push_back({});
  keys.push_back(reference_key(textured, settings));
  textured.lights[0].area->emission = 0;
  keys.push_back(reference_key(textured, settings));
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::unique(keys.begin(), keys.end()), keys.end());
}

// A sphere reaches out of its disc's plane.
TEST(ReferenceArea, FactsKnowTheShapes) {
  const auto facts = [](const AreaLight& area) {
    const Scene scene = half_plane(area);
    return scene_facts(scene, scene.cameras[0], 4.0 / 3);
  };
  EXPECT_EQ(facts({Shape::disc, 1.5, 1.5, {}, {}}).light_size[0], 1.5);
  EXPECT_EQ(facts(polygon_light({{0, 0}, {0.25, 0}, {0, 1}})).light_size[0], 2.0);
  EXPECT_EQ(facts({Shape::sphere, 1, 1, {}, {}}).shadowless[0], "");
}

// A shadow that misses the receiver under a point, and whose penumbra does not.
TEST(ReferenceArea, FactsKnowHowFarSizesReach) {
  const auto facts = [](Light l, const std::optional<AreaLight>& area) {
    Scene scene;
    add(scene, square(1), {0, 0, 0});
    add(scene, square(1), {2.5, blocker_height, 0});
    scene.cameras.push_back(camera({-4, 3, 0}, {0, 0, 0}));
    scene.cameras[0].fov_y = 0.5;
    l.area = area;
    scene.lights.push_back(l);
    return scene_facts(scene, scene.cameras[0], 1, 100);
  };
  const Light sun = light(LightType::directional, {0, 1, 0}), lamp = light(LightType::point, {0, 6, 0});
  EXPECT_EQ(facts(sun, {}).shadowless[0], SceneFacts::no_caster);
  EXPECT_EQ(facts(sun, {}).penumbra[0], 0);
  EXPECT_EQ(facts(sun, {}).light_size[0], 0);
  EXPECT_EQ(facts(sun, angular_disc(5 * degree)).shadowless[0], SceneFacts::no_caster);
  EXPECT_EQ(facts(sun, angular_disc(80 * degree)).shadowless[0], "");
  EXPECT_FALSE(facts(sun, angular_disc(5 * degree)).shines_as_point(0));
  EXPECT_TRUE(facts(sun, angular_disc(1e-6)).shines_as_point(0));
  EXPECT_NEAR(facts(sun, angular_disc(5 * degree)).light_size[0], 2 * std::tan(2.5 * degree), 1e-12);
  const AreaLight bulb{Shape::sphere, 1, 1, {}, {}};
  EXPECT_EQ(facts(lamp, {}).shadowless[0], SceneFacts::no_caster);
  EXPECT_EQ(facts(lamp, AreaLight{Shape::sphere, 6, 6, {}, {}}).shadowless[0], "");
  EXPECT_FALSE(facts(lamp, bulb).shines_as_point(0));
  EXPECT_EQ(facts(lamp, bulb).light_size[0], 1);
}

// Acne and leaks are counted away from edges: of every point on the light's border.
TEST(ReferenceArea, EdgesAreThoseOfTheWholeLight) {
  for (const Shape kind : {Shape::disc, Shape::sphere}) {
    const double radius = 0.8;
    const Scene scene = half_plane({kind, 2 * radius, 2 * radius, {}, {}});
    ReferenceSettings settings;
    settings.width = 80, settings.height = 60, settings.samples = 64;
    const ReferenceTracer tracer(scene);
    const Reference r = tracer.trace(settings);
    std::vector<uint32_t> pixels;
    std::vector<double> edge;
    for (uint32_t i = 0; i < r.depth.size(); ++i) {
      const glm::dvec3 p = glm::dvec3(scene.cameras[0].world_from_camera[3]) + glm::dvec3(r.position[i]);
      if (std::isinf(r.depth[i]) || std::abs(p.y) > 0.5 || glm::length(p) > 3) continue;
      pixels.push_back(i);
      edge.push_back(edge_on_light(p));
    }
    const auto away = tracer.away_from_edges(r, 0, scene.cameras[0], pixels, 2, 256);  // 2 texels are 0.09
    int near = 0, far = 0;
    for (size_t k = 0; k < pixels.size(); ++k) {
      if (std::abs(edge[k]) < radius) {
        EXPECT_FALSE(away[k]) << edge[k];
        ++near;
      }
      if (std::abs(edge[k]) > radius + 0.5) {
        EXPECT_TRUE(away[k]) << edge[k];
        ++far;
      }
    }
    EXPECT_GT(near, 50);
    EXPECT_GT(far, 50);
  }
}

// The generated scene as it is loaded: five lights straight above a plane and a square blocker. The truth is
// a fine grid over each light's bounding rectangle, weighted by emission; of the sphere, seen at most 20
// degrees from below, its disc comes close.
TEST(ReferenceArea, GeneratedShapesAgreeWithBruteForce) {
  namespace s = area_shapes;
  const Scene scene = load_scene(resource_root() / "assets/scenes/area_shapes.glb");
  ASSERT_EQ(scene.lights.size(), 5u);
  ReferenceSettings settings;
  settings.width = 72, settings.height = 54, settings.samples = 256;
  const Reference r = ReferenceTracer(scene).trace(settings);
  for (uint32_t i = 0; i < 5; ++i) {
    const Light& l = scene.lights[i];
    ASSERT_TRUE(l.area.has_value());
    struct Part {
      glm::dvec3 place;
      double weight;
    };
    std::vector<Part> parts;
    double all = 0;
    constexpr int side = 48;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const glm::dvec2 p = place_on(*l.area, {(x + 0.5) / side, (y + 0.5) / side});
        if (!on_light(*l.area, p)) continue;
        parts.push_back({glm::dvec3(l.world_from_light * glm::dvec4(p, 0, 1)),
                         emission_weight(emission_at(scene, *l.area, p))});
        all += parts.back().weight;
      }
    double error = 0;
    int penumbra = 0;
    for (size_t k = 0; k < r.depth.size(); ++k) {
      const glm::dvec3 p = glm::dvec3(scene.cameras[0].world_from_camera[3]) + glm::dvec3(r.position[k]);
      if (std::isinf(r.depth[k]) || p.y > 0.5) continue;
      double seen = 0;
      for (const Part& part : parts) {
        const glm::dvec3 q = p + (part.place - p) * (s::kBlockerHeight / s::kLightHeight);
        if (std::max(std::abs(q.x), std::abs(q.z)) > s::kBlockerHalf) seen += part.weight;
      }
      if (seen == 0 || seen == all) continue;
      ++penumbra;
      error += std::pow(r.visibility[i][k] - seen / all, 2);
    }
    EXPECT_GT(penumbra, 100) << l.name;
    // 256 samples: 0.016 at most; the grid is off by up to half a cell, 0.01.
    EXPECT_LT(std::sqrt(error / penumbra), l.area->shape == Shape::sphere ? 0.03 : 0.018) << l.name;
  }
}

}  // namespace
}  // namespace gnomon
