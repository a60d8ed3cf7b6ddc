// Reads area lights of the draft glTF extension EXT_lights_area.
#include "engine/scene/scene_lights_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/error.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene_area.h"

namespace gnomon {
namespace {

constexpr const char* kExtensionName = "EXT_lights_area";
constexpr double kStandardLuminance = 1000;  // nits
const std::vector<std::string> types = {"rect", "disk"};

const tinygltf::Value& member(const tinygltf::Value& object, const std::string& name) {
  static const tinygltf::Value none;
  return object.IsObject() && object.Has(name) ? object.Get(name) : none;
}

// What is written at `key`, when it is a number above 0; else the standard value, with a warning where
// something else is written.
class Numbers {
 public:
  Numbers(const GltfFile& gltf, const std::string& place, SceneWarnings& warnings)
      : gltf_(gltf), place_(place), warnings_(warnings) {}
  double at_least(const tinygltf::Value& object, const std::string& key, double standard) const {
    if (!object.IsObject() || !object.Has(key)) return standard;
    if (const auto number = positive_number(object, key)) return *number;
    warnings_.messages.push_back(
        to_string({"not a number above 0, " + std::to_string(int(standard)) + " is used",
                   gltf_.file,
                   at(place_, key),
                   {}}));
    return standard;
  }

 private:
  const GltfFile& gltf_;
  const std::string& place_;
  SceneWarnings& warnings_;
};

const tinygltf::Value& definition(const GltfFile& gltf, int index, const std::string& node_place) {
  static const tinygltf::Value none;
  const auto root = gltf.model.extensions.find(kExtensionName);
  const tinygltf::Value& lights = root == gltf.model.extensions.end() ? none : member(root->second, "lights");
  const size_t count = lights.IsArray() ? lights.ArrayLen() : 0;
  if (index < 0 || static_cast<size_t>(index) >= count)
    fail("no light " + std::to_string(index) + "; there are " + std::to_string(count), gltf.file,
         node_place + "/light");
  return lights.Get(index);
}

glm::dvec3 color_of(const tinygltf::Value& source) {
  glm::dvec3 color(1.0);
  const tinygltf::Value& given = member(source, "color");
  for (int c = 0; c < 3 && given.IsArray() && given.ArrayLen() == 3; ++c) {
    const double value = given.Get(c).IsNumber() ? given.Get(c).GetNumberAsDouble() : 1.0;
    if (std::isfinite(value) && value >= 0) color[c] = value;
  }
  return color;
}

double largest_scale(const glm::dmat4& m) {
  return std::max(
      {glm::length(glm::dvec3(m[0])), glm::length(glm::dvec3(m[1])), glm::length(glm::dvec3(m[2]))});
}

}  // namespace

std::optional<Light> read_lights_area(const GltfFile& gltf, const PlacedNode& placed,
                                      SceneWarnings& warnings) {
  const tinygltf::Node& node = gltf.model.nodes[placed.node];
  const auto extension = node.extensions.find(kExtensionName);
  if (extension == node.extensions.end()) return std::nullopt;
  const tinygltf::Value& reference = member(extension->second, "light");
  const int index = reference.IsInt() ? reference.GetNumberAsInt() : -1;
  const tinygltf::Value& source =
      definition(gltf, index, at("/nodes", placed.node) + "/extensions/" + kExtensionName);
  const std::string place = at("/extensions/EXT_lights_area/lights", static_cast<size_t>(index));
  const Numbers numbers(gltf, place, warnings);
  const tinygltf::Value &type = member(source, "type"), &name = member(source, "name");
  const std::string kind = type.IsString() ? type.Get<std::string>() : "rect";
  const double size = largest_scale(placed.world_from_node) * numbers.at_least(source, "size", 1);
  const bool disk = kind == "disk";
  if (!disk && kind != "rect") {
    warnings.messages.push_back(to_string({"unknown type '" + kind + "': the light is left out", gltf.file,
                                           at(place, "type"), did_you_mean(kind, types)}));
    return std::nullopt;
  }
  const double aspect = disk ? 1 : numbers.at_least(member(source, "rect"), "aspect", 1);
  Light light;
  light.area =
      AreaLight{disk ? AreaLight::Shape::disc : AreaLight::Shape::rectangle, size * aspect, size, {}, {}};
  light.name = name.IsString() ? name.Get<std::string>() : "";
  light.color = color_of(source);
  light.intensity = numbers.at_least(source, "intensity", kStandardLuminance) * size * size * aspect *
                    coverage(*light.area);
  light.outer_cone = std::numbers::pi / 2;
  light.world_from_light = rigid(placed.world_from_node);
  light.moving = placed.moving;
  return light;
}

}  // namespace gnomon
