// A scene in Embree: first hits, and whether a segment is blocked.
#include "engine/truth/ray_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/error.h"
#include "engine/scene/surface.h"

namespace gnomon {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kRounding = 1.0 / (1 << 20);  // of a coordinate: 16 times a float's largest relative error
// Embree takes coordinates up to 1.8e18; less, so that sums of a few stay below. What a loaded scene places
// is nearer to the world's origin than half of it (scene_limits.h).
constexpr double kLargest = 1e16;
// Shadow rays towards a point end just before it, so that a surface touching the light does not put it out.
constexpr float kBeforeLight = 1.0f - 1e-6f;

#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
void init_context(Context* context) { rtcInitRayQueryContext(context); }
#else
using Context = RTCIntersectContext;
void init_context(Context* context) { rtcInitIntersectContext(context); }
#endif

struct RayQuery {
  Context context;  // first: filters receive its address
  bool primary = false;
  TriangleId self;
  glm::dvec3 start{0};  // of shadow rays, exact
  explicit RayQuery(bool is_primary, TriangleId triangle = {}) : primary(is_primary), self(triangle) {
    init_context(&context);
  }
};

#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RayQuery& query, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  rtcIntersect1(scene, &ray, &arguments);
}
void occlude(RTCScene scene, RayQuery& query, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  rtcOccluded1(scene, &ray, &arguments);
}
void occlude(const int* valid, RTCScene scene, RayQuery& query, RTCRay8& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  rtcOccluded8(valid, scene, &rays, &arguments);
}
#else
void intersect(RTCScene scene, RayQuery& query, RTCRayHit& ray) {
  rtcIntersect1(scene, &query.context, &ray);
}
void occlude(RTCScene scene, RayQuery& query, RTCRay& ray) { rtcOccluded1(scene, &query.context, &ray); }
void occlude(const int* valid, RTCScene scene, RayQuery& query, RTCRay8& rays) {
  query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid, scene, &query.context, &rays);
}
#endif

struct Geometry {  // one instance
  const Scene* scene = nullptr;
  const Mesh* mesh = nullptr;
  glm::dmat4 local_from_object{1.0};  // relative to the origin
  glm::dmat4 object_from_local{1.0};
  glm::dmat3 normal_matrix{1.0};
  double extent = 0;      // largest distance of a vertex from the origin
  bool mirrored = false;  // the transform swaps front and back (glTF 2.0, section 3.7.4)
  bool double_sided = false;
  bool alpha_masked = false;
  float cutoff = 0;

  // Corners counter-clockwise seen from the front, with the mesh's own order of vertices when not mirrored.
  void corners(uint32_t triangle, glm::dvec3* p) const {
    for (int k = 0; k < 3; ++k)
      p[k] = glm::dvec3(local_from_object *
                        glm::dvec4(mesh->positions[mesh->indices[3 * size_t{triangle} + k]], 1.0));
  }
  glm::dvec3 front_normal(const glm::dvec3* p) const {  // not normalised
    const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    return mirrored ? -normal : normal;
  }
};

// Is a triangle in front of a ray's start, within its borders? Distances count from the rounding of doubles
// on.
bool ahead(const glm::dvec3* p, const glm::dvec3& from, const glm::dvec3& direction) {
  const glm::dvec3 edge1 = p[1] - p[0], edge2 = p[2] - p[0], to_start = from - p[0];
  const glm::dvec3 across = glm::cross(direction, edge2), turned = glm::cross(to_start, edge1);
  const double determinant = glm::dot(edge1, across);
  const double u = glm::dot(to_start, across) / determinant, v = glm::dot(direction, turned) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && glm::dot(edge2, turned) / determinant > 0;
}

// Clears the hits that do not count; Embree then goes on along the ray.
void filter_hits(const RTCFilterFunctionNArguments* args) {
  const auto* query = reinterpret_cast<const RayQuery*>(args->context);
  const auto* geometry = static_cast<const Geometry*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const uint32_t triangle = RTCHitN_primID(args->hit, args->N, i);
    const auto passes = [&] {
      if (query->self.triangle == triangle && query->self.instance == RTCHitN_geomID(args->hit, args->N, i))
        return true;
      const glm::dvec3 direction(RTCRayN_dir_x(args->ray, args->N, i), RTCRayN_dir_y(args->ray, args->N, i),
                                 RTCRayN_dir_z(args->ray, args->N, i));
      glm::dvec3 p[3];
      if (query->primary && !geometry->double_sided) {
        geometry->corners(triangle, p);
        if (glm::dot(geometry->front_normal(p), direction) >= 0) return true;
      }
      // So near that the rounding of its mesh's vertices may have moved it before the ray's start.
      if (!query->primary &&
          RTCRayN_tfar(args->ray, args->N, i) * glm::length(direction) <= kRounding * geometry->extent) {
        geometry->corners(triangle, p);
        if (!ahead(p, query->start, direction)) return true;
      }
      if (!geometry->alpha_masked) return false;
      const float u = RTCHitN_u(args->hit, args->N, i), v = RTCHitN_v(args->hit, args->N, i);
      return base_alpha(*geometry->scene, *geometry->mesh, triangle, {1 - u - v, u, v}) < geometry->cutoff;
    };
    if (passes()) args->valid[i] = 0;
  }
}

// Of a ray that Embree takes.
bool representable(const glm::dvec3& v) {
  return std::abs(v.x) <= kLargest && std::abs(v.y) <= kLargest && std::abs(v.z) <= kLargest;
}

struct Segment {
  glm::vec3 direction;  // NaN where there is none
  float far;
};

// From a ray's start to its target, a place or (`infinite`) a direction. What is further than Embree's rays
// reach lies beyond all of the scene.
Segment segment(const glm::vec3& start, const glm::dvec3& target, bool infinite) {
  const glm::dvec3 way = infinite ? target : target - glm::dvec3(start);
  if (representable(way)) return {glm::vec3(way), infinite ? kInfinity : kBeforeLight};
  return {glm::vec3(glm::normalize(way)), kInfinity};
}

}  // namespace

struct RayScene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Geometry> geometries;  // index: Embree's geometry ID = instance; fixed in memory once filled
  glm::dvec3 origin{0};

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void check(const char* doing) const {
    const RTCError code = rtcGetDeviceError(device);
    if (code != RTC_ERROR_NONE)
      fail(fmt::format("Embree failed {} (error {})", doing, static_cast<int>(code)));
  }

  void attach(Geometry& geometry, uint32_t id) {
    RTCGeometry target = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const Mesh& mesh = *geometry.mesh;
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        target, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        target, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), mesh.triangles()));
    if (!vertices || !indices) fail("not enough memory to trace the scene");
    for (const glm::vec3& p : mesh.positions) {
      const glm::dvec3 local(geometry.local_from_object * glm::dvec4(p, 1.0));
      if (!representable(local))
        fail(fmt::format("'{}' reaches further than {} from the camera", mesh.name, kLargest),
             geometry.scene->file.string());
      for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(local[k]);
      geometry.extent = std::max(geometry.extent, glm::length(local));
    }
    std::copy_n(mesh.indices.begin(), 3 * mesh.triangles(), indices);
    rtcSetGeometryUserData(target, &geometry);
    if (geometry.alpha_masked || !geometry.double_sided)
      rtcSetGeometryIntersectFilterFunction(target, filter_hits);
    rtcSetGeometryOccludedFilterFunction(target, filter_hits);
    rtcCommitGeometry(target);
    rtcAttachGeometryByID(scene, target, id);
    rtcReleaseGeometry(target);
  }

  double offset(const glm::dvec3& from, TriangleId self) const {
    double size = glm::length(from);
    if (self.instance != TriangleId::none) {
      const Geometry& geometry = geometries[self.instance];
      const glm::dvec3 object = glm::abs(glm::dvec3(geometry.object_from_local * glm::dvec4(from, 1.0)));
      glm::dvec3 rounded(0);  // what the coordinates' roundings come to in the world
      for (int k = 0; k < 3; ++k) rounded += object[k] * glm::abs(glm::dvec3(geometry.local_from_object[k]));
      const double most = std::max({rounded.x, rounded.y, rounded.z});
      if (most <= kLargest) size = std::max(size, most);  // not of an instance that is flat
    }
    return kRounding * size;
  }
};

RayScene::RayScene(const Scene& scene, const glm::dvec3& origin) : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  impl.origin = origin;
  impl.device = rtcNewDevice(nullptr);
  if (!impl.device)
    fail(fmt::format("Embree could not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  impl.scene = rtcNewScene(impl.device);
  rtcSetSceneFlags(impl.scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl.scene, RTC_BUILD_QUALITY_HIGH);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& material = scene.materials[mesh.material];
    Geometry geometry;
    geometry.scene = &scene;
    geometry.mesh = &mesh;
    geometry.local_from_object = instance.world_from_object;
    geometry.local_from_object[3] -= glm::dvec4(impl.origin, 0.0);
    geometry.object_from_local = glm::inverse(geometry.local_from_object);
    const glm::dmat3 linear(instance.world_from_object);
    geometry.mirrored = glm::determinant(linear) < 0;
    geometry.normal_matrix = glm::transpose(glm::inverse(linear));
    geometry.double_sided = material.double_sided;
    geometry.alpha_masked = material.alpha_masked;
    geometry.cutoff = material.alpha_cutoff;
    impl.geometries.push_back(geometry);
  }
  for (uint32_t id = 0; id < impl.geometries.size(); ++id)
    if (impl.geometries[id].mesh->triangles() > 0 && scene.instances[id].visible)
      impl.attach(impl.geometries[id], id);
  impl.check("to load the scene");
  rtcCommitScene(impl.scene);
  impl.check("to build its hierarchy");
}

RayScene::~RayScene() = default;

const glm::dvec3& RayScene::origin() const { return impl_->origin; }
double RayScene::shadow_offset(const glm::dvec3& from, TriangleId self) const {
  return impl_->offset(from, self);
}

std::optional<SurfaceHit> RayScene::first_hit(const glm::dvec3& from, const glm::dvec3& direction,
                                              double t_near) const {
  if (!representable(direction)) return std::nullopt;
  RayQuery query(true);
  RTCRayHit ray{};
  const glm::vec3 org(from), dir(direction);
  ray.ray.org_x = org.x, ray.ray.org_y = org.y, ray.ray.org_z = org.z;
  ray.ray.dir_x = dir.x, ray.ray.dir_y = dir.y, ray.ray.dir_z = dir.z;
  ray.ray.tnear = static_cast<float>(t_near);
  ray.ray.tfar = kInfinity;
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(impl_->scene, query, ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const Geometry& geometry = impl_->geometries[ray.hit.geomID];
  glm::dvec3 p[3];
  geometry.corners(ray.hit.primID, p);
  SurfaceHit hit;
  hit.triangle = {ray.hit.geomID, ray.hit.primID};
  hit.normal = glm::normalize(geometry.front_normal(p));
  hit.distance = ray.ray.tfar;
  // Embree's distance has a float's error; the plane of the triangle in double has not. Edge-on it is
  // ill-conditioned.
  const double refined = glm::dot(hit.normal, p[0] - from) / glm::dot(hit.normal, direction);
  if (std::abs(refined - hit.distance) <= 1e-3 * hit.distance) hit.distance = refined;
  hit.position = from + hit.distance * direction;
  const Barycentric weights(1 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v);
  hit.albedo = glm::vec3(base_color(*geometry.scene, *geometry.mesh, ray.hit.primID, weights));
  hit.shading_normal =
      interpolated_normal(*geometry.mesh, ray.hit.primID, weights, geometry.normal_matrix, hit.normal);
  if (geometry.double_sided && glm::dot(hit.normal, direction) > 0) hit.normal = -hit.normal;
  if (glm::dot(glm::dvec3(hit.shading_normal), hit.normal) < 0) hit.shading_normal = -hit.shading_normal;
  return hit;
}

bool RayScene::occluded(const glm::dvec3& from, const glm::dvec3& normal, const ShadowTarget& target,
                        TriangleId self) const {
  RayQuery query(false, self);
  RTCRay ray{};
  query.start = from + impl_->offset(from, self) * normal;
  const glm::vec3 org(query.start);
  const auto [dir, far] = segment(org, target.value, target.infinite);
  if (std::isnan(dir.x)) return true;
  ray.org_x = org.x, ray.org_y = org.y, ray.org_z = org.z;
  ray.dir_x = dir.x, ray.dir_y = dir.y, ray.dir_z = dir.z;
  ray.tfar = far;
  ray.mask = ~0u;
  occlude(impl_->scene, query, ray);
  return ray.tfar < 0;
}

uint32_t RayScene::occluded(const glm::dvec3& from, const glm::dvec3& normal, const glm::dvec3* targets,
                            int count, bool infinite, TriangleId self) const {
  RayQuery query(false, self);
  RTCRay8 rays{};
  alignas(32) int valid[packet];
  query.start = from + impl_->offset(from, self) * normal;
  const glm::vec3 org(query.start);
  for (int i = 0; i < packet; ++i) {
    valid[i] = i < count ? -1 : 0;
    if (i >= count) continue;
    const auto [dir, far] = segment(org, targets[i], infinite);
    if (std::isnan(dir.x)) {
      valid[i] = 0, rays.tfar[i] = -kInfinity;  // blocked
      continue;
    }
    rays.org_x[i] = org.x, rays.org_y[i] = org.y, rays.org_z[i] = org.z;
    rays.dir_x[i] = dir.x, rays.dir_y[i] = dir.y, rays.dir_z[i] = dir.z;
    rays.tfar[i] = far;
    rays.mask[i] = ~0u;
  }
  occlude(valid, impl_->scene, query, rays);
  uint32_t mask = 0;
  for (int i = 0; i < count; ++i) mask |= rays.tfar[i] < 0 ? 1u << i : 0u;
  return mask;
}

}  // namespace gnomon
