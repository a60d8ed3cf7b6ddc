// References as images, and their cache.
#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "engine/base/error.h"
#include "engine/base/printable.h"
#include "engine/truth/reference.h"
#include "engine/truth/reference_tracer.h"

namespace gnomon {
namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
constexpr std::array<const char*, 3> kColors = {"R", "G", "B"};

std::string light_prefix(size_t light) { return light == 0 ? "" : fmt::format("light{}.", light); }

// Adds planes one after the other.
class PlaneWriter {
 public:
  PlaneWriter(Image& image) : image_(image) {}
  template <typename T>
  void scalar(const std::vector<T>& values) {
    const auto plane = image_.plane(next_++);
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(values[i]);
  }
  void constant(double value) {
    const auto plane = image_.plane(next_++);
    std::fill(plane.begin(), plane.end(), static_cast<float>(value));
  }
  void vector(const std::vector<glm::vec3>& values) {
    for (int k = 0; k < 3; ++k) {
      const auto plane = image_.plane(next_++);
      for (size_t i = 0; i < plane.size(); ++i) plane[i] = values[i][k];
    }
  }

 private:
  Image& image_;
  size_t next_ = 0;
};

std::vector<std::string> channel_names(size_t lights) {
  std::vector<std::string> names;
  for (size_t i = 0; i < lights; ++i) {
    names.push_back(light_prefix(i) + "Y");
    names.push_back(light_prefix(i) + "domain");
  }
  names.insert(names.end(), {"Z", "samples", "noise_floor"});
  for (const char* axis : kAxes) names.push_back(fmt::format("N.{}", axis));
  for (const char* axis : kAxes) names.push_back(fmt::format("P.{}", axis));
  for (const char* axis : kAxes) names.push_back(fmt::format("Ns.{}", axis));
  for (const char* color : kColors) names.push_back(fmt::format("albedo.{}", color));
  return names;
}

class PlaneReader {
 public:
  PlaneReader(const Image& image, std::string file) : image_(image), file_(std::move(file)) {}

  std::span<const float> plane(const std::string& name) const {
    if (!image_.has(name))
      fail("not a reference image: a channel is missing", file_, name, "written by 'gnomon reference'");
    return image_.plane(name);
  }
  std::vector<float> scalar(const std::string& name, float low, float high) const {
    const auto values = plane(name);
    for (const float v : values)
      if (!(v >= low && v <= high))
        fail(fmt::format("not a reference image: value {} outside [{}, {}]", v, low, high), file_, name);
    return {values.begin(), values.end()};
  }
  // A figure stored as a constant plane.
  double constant(const std::string& name, double low, double high) const {
    const double value = plane(name)[0];
    if (!(value >= low && value <= high))
      fail(fmt::format("not a reference image: bad value {}", value), file_, name);
    return value;
  }
  std::vector<glm::vec3> vector(const std::string& name, const std::array<const char*, 3>& parts) const {
    std::vector<glm::vec3> result(size_t{image_.width} * image_.height);
    for (int k = 0; k < 3; ++k) {
      const auto values = plane(fmt::format("{}.{}", name, parts[k]));
      for (size_t i = 0; i < result.size(); ++i) result[i][k] = values[i];
    }
    return result;
  }

 private:
  const Image& image_;
  std::string file_;
};

// Hashes values field by field, so that padding never counts.
class KeyHash {
 public:
  KeyHash() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_);
  }
  KeyHash(const KeyHash&) = delete;
  KeyHash& operator=(const KeyHash&) = delete;
  ~KeyHash() { XXH3_freeState(state_); }

  void bytes(const void* data, size_t size) { XXH3_128bits_update(state_, data, size); }
  template <typename T>
  void value(T v) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
    bytes(&v, sizeof v);
  }
  void values(const glm::dmat4& m) { bytes(&m, sizeof m); }
  void values(const glm::vec4& v) { bytes(&v, sizeof v); }
  template <typename T>
  void array(const std::vector<T>& v) {  // element types without padding: float vectors, integers
    value(uint64_t{v.size()});
    bytes(v.data(), v.size() * sizeof(T));
  }
  std::string text() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  XXH3_state_t* state_;
};

void hash_mesh(KeyHash& hash, const Mesh& mesh) {
  hash.array(mesh.positions);
  hash.array(mesh.normals);
  hash.array(mesh.uvs);
  hash.array(mesh.colors);
  hash.array(mesh.indices);
  hash.value(mesh.material);
}

void hash_material(KeyHash& hash, const Material& m) {
  hash.values(m.base_color);
  hash.value(m.base_color_texture ? int64_t{*m.base_color_texture} : int64_t{-1});
  hash.value(uint8_t{m.double_sided});
  hash.value(uint8_t{m.alpha_masked});
  hash.value(m.alpha_cutoff);
}

void hash_texture(KeyHash& hash, const Texture& t) {
  hash.value(t.width);
  hash.value(t.height);
  hash.array(t.rgba);
  for (const Wrap wrap : {t.wrap_u, t.wrap_v}) hash.value(static_cast<uint8_t>(wrap));
  hash.value(uint8_t{t.nearest});
}

// Intensity and colour do not change visibility.
void hash_light(KeyHash& hash, const Light& light) {
  hash.value(static_cast<uint32_t>(light.type));
  hash.values(light.world_from_light);
  for (const double v : {light.outer_cone, light.map_fov, light.range.value_or(-1.0),
                         light.area ? light.area->width : -1.0, light.area ? light.area->height : -1.0})
    hash.value(v);
  // Only what a plain rectangle has not: keys of such lights stay as they were before there were other
  // shapes.
  if (!light.area || (light.area->shape == AreaLight::Shape::rectangle && !light.area->emission)) return;
  hash.value(static_cast<uint32_t>(light.area->shape));
  hash.array(light.area->outline);
  hash.value(light.area->emission ? int64_t{*light.area->emission} : int64_t{-1});
}

void hash_view(KeyHash& hash, const Camera& camera, const ReferenceSettings& settings) {
  hash.values(camera.world_from_camera);
  for (const double v : {camera.fov_y, camera.near, camera.aspect.value_or(-1.0)}) hash.value(v);
  if (camera.far) hash.value(*camera.far);
  if (camera.span) hash.value(camera.span->x), hash.value(camera.span->y);
  for (const uint32_t v : {settings.width, settings.height, settings.samples}) hash.value(v);
}

// Nothing when the file is missing, broken or of something else.
std::optional<Reference> read_cached(const std::filesystem::path& file, const std::string& key) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  try {
    const Image image = read_exr(file);
    if (image.comment == key) return reference_from_image(image, file);
    spdlog::warn("{}: the cached reference is of something else: traced again", printable(file.string()));
  } catch (const Error& e) {
    spdlog::warn("{}; traced again", printable(e.what()));
  }
  return std::nullopt;
}

}  // namespace

Image to_image(const Reference& r) {
  Image image(r.width, r.height, channel_names(r.lights));
  PlaneWriter writer(image);  // in the order of channel_names
  for (uint32_t i = 0; i < r.lights; ++i) {
    writer.scalar(r.visibility[i]);
    writer.scalar(r.domain[i]);
  }
  writer.scalar(r.depth);
  writer.constant(r.samples);
  writer.constant(r.noise_floor);
  writer.vector(r.normal);
  writer.vector(r.position);
  writer.vector(r.shading_normal);
  writer.vector(r.albedo);
  return image;
}

Reference reference_from_image(const Image& image, const std::filesystem::path& file_for_errors) {
  const PlaneReader reader(image, file_for_errors.string());
  Reference r;
  r.width = image.width, r.height = image.height;
  for (; r.lights == 0 || image.has(light_prefix(r.lights) + "Y"); ++r.lights) {
    r.visibility.push_back(reader.scalar(light_prefix(r.lights) + "Y", 0, 1));
    const auto domain = reader.scalar(light_prefix(r.lights) + "domain", 0, Reference::edge_on);
    r.domain.emplace_back(domain.begin(), domain.end());
  }
  r.depth = reader.scalar("Z", 0, std::numeric_limits<float>::infinity());
  r.samples = static_cast<uint32_t>(reader.constant("samples", 1, 1 << 20));
  r.noise_floor = reader.constant("noise_floor", 0, 1);
  r.normal = reader.vector("N", kAxes);
  r.position = reader.vector("P", kAxes);
  r.shading_normal = reader.vector("Ns", kAxes);
  r.albedo = reader.vector("albedo", kColors);
  return r;
}

std::string reference_key(const Scene& scene, const ReferenceSettings& settings) {
  if (settings.camera >= scene.cameras.size())
    fail(fmt::format("no camera {}: the scene has {}", settings.camera, scene.cameras.size()),
         scene.file.string());
  KeyHash hash;
  const std::string_view version = kTracerVersion;
  hash.bytes(version.data(), version.size());
  for (const size_t count : {scene.meshes.size(), scene.materials.size(), scene.textures.size(),
                             scene.instances.size(), scene.lights.size()})
    hash.value(uint64_t{count});
  for (const Mesh& mesh : scene.meshes) hash_mesh(hash, mesh);
  for (const Material& material : scene.materials) hash_material(hash, material);
  for (const Texture& texture : scene.textures) hash_texture(hash, texture);
  for (const Instance& instance : scene.instances) {
    hash.value(instance.mesh);
    hash.values(instance.world_from_object);
    if (!instance.visible) hash.value(uint8_t{0});
  }
  for (const Light& light : scene.lights) hash_light(hash, light);
  hash_view(hash, scene.cameras[settings.camera], settings);
  return hash.text();
}

Reference cached_reference(const Scene& scene, const ReferenceSettings& settings,
                           const std::filesystem::path& cache) {
  if (cache.empty()) return ReferenceTracer(scene).trace(settings);
  const std::string key = reference_key(scene, settings);
  const auto file = cache / (key + ".exr");
  if (auto cached = read_cached(file, key)) return std::move(*cached);
  Reference reference = ReferenceTracer(scene).trace(settings);
  try {
    std::error_code code;
    std::filesystem::create_directories(cache, code);
    Image image = to_image(reference);
    image.comment = key;
    write_exr(file, image);
  } catch (const Error& e) {  // the result is good even where the cache is not
    spdlog::warn("{}; the reference is not cached", printable(e.what()));
  }
  return reference;
}

}  // namespace gnomon
