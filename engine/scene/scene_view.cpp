// Cameras and lights of a scene.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/error.h"
#include "engine/scene/light_roll.h"
#include "engine/scene/mesh_clean.h"
#include "engine/scene/scene_area.h"
#include "engine/scene/scene_lights_area.h"
#include "engine/scene/scene_nodes.h"
#include "engine/scene/wide_spot.h"

namespace gnomon {
namespace {

constexpr double kPi = std::numbers::pi;

double radians(double degrees) { return degrees / 180.0 * kPi; }

const tinygltf::Value& member(const tinygltf::Value& object, const std::string& name) {
  static const tinygltf::Value none;
  return object.IsObject() && object.Has(name) ? object.Get(name) : none;
}

class LightReader {
 public:
  // `animation`: may be null.
  LightReader(const GltfFile& gltf, Scene& scene, Animation* animation,
              const std::map<size_t, Track>& intensities)
      : gltf_(gltf), scene_(scene), animation_(animation), intensities_(intensities) {}

  void read(const std::vector<PlacedNode>& nodes) {
    for (size_t i = 0; i < nodes.size(); ++i) {
      const size_t before = scene_.lights.size();
      const std::optional<size_t> source = read_node(nodes[i]);
      for (size_t light = before; animation_ != nullptr && light < scene_.lights.size(); ++light)
        attach(static_cast<uint32_t>(light), i, nodes[i], source);
    }
    apply_scene_extras();
  }

 private:
  void warn(const std::string& place, const std::string& what) {
    scene_.warnings.messages.push_back(gltf_.file + ": " + place + ": " + what);
  }

  // `source`: index of a punctual light in the file.
  void attach(uint32_t light, size_t node, const PlacedNode& placed, std::optional<size_t> source) {
    if (placed.moving) animation_->lights.push_back({light, node, glm::dmat4(1.0)});
    const auto track = source ? intensities_.find(*source) : intensities_.end();
    if (track == intensities_.end() && !placed.blinks) return;
    ChangingLight changing{light, scene_.lights[light].intensity, {}, {}};
    if (track != intensities_.end()) changing.track = track->second;
    if (placed.blinks) changing.node = node;
    if (!placed.visible) scene_.lights[light].intensity = 0;
    animation_->changing_lights.push_back(std::move(changing));
  }

  // The light's index in the file; nothing when the node has none.
  std::optional<size_t> read_node(const PlacedNode& placed) {
    const tinygltf::Node& node = gltf_.model.nodes[placed.node];
    if (std::optional<Light> area = read_lights_area(gltf_, placed, scene_.warnings);
        area && placed.ever_visible) {
      area->map_fov = kWidestMap;
      add(std::move(*area), node);
    }
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end() || !placed.ever_visible) return {};
    const std::string place = at("/nodes", placed.node);
    const tinygltf::Value reference = member(extension->second, "light");
    const int index = reference.IsInt() ? reference.GetNumberAsInt() : -1;
    if (index < 0 || static_cast<size_t>(index) >= gltf_.model.lights.size())
      fail("no light " + std::to_string(index) + "; there are " + std::to_string(gltf_.model.lights.size()),
           gltf_.file, place + "/extensions/KHR_lights_punctual/light");
    Light light = punctual(static_cast<size_t>(index));
    light.world_from_light = rigid(placed.world_from_node);
    light.moving = placed.moving;
    set_area(light, node.extras, at(place, "extras"));
    add(std::move(light), node, "light" + std::to_string(index));
    return static_cast<size_t>(index);
  }

  // `standard`: its name when neither it nor its node has one.
  void add(Light light, const tinygltf::Node& node, const std::string& standard = "area light") {
    if (light.name.empty()) light.name = node.name.empty() ? standard : node.name;
    own_fov_.push_back(set_map_fov(light, node.extras));
    scene_.lights.push_back(std::move(light));
  }

  Light punctual(size_t index) {
    const tinygltf::Light& source = gltf_.model.lights[index];
    const std::string place = at("/extensions/KHR_lights_punctual/lights", index);
    Light light;
    light.name = source.name;
    if (source.type == "spot")
      light.type = LightType::spot;
    else if (source.type == "point")
      light.type = LightType::point;
    else if (source.type == "directional")
      light.type = LightType::directional;
    else
      fail("unknown light type '" + source.type + "'", gltf_.file, at(place, "type"),
           "one of: spot, point, directional");
    for (size_t c = 0; c < 3 && c < source.color.size(); ++c)
      if (std::isfinite(source.color[c]) && source.color[c] >= 0)
        light.color[static_cast<int>(c)] = source.color[c];
    if (std::isfinite(source.intensity) && source.intensity >= 0)
      light.intensity = source.intensity;
    else
      warn(at(place, "intensity"), "not a positive number, 1 is used");
    if (std::isfinite(source.range) && source.range > 0) light.range = source.range;
    if (light.type == LightType::spot) set_cones(light, source.spot, at(place, "spot"));
    return light;
  }

  void set_cones(Light& light, const tinygltf::SpotLight& spot, const std::string& place) {
    const double outer = spot.outerConeAngle, inner = spot.innerConeAngle;
    if (std::isfinite(outer) && outer > 0 && outer <= kPi / 2 + 1e-6)
      light.outer_cone = std::min(outer, kPi / 2);
    else
      warn(at(place, "outerConeAngle"), "not in (0, pi/2], pi/4 is used");
    if (std::isfinite(inner) && inner >= 0 && inner < light.outer_cone)
      light.inner_cone = inner;
    else
      warn(at(place, "innerConeAngle"), "not in [0, outerConeAngle), 0 is used");
    light.map_fov = std::min(2.0 * light.outer_cone, kWidestMap);
  }

  // `extras.light.fovy_deg`: the square frustum of the map. True when it was given.
  static bool set_map_fov(Light& light, const tinygltf::Value& extras) {
    const auto degrees = positive_number(member(extras, "light"), "fovy_deg");
    if (!degrees || light.type != LightType::spot) return false;
    light.map_fov = std::min(radians(*degrees), kWidestMap);
    return true;
  }

  void set_area(Light& light, const tinygltf::Value& extras, const std::string& place) {
    if (!extras.IsObject() || !extras.Has("area_light")) return;
    light.area = read_area(gltf_, extras.Get("area_light"), at(place, "area_light"), light.type, scene_);
  }

  // The scene's own extras go to the first spot light, or the first light where there is none, unless its
  // node says more.
  void apply_scene_extras() {
    const tinygltf::Value& extras = scene_extras(gltf_);
    for (size_t i = 0; i < scene_.lights.size(); ++i) {
      if (scene_.lights[i].type != LightType::spot) continue;
      if (!scene_.lights[i].area) set_area(scene_.lights[i], extras, "/scenes/extras");
      if (!own_fov_[i]) set_map_fov(scene_.lights[i], extras);
      return;
    }
    if (!scene_.lights.empty() && !scene_.lights[0].area)
      set_area(scene_.lights[0], extras, "/scenes/extras");
  }

  const GltfFile& gltf_;
  Scene& scene_;
  Animation* animation_;
  const std::map<size_t, Track>& intensities_;
  std::vector<bool> own_fov_;
};

template <class Warn>
void set_far(Camera& camera, double far, Warn&& warn) {
  if (std::isfinite(far) && far > camera.near)
    camera.far = far;
  else if (far != 0.0)
    warn("zfar is not above znear, nothing is cut off");
}

template <class Warn>
void set_perspective(Camera& camera, const tinygltf::PerspectiveCamera& view, Warn&& warn) {
  if (std::isfinite(view.yfov) && view.yfov > 1e-4 && view.yfov < kPi - 1e-4)
    camera.fov_y = view.yfov;
  else
    warn("yfov is not in (0, pi), 45 degrees are used");
  if (std::isfinite(view.znear) && view.znear > 0)
    camera.near = view.znear;
  else
    warn("znear is not above 0, 0.1 is used");
  set_far(camera, view.zfar, warn);
  if (std::isfinite(view.aspectRatio) && view.aspectRatio > 0) camera.aspect = view.aspectRatio;
}

// A negative magnification mirrors the image, which no camera of a shadow's test needs: its size is taken.
template <class Warn>
void set_orthographic(Camera& camera, const tinygltf::OrthographicCamera& view, Warn&& warn) {
  const auto usable = [](double v) { return std::isfinite(v) && std::abs(v) > 1e-15 && std::abs(v) < 1e15; };
  if (!usable(view.xmag) || !usable(view.ymag))
    warn("xmag or ymag is not a number other than 0, 1 is used");
  else if (view.xmag < 0 || view.ymag < 0)
    warn("xmag or ymag is below 0, the image is not mirrored");
  camera.span = glm::dvec2(usable(view.xmag) ? std::abs(view.xmag) : 1.0,
                           usable(view.ymag) ? std::abs(view.ymag) : 1.0);
  camera.near = 0;
  if (std::isfinite(view.znear) && view.znear >= 0)
    camera.near = view.znear;
  else
    warn("znear is below 0, 0 is used");
  set_far(camera, view.zfar, warn);
}

}  // namespace

void read_cameras(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, Scene& scene,
                  Animation* animation) {
  for (size_t i = 0; i < nodes.size(); ++i) {
    const PlacedNode& placed = nodes[i];
    const tinygltf::Node& node = gltf.model.nodes[placed.node];
    if (node.camera < 0) continue;
    const std::string node_place = at(at("/nodes", placed.node), "camera");
    if (static_cast<size_t>(node.camera) >= gltf.model.cameras.size())
      fail("no camera " + std::to_string(node.camera) + "; there are " +
               std::to_string(gltf.model.cameras.size()),
           gltf.file, node_place);
    const tinygltf::Camera& source = gltf.model.cameras[static_cast<size_t>(node.camera)];
    const std::string place = gltf.file + ": " + at("/cameras", static_cast<size_t>(node.camera)) + ": ";
    if (source.type != "perspective" && source.type != "orthographic") {
      scene.warnings.messages.push_back(place + "perspective and orthographic cameras are read, '" +
                                        source.type + "' is left out");
      continue;
    }
    Camera camera;
    camera.name = !node.name.empty() ? node.name : "camera" + std::to_string(scene.cameras.size());
    camera.world_from_camera = rigid(placed.world_from_node);
    camera.moving = placed.moving;
    if (placed.moving)
      animation->cameras.push_back({static_cast<uint32_t>(scene.cameras.size()), i, glm::dmat4(1.0)});
    const auto warn = [&](const char* what) { scene.warnings.messages.push_back(place + what); };
    if (source.type == "orthographic")
      set_orthographic(camera, source.orthographic, warn);
    else
      set_perspective(camera, source.perspective, warn);
    scene.cameras.push_back(std::move(camera));
  }
}

void read_lights(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, Scene& scene,
                 Animation* animation, const std::map<size_t, Track>& intensities) {
  LightReader(gltf, scene, animation, intensities).read(nodes);
  level_lights(scene);
}

void ensure_camera(Scene& scene) {
  if (!scene.cameras.empty()) return;
  const glm::dvec3 centre = scene.bounds.centre();
  const double radius = scene.bounds.radius();
  Camera camera;
  camera.name = "default";
  const double distance = 1.1 * radius / std::sin(0.5 * camera.fov_y);
  camera.world_from_camera =
      looking_at(centre + glm::normalize(glm::dvec3(0.5, 0.6, 1.0)) * distance, centre);
  camera.near = 1e-3 * distance;
  scene.cameras.push_back(camera);
  scene.warnings.messages.push_back(scene.file.string() + ": no camera, a default one frames the scene");
}

void ensure_light(Scene& scene) {
  if (!scene.lights.empty()) return;
  const glm::dvec3 centre = scene.bounds.centre();
  const double radius = scene.bounds.radius(), distance = 4.0 * radius;
  Light light;
  light.name = "default";
  light.world_from_light = looking_at(centre + glm::normalize(glm::dvec3(-0.5, 1.0, 0.4)) * distance, centre);
  // The square frustum holds the scene's sphere; the cone holds the square.
  light.map_fov = 2.0 * std::asin(1.02 * radius / distance);
  light.inner_cone = std::atan(std::sqrt(2.0) * std::tan(0.5 * light.map_fov));
  light.outer_cone = light.inner_cone + radians(1.0);
  light.intensity = 0.5 * kPi * distance * distance;  // a white surface facing it has radiance 0.5
  scene.lights.push_back(light);
  scene.warnings.messages.push_back(scene.file.string() +
                                    ": no light, a default spot light shines on the scene from above");
}

void warn_enclosed_lights(Scene& scene) {
  for (const Light& light : scene.lights) {
    if (light.type == LightType::directional) continue;
    const glm::dvec4 position = light.world_from_light[3];
    for (const Instance& instance : scene.instances) {
      const glm::dvec3 inside = glm::dvec3(glm::inverse(instance.world_from_object) * position);
      const Mesh& mesh = scene.meshes[instance.mesh];
      if (!mesh.watertight || !is_inside(mesh, inside)) continue;
      scene.warnings.messages.push_back(scene.file.string() + ": light '" + light.name + "' is inside '" +
                                        instance.name + "', which hides it from everything outside");
      break;
    }
  }
}

}  // namespace gnomon
