// The ray-traced reference against closed forms.
#include "engine/truth/reference.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/error.h"
#include "engine/light/light_view.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

using namespace analytic;

constexpr uint32_t width = 160, height = 120;

Reference trace(const Scene& scene, uint32_t samples = 0) {
  ReferenceSettings settings;
  settings.width = width, settings.height = height, settings.samples = samples;
  return ReferenceTracer(scene).trace(settings);
}

glm::dvec3 world_position(const Scene& scene, const Reference& r, size_t i) {
  return glm::dvec3(scene.cameras[0].world_from_camera[3]) + glm::dvec3(r.position[i]);
}

// Calls f(pixel, point) for the pixels that show the plane y = 0; returns their number.
template <typename F>
int for_ground(const Scene& scene, const Reference& r, const F& f) {
  int count = 0;
  for (size_t i = 0; i < r.depth.size(); ++i) {
    const glm::dvec3 p = world_position(scene, r, i);
    if (std::isinf(r.depth[i]) || std::abs(p.y) > 0.5) continue;
    ++count;
    f(i, p);
  }
  return count;
}

// The point where the line from `light` through the ground point `p` passes the blocker's height.
glm::dvec3 at_blocker(const glm::dvec3& light, const glm::dvec3& p) {
  return p + (light - p) * (blocker_height / light.y);
}

// Signed distance of a point to the border of the blocker in its plane: positive outside.
double outside_blocker(const glm::dvec3& q) { return std::max(std::abs(q.x), std::abs(q.z)) - blocker_half; }

// Ground pixels are lit exactly when their ray to the light misses the square.
void expect_square_shadow(const Scene& scene, const Reference& r,
                          const std::function<glm::dvec3(const glm::dvec3&)>& cross) {
  int lit = 0, dark = 0, near = 0;
  for_ground(scene, r, [&](size_t i, const glm::dvec3& p) {
    EXPECT_NEAR(p.y, 0, 2e-6);
    const double d = outside_blocker(cross(p));
    if (std::abs(d) < 1e-4) {
      ++near;
      return;
    }
    EXPECT_EQ(r.visibility[0][i], d > 0 ? 1.0f : 0.0f) << p.x << ' ' << p.z;
    ++(d > 0 ? lit : dark);
  });
  EXPECT_GT(lit, 5000);
  EXPECT_GT(dark, 200);
  EXPECT_LT(near, 10);
}

TEST(Reference, SquareOverPlanePointLight) {
  const glm::dvec3 at(0.3, 6, -0.4);
  for (const LightType type : {LightType::spot, LightType::point}) {
    const Scene scene = square_over_plane(light(type, at));
    expect_square_shadow(scene, trace(scene), [&](const glm::dvec3& p) { return at_blocker(at, p); });
  }
}

TEST(Reference, SquareOverPlaneDirectionalLight) {
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0.3, 1, -0.2));
  const Scene scene = square_over_plane(light(LightType::directional, towards));
  const Reference r = trace(scene);
  expect_square_shadow(scene, r,
                       [&](const glm::dvec3& p) { return p + towards * (blocker_height / towards.y); });
  for (const uint8_t domain : r.domain[0]) EXPECT_NE(domain, Reference::outside_light);
}

TEST(Reference, DepthNormalAndPositionBelongTogether) {
  const Scene scene = square_over_plane(light(LightType::point, {0, 6, 0}));
  const Reference r = trace(scene);
  const glm::dvec3 forward = -glm::dvec3(scene.cameras[0].world_from_camera[2]);
  for (size_t i = 0; i < r.depth.size(); ++i) {
    if (std::isinf(r.depth[i])) continue;
    EXPECT_NEAR(glm::dot(glm::dvec3(r.position[i]), forward), r.depth[i], 1e-5);
    EXPECT_EQ(r.normal[i], glm::vec3(0, 1, 0));
    EXPECT_EQ(r.shading_normal[i], glm::vec3(0, 1, 0));
    EXPECT_EQ(r.albedo[i], glm::vec3(1));
  }
}

// The ray from p to the light L meets the sphere (centre C, radius r) when the angle at L between p and C is
// below asin(r / |C - L|): on the plane an ellipse.
TEST(Reference, SphereOverPlane) {
  const glm::dvec3 at(-1, 7, 1), centre(0, 2, 0);
  Scene scene;
  add(scene, square(20), {0, 0, 0});
  add(scene, sphere(1, 256, 512), centre);
  scene.cameras.push_back(camera({6, 8, 7}, {0, 0, 0}));
  scene.lights.push_back(light(LightType::point, at));
  const Reference r = trace(scene);
  const double umbra = std::asin(1 / glm::length(centre - at));
  int dark = 0, near = 0;
  for_ground(scene, r, [&](size_t i, const glm::dvec3& p) {
    const double angle = std::acos(glm::dot(glm::normalize(p - at), glm::normalize(centre - at)));
    // The polyhedron is inscribed: its radius is 1 - cos(pi / 256) = 7.5e-5 short at most.
    if (std::abs(angle - umbra) < 1e-4) {
      ++near;
      return;
    }
    EXPECT_EQ(r.visibility[0][i], angle > umbra ? 1.0f : 0.0f) << p.x << ' ' << p.z;
    dark += angle < umbra;
  });
  EXPECT_GT(dark, 150);
  EXPECT_LT(near, 20);
}

// A convex body never shadows what faces the light on it: every pixel of the sphere is lit or faces away.
TEST(Reference, ConvexBodiesHaveNoAcne) {
  Scene scene;
  add(scene, sphere(1, 64, 128), {0, 0, 0});
  scene.cameras.push_back(camera({0.3, 0.2, 3}, {0, 0, 0}));
  scene.lights.push_back(light(LightType::point, {5, 3, 2}));
  const Reference r = trace(scene);
  int counted = 0;
  for (size_t i = 0; i < r.depth.size(); ++i) {
    if (r.domain[0][i] != Reference::counted) continue;
    ++counted;
    EXPECT_EQ(r.visibility[0][i], 1.0f);
  }
  EXPECT_GT(counted, 1000);
}

// Share of a rectangular light (centre c, sides w along x and h along z, at height c.y) that a ground point
// sees past the square: the square projected from the point on the light's plane, overlap separable in x and
// z.
double visible_share(const glm::dvec3& c, double w, double h, const glm::dvec3& p) {
  const double scale = c.y / blocker_height;
  const auto overlap = [&](double centre, double side, double from) {
    const double low = from + (-blocker_half - from) * scale, high = from + (blocker_half - from) * scale;
    return std::max(0.0, std::min(high, centre + side / 2) - std::max(low, centre - side / 2)) / side;
  };
  return 1 - overlap(c.x, w, p.x) * overlap(c.z, h, p.z);
}

struct AreaError {
  double rmse = 0, max = 0, noise_floor = 0;
  int penumbra = 0;
};

AreaError area_error(uint32_t samples) {
  const glm::dvec3 at(0.25, 6, -0.5);
  Light l = light(LightType::spot, at, {0.25, 0, -0.5});
  l.area = AreaLight{AreaLight::Shape::rectangle, 1.6, 1.1, {}, {}};
  const Scene scene = square_over_plane(l);
  const Reference r = trace(scene, samples);
  EXPECT_EQ(r.samples, samples);
  AreaError e;
  e.noise_floor = r.noise_floor;
  for_ground(scene, r, [&](size_t i, const glm::dvec3& p) {
    const double truth = visible_share(at, 1.6, 1.1, p), error = r.visibility[0][i] - truth;
    if (truth < 1e-4 || truth > 1 - 1e-4) {
      EXPECT_NEAR(r.visibility[0][i], truth, 2e-3);
      return;
    }
    ++e.penumbra;
    e.rmse += error * error;
    e.max = std::max(e.max, std::abs(error));
  });
  e.rmse = std::sqrt(e.rmse / e.penumbra);
  return e;
}

// Randomised nets have a standard error of at most about N^(-3/4) for a region with a smooth border: 0.0055
// and 0.0020.
TEST(Reference, SquareAreaLightOverSquare) {
  const AreaError few = area_error(64), many = area_error(1024), most = area_error(4096);
  EXPECT_GT(many.penumbra, 500);
  EXPECT_LT(few.rmse, 0.045);
  EXPECT_LT(many.rmse, 0.0055);
  EXPECT_LT(most.rmse, 0.0020);
  EXPECT_LT(many.max, 0.03);
  EXPECT_LT(most.max, 0.01);
  for (const AreaError& e : {few, many, most}) {  // the stated floor is not below the error, nor far above it
    EXPECT_GE(e.noise_floor, 0.9 * e.rmse);
    EXPECT_LE(e.noise_floor, 6 * e.rmse);
  }
  RecordProperty("rmse_1024", std::to_string(many.rmse));
}

TEST(Reference, AreaSamplesRepeat) {
  Light l = light(LightType::spot, {0.25, 6, -0.5});
  l.area = AreaLight{AreaLight::Shape::rectangle, 1.6, 1.1, {}, {}};
  const Scene scene = square_over_plane(l);
  EXPECT_EQ(trace(scene, 32).visibility, trace(scene, 32).visibility);
  EXPECT_EQ(trace(scene, 0).noise_floor, 0);
  EXPECT_EQ(trace(scene, 0).samples, 1u);
}

TEST(Reference, FacesAwayIsDark) {
  const Scene scene = square_over_plane(light(LightType::point, {0.5, -3, 0.25}));
  const Reference r = trace(scene);
  for (size_t i = 0; i < r.depth.size(); ++i) {
    if (std::isinf(r.depth[i])) {
      EXPECT_EQ(r.domain[0][i], Reference::no_geometry);
      EXPECT_EQ(r.visibility[0][i], 1.0f);
    } else {
      EXPECT_EQ(r.domain[0][i], Reference::faces_away);
      EXPECT_EQ(r.visibility[0][i], 0.0f);
    }
  }
}

TEST(Reference, NoGeometryIsInfinitelyFarAndLit) {
  Scene scene = square_over_plane(light(LightType::point, {0, 6, 0}));
  scene.cameras[0] = camera({0, 8, 0.1}, {0, 20, 0});
  const Reference r = trace(scene);
  for (size_t i = 0; i < r.depth.size(); ++i) {
    EXPECT_TRUE(std::isinf(r.depth[i]));
    EXPECT_EQ(r.domain[0][i], Reference::no_geometry);
    EXPECT_EQ(r.visibility[0][i], 1.0f);
  }
}

// A spot at height 6 that looks straight down: its square frustum ends at |x|, |z| = 6 tan(fov / 2), its cone
// at radius 6 tan(outer), its range at a distance. Outside, visibility is traced all the same.
TEST(Reference, OutsideOfTheSpot) {
  Light l = light(LightType::spot, {0, 6, 0});
  l.map_fov = 0.9;
  l.outer_cone = 0.6;
  l.range = 6.8;
  const Scene scene = square_over_plane(l);
  const Reference r = trace(scene);
  const double half = 6 * std::tan(0.45), radius = 6 * std::tan(0.6);
  int seen[4] = {};
  for_ground(scene, r, [&](size_t i, const glm::dvec3& p) {
    const double square = half - std::max(std::abs(p.x), std::abs(p.z));
    const double cone = radius - std::hypot(p.x, p.z), range = 6.8 - std::hypot(p.x, 6.0, p.z);
    const double inside = std::min({square, cone, range});
    if (std::abs(inside) < 1e-4) return;
    EXPECT_EQ(r.domain[0][i], inside > 0 ? Reference::counted : Reference::outside_light)
        << p.x << ' ' << p.z;
    EXPECT_EQ(r.visibility[0][i], outside_blocker(at_blocker({0, 6, 0}, p)) > 0 ? 1.0f : 0.0f);
    ++seen[inside > 0 ? 0 : square < 0 ? 1 : cone < 0 ? 2 : 3];
  });
  EXPECT_GT(seen[0], 100);
  EXPECT_GT(seen[1], 100);
  EXPECT_GT(seen[2] + seen[3], 20);
}

TEST(Reference, SingleSidedBlockersAreSeenThroughFromBehindButCast) {
  const glm::dvec3 at(0.3, 6, -0.4);
  Scene scene = square_over_plane(light(LightType::point, at));
  scene.meshes[1] = square(blocker_half, false);
  scene.meshes[1].material = 1;
  const Reference culled = trace(scene);
  expect_square_shadow(scene, culled, [&](const glm::dvec3& p) { return at_blocker(at, p); });
  for (size_t i = 0; i < culled.depth.size(); ++i)
    if (!std::isinf(culled.depth[i])) {
      EXPECT_NEAR(world_position(scene, culled, i).y, 0, 1e-5);
    }

  scene.materials[1].double_sided = true;  // now it is seen, its normal turned to the camera
  const Reference seen = trace(scene);
  int blocker = 0;
  for (size_t i = 0; i < seen.depth.size(); ++i) {
    if (std::isinf(seen.depth[i]) || world_position(scene, seen, i).y < 1) continue;
    ++blocker;
    EXPECT_EQ(seen.normal[i], glm::vec3(0, 1, 0));
    EXPECT_EQ(seen.shading_normal[i], glm::vec3(0, 1, 0));
    EXPECT_EQ(seen.domain[0][i], Reference::counted);
    EXPECT_EQ(seen.visibility[0][i], 1.0f);
  }
  EXPECT_GT(blocker, 200);
}

TEST(Reference, MirroredInstancesKeepTheirFront) {
  const glm::dvec3 at(0.3, 6, -0.4);
  Scene scene = square_over_plane(light(LightType::point, at));
  for (Instance& instance : scene.instances)
    instance.world_from_object =
        instance.world_from_object * glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1));
  const Reference r = trace(scene);
  expect_square_shadow(scene, r, [&](const glm::dvec3& p) { return at_blocker(at, p); });
  EXPECT_EQ(r.normal, trace(square_over_plane(light(LightType::point, at))).normal);
}

Texture alpha_texture(uint32_t w, uint32_t h, const std::vector<uint8_t>& alpha) {
  Texture t;
  t.width = w, t.height = h;
  t.wrap_u = t.wrap_v = Wrap::clamp;
  for (const uint8_t a : alpha) t.rgba.insert(t.rgba.end(), {255, 188, 0, a});
  return t;
}

Scene masked_square(Texture texture, const glm::dvec3& at, float factor = 1) {
  Scene scene = square_over_plane(light(LightType::point, at));
  scene.textures.push_back(std::move(texture));
  scene.materials[1].base_color_texture = 0;
  scene.materials[1].alpha_masked = true;
  scene.materials[1].base_color.a = factor;
  return scene;
}

// Texel (0, 0) and (1, 1) are holes: the blocker is there where x and z have different signs.
TEST(Reference, AlphaMaskNearest) {
  const glm::dvec3 at(0.3, 6, -0.4);
  Texture texture = alpha_texture(2, 2, {0, 255, 255, 0});
  texture.nearest = true;
  const Scene scene = masked_square(texture, at);
  const Reference r = trace(scene);
  int dark = 0;
  for_ground(scene, r, [&](size_t i, const glm::dvec3& p) {
    const glm::dvec3 q = at_blocker(at, p);
    if (std::abs(outside_blocker(q)) < 1e-4 || std::min(std::abs(q.x), std::abs(q.z)) < 1e-4) return;
    const bool covered = outside_blocker(q) < 0 && q.x * q.z < 0;
    EXPECT_EQ(r.visibility[0][i], covered ? 0.0f : 1.0f) << q.x << ' ' << q.z;
    dark += covered;
  });
  EXPECT_GT(dark, 100);
  // The camera's rays pass the holes too; what stays shows the texture's colour: 188 in sRGB is 0.5029
  // linear.
  int blocker = 0;
  for (size_t i = 0; i < r.depth.size(); ++i) {
    const glm::dvec3 p = world_position(scene, r, i);
    if (std::isinf(r.depth[i]) || p.y < 1) continue;
    ++blocker;
    EXPECT_LT(p.x * p.z, 1e-6);
    EXPECT_NEAR(r.albedo[i].g, 0.5029, 1e-4);
    EXPECT_EQ(r.albedo[i].b, 0);
  }
  EXPECT_GT(blocker, 50);
}

// Two texels 0 and 255 along u, clamped: alpha = clamp(2 u - 0.5, 0, 1) x factor. It reaches the cutoff 0.5
// at u = 0.5, and with the factor 0.625 (alpha 0.8) at u = 0.65, x = 0.3.
TEST(Reference, AlphaMaskBilinearAndFactor) {
  const glm::dvec3 at(0.3, 6, -0.4);
  for (const auto& [factor, edge] : {std::pair{1.0f, 0.0}, {0.625f, 0.3}}) {
    const Scene scene = masked_square(alpha_texture(2, 1, {0, 255}), at, factor);
    const Reference r = trace(scene);
    for_ground(scene, r, [&, edge = edge](size_t i, const glm::dvec3& p) {
      const glm::dvec3 q = at_blocker(at, p);
      if (std::abs(outside_blocker(q)) < 1e-4 || std::abs(q.x - edge) < 1e-4) return;
      EXPECT_EQ(r.visibility[0][i], outside_blocker(q) < 0 && q.x > edge ? 0.0f : 1.0f) << q.x << ' ' << q.z;
    });
  }
}

TEST(Reference, FarFromTheOriginIsTheSame) {
  const glm::dvec3 at(0.3, 6, -0.4);
  const Scene near = square_over_plane(light(LightType::spot, at));
  const Reference a = trace(near);
  for (const glm::dvec3& by : {glm::dvec3(1e6, -1e6, 1e6), glm::dvec3(6.4e6, 0, 0)}) {
    const Reference b = trace(moved(near, by));
    EXPECT_EQ(a.visibility, b.visibility);
    EXPECT_EQ(a.domain, b.domain);
    for (size_t i = 0; i < a.depth.size(); ++i)
      if (!std::isinf(a.depth[i])) {
        EXPECT_NEAR(glm::length(a.position[i] - b.position[i]), 0, 1e-5);
      }
  }
}

TEST(Reference, SurfacesInFrontOfTheNearPlaneAreNotSeen) {
  Scene scene = square_over_plane(light(LightType::point, {0.3, 6, -0.4}));
  scene.cameras[0] = camera({0, 4, 0.01}, {0, 0, 0});
  scene.cameras[0].near = 2.5;  // past the blocker, 2 below the camera
  const Reference r = trace(scene);
  for (const float depth : r.depth) EXPECT_GT(depth, 3.9f);
}

TEST(Reference, SeveralLightsHaveTheirOwnPlanes) {
  Scene scene = square_over_plane(light(LightType::point, {0.3, 6, -0.4}));
  scene.lights.push_back(light(LightType::directional, {0.3, 1, -0.2}));
  const Reference both = trace(scene);
  ASSERT_EQ(both.lights, 2u);
  scene.lights.erase(scene.lights.begin());
  EXPECT_EQ(both.visibility[1], trace(scene).visibility[0]);
}

TEST(Reference, BadSettings) {
  const Scene scene = square_over_plane(light(LightType::point, {0, 6, 0}));
  const ReferenceTracer tracer(scene);
  ReferenceSettings settings;
  settings.width = 0;
  EXPECT_THROW(tracer.trace(settings), Error);
  settings.width = 1u << 20;
  EXPECT_THROW(tracer.trace(settings), Error);
  settings.width = 8;
  settings.camera = 1;
  EXPECT_THROW(tracer.trace(settings), Error);
  EXPECT_THROW(reference_key(scene, settings), Error);
}

TEST(Reference, ProgressEndsAtOne) {
  const Scene scene = square_over_plane(light(LightType::point, {0, 6, 0}));
  double last = 0;
  ReferenceSettings settings;
  settings.width = settings.height = 16;
  settings.progress = [&](double p) {
    EXPECT_GE(p, last);
    last = p;
  };
  ReferenceTracer(scene).trace(settings);
  EXPECT_EQ(last, 1.0);
  settings.progress = [](double) { fail("stopped"); };
  EXPECT_THROW(ReferenceTracer(scene).trace(settings), Error);
}

// A light straight above at height 6 with a frustum of 90 degrees and 128 texels: on the ground a texel is
// 2 x 6 / 128 = 0.09375 wide, the umbra's border is at |x|, |z| = 1.5. Two texels are 0.1875.
TEST(AwayFromEdges, KnownDistancesToAStraightEdge) {
  for (const LightType type : {LightType::spot, LightType::point}) {
    const Scene scene = square_over_plane(light(type, {0, 6, 0}));
    const Reference r = trace(scene);
    std::vector<uint32_t> pixels;
    std::vector<double> distances;
    for_ground(scene, r, [&](size_t i, const glm::dvec3& p) {
      if (std::abs(p.z) > 1.2 || std::abs(p.x) > 5) return;  // far from corners
      pixels.push_back(static_cast<uint32_t>(i));
      distances.push_back(std::abs(std::abs(p.x) - 1.5));
    });
    ASSERT_GT(pixels.size(), 300u);
    const ReferenceTracer tracer(scene);
    const auto away = tracer.away_from_edges(r, 0, scene.cameras[0], pixels, 2, 128);
    const auto further = tracer.away_from_edges(r, 0, scene.cameras[0], pixels, 8, 128);  // 0.75
    int near = 0;
    for (size_t k = 0; k < pixels.size(); ++k) {
      // Inside, the edges in z are also there: |z| <= 1.2 keeps 0.3 from them.
      if (std::abs(distances[k] - 0.1875) > 2e-3) {
        EXPECT_EQ(away[k], distances[k] > 0.1875) << distances[k];
      }
      near += !away[k];
      const bool outside = r.visibility[0][pixels[k]] == 1;
      if (outside && std::abs(distances[k] - 0.75) > 2e-3) {
        EXPECT_EQ(further[k], distances[k] > 0.75) << distances[k];
      }
    }
    EXPECT_GT(near, 20);
  }
}

// One texel of an orthographic map of n texels is the extent over n: twice the texels, half the distance.
TEST(AwayFromEdges, DirectionalLight) {
  const Scene scene = square_over_plane(light(LightType::directional, {0, 1, 0}));
  const LightView face = light_views(scene, 256, 0).at(0);
  const double texel = 2 * face.half_width / 256;
  const Reference r = trace(scene);
  std::vector<uint32_t> pixels;
  std::vector<double> distances;
  for_ground(scene, r, [&](size_t i, const glm::dvec3& p) {
    if (std::abs(p.z) > 0.4 || std::abs(p.x) > 4) return;
    pixels.push_back(static_cast<uint32_t>(i));
    distances.push_back(std::abs(std::abs(p.x) - blocker_half));
  });
  const auto away = ReferenceTracer(scene).away_from_edges(r, 0, scene.cameras[0], pixels, 2, 256);
  // The map may be turned about its axis: the disc of radius 2 texels touches the edge all the same, up to
  // the grid's half texel.
  for (size_t k = 0; k < pixels.size(); ++k) {
    if (distances[k] > 2 * texel + 1e-3) {
      EXPECT_TRUE(away[k]) << distances[k];
    }
    if (distances[k] < 1.5 * texel - 1e-3) {
      EXPECT_FALSE(away[k]) << distances[k];
    }
  }
}

TEST(AwayFromEdges, PixelsWithoutAnEdgeQuestionAreNotAway) {
  const Scene scene = square_over_plane(light(LightType::spot, {0, 6, 0}));
  Reference r = trace(scene);
  const ReferenceTracer tracer(scene);
  const uint32_t centre = height / 2 * width + width / 2;
  r.domain[0][centre] = Reference::faces_away;
  EXPECT_FALSE(tracer.away_from_edges(r, 0, scene.cameras[0], {centre}, 2, 128)[0]);
  r.domain[0][centre] = Reference::counted;
  r.visibility[0][centre] = 0.5f;  // in a penumbra
  EXPECT_FALSE(tracer.away_from_edges(r, 0, scene.cameras[0], {centre}, 2, 128)[0]);
  EXPECT_THROW(tracer.away_from_edges(r, 1, scene.cameras[0], {centre}, 2, 128), Error);
  EXPECT_THROW(tracer.away_from_edges(r, 0, scene.cameras[0], {centre}, 2, 0), Error);
}

void expect_equal(const Reference& a, const Reference& b) {
  EXPECT_EQ(a.visibility, b.visibility);
  EXPECT_EQ(a.domain, b.domain);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.shading_normal, b.shading_normal);
  EXPECT_EQ(a.albedo, b.albedo);
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_FLOAT_EQ(static_cast<float>(a.noise_floor), static_cast<float>(b.noise_floor));
}

class ReferenceCache : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("gnomon_reference_" + std::to_string(::getpid()));
};

TEST_F(ReferenceCache, ImagesKeepEverything) {
  Light l = light(LightType::spot, {0.25, 6, -0.5});
  l.area = AreaLight{AreaLight::Shape::rectangle, 1.6, 1.1, {}, {}};
  Scene scene = square_over_plane(l);
  scene.lights.push_back(light(LightType::directional, {0.3, 1, -0.2}));
  const Reference r = trace(scene, 16);
  EXPECT_GT(r.noise_floor, 0);
  std::filesystem::create_directories(folder_);
  write_exr(folder_ / "r.exr", to_image(r));
  expect_equal(r, reference_from_image(read_exr(folder_ / "r.exr"), folder_ / "r.exr"));
}

TEST_F(ReferenceCache, OtherImagesAreRefusedByName) {
  try {
    reference_from_image(Image(2, 2, {"Y"}), "some/result.exr");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("some/result.exr"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("domain"), std::string::npos);
  }
  Image image = to_image(trace(square_over_plane(light(LightType::point, {0, 6, 0}))));
  image.data[0] = std::nanf("");
  EXPECT_THROW(reference_from_image(image, "nan.exr"), Error);
}

TEST_F(ReferenceCache, ReadsBackAndTracesAgainWhenBroken) {
  const Scene scene = square_over_plane(light(LightType::point, {0.3, 6, -0.4}));
  ReferenceSettings settings;
  settings.width = 40, settings.height = 30;
  int traced = 0;
  settings.progress = [&](double p) { traced += p == 1.0; };
  const auto ask = [&] {
    traced = 0;
    return cached_reference(scene, settings, folder_);
  };
  const Reference first = ask();
  EXPECT_GT(traced, 0);
  const auto file = folder_ / (reference_key(scene, settings) + ".exr");
  EXPECT_TRUE(std::filesystem::exists(file));
  expect_equal(first, ask());
  EXPECT_EQ(traced, 0);
  std::filesystem::resize_file(file, 1000);
  expect_equal(first, ask());
  EXPECT_GT(traced, 0);
  expect_equal(first, ask());
  EXPECT_EQ(traced, 0);
}

TEST_F(ReferenceCache, UnusableFolderOnlyWarns) {
  const Scene scene = square_over_plane(light(LightType::point, {0.3, 6, -0.4}));
  ReferenceSettings settings;
  settings.width = settings.height = 8;
  EXPECT_EQ(cached_reference(scene, settings, "/dev/null/cache").width, 8u);
}

TEST_F(ReferenceCache, KeyDependsOnWhatTheRaysSee) {
  const Scene scene = square_over_plane(light(LightType::spot, {0.3, 6, -0.4}));
  const ReferenceSettings settings;
  const std::string key = reference_key(scene, settings);
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(reference_key(scene, settings), key);
  const auto changed = [&](const auto& change) {
    Scene other = scene;
    ReferenceSettings other_settings = settings;
    change(other, other_settings);
    return reference_key(other, other_settings) != key;
  };
  using S = Scene;
  using R = ReferenceSettings;
  EXPECT_TRUE(changed([](S& s, R&) {
    s.meshes[0].positions[0].x += 1e-6f;
    s.meshes[0].positions[0].x -= 0.1f;
  }));
  EXPECT_TRUE(changed([](S& s, R&) { s.instances[1].world_from_object[3].y += 1e-9; }));
  EXPECT_TRUE(changed([](S& s, R&) { s.materials[1].alpha_masked = true; }));
  EXPECT_TRUE(changed([](S& s, R&) { s.materials[1].double_sided = true; }));
  EXPECT_TRUE(changed([](S& s, R&) { s.cameras[0].fov_y = 1; }));
  EXPECT_TRUE(changed([](S& s, R&) { s.cameras[0].aspect = 1.5; }));
  EXPECT_TRUE(changed([](S& s, R&) { s.lights[0].map_fov = 1; }));
  EXPECT_TRUE(changed([](S& s, R&) { s.lights[0].type = LightType::point; }));
  EXPECT_TRUE(changed([](S& s, R&) {
    s.lights[0].area = AreaLight{AreaLight::Shape::rectangle, 1, 1, {}, {}};
  }));
  EXPECT_TRUE(changed([](S&, R& r) { r.width = 640; }));
  EXPECT_TRUE(changed([](S&, R& r) { r.samples = 64; }));
  EXPECT_FALSE(changed([](S& s, R&) { s.lights[0].intensity = 7; }));
  EXPECT_FALSE(changed([](S& s, R&) { s.name = "other"; }));
}

}  // namespace
}  // namespace gnomon
