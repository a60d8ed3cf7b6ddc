// Reads extras.area_light of a glTF file's nodes.
#include "engine/scene/scene_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/error.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene_primitive.h"

namespace gnomon {
namespace {

using Shape = AreaLight::Shape;

const std::vector<std::string> shapes = {"rectangle", "disc", "sphere", "polygon"};  // in the enum's order
const std::vector<std::string> keys = {"shape",   "width",    "height",          "radius",
                                       "outline", "emission", "angular_diameter"};

bool has_meaning(const std::string& key, Shape shape) {
  if (key == "width" || key == "height") return shape != Shape::polygon;
  if (key == "radius") return shape == Shape::disc || shape == Shape::sphere;
  if (key == "outline") return shape == Shape::polygon;
  if (key == "emission") return shape == Shape::rectangle;
  return key == "shape";
}

constexpr double kDegree = std::numbers::pi / 180;

class AreaReader {
 public:
  AreaReader(const GltfFile& gltf, std::string place, LightType type, Scene& scene)
      : gltf_(gltf), place_(std::move(place)), type_(type), scene_(scene) {}

  std::optional<AreaLight> read(const tinygltf::Value& value) {
    if (!value.IsObject()) return refuse({}, "not an object");
    if (type_ == LightType::directional) return angular(value);
    const std::optional<Shape> shape = shape_of(value);
    if (!shape) return {};
    if (type_ == LightType::point && *shape != Shape::sphere)
      return refuse("shape", "a point light's shape is a sphere");
    const std::string name = "a " + shapes[static_cast<size_t>(*shape)];
    warn_of_keys(value, name, [&](const std::string& key) { return has_meaning(key, *shape); });
    if (*shape == Shape::polygon) return polygon(value);
    std::optional<AreaLight> area = *shape == Shape::rectangle ? rectangle(value) : round(value, *shape);
    if (area && *shape == Shape::rectangle && value.Has("emission"))
      set_emission(*area, value.Get("emission"));
    return area;
  }

 private:
  void warn(const std::string& key, std::string what, std::string hint = {}) {
    scene_.warnings.messages.push_back(
        to_string({std::move(what), gltf_.file, key.empty() ? place_ : at(place_, key), std::move(hint)}));
  }
  std::nullopt_t refuse(const std::string& key, const std::string& what, std::string hint = {}) {
    warn(key, what + ": the area light is ignored", std::move(hint));
    return std::nullopt;
  }

  std::optional<Shape> shape_of(const tinygltf::Value& value) {
    if (!value.Has("shape")) return type_ == LightType::point ? Shape::sphere : Shape::rectangle;
    const tinygltf::Value& shape = value.Get("shape");
    if (!shape.IsString()) return refuse("shape", "not a string", did_you_mean("", shapes));
    const auto& name = shape.Get<std::string>();
    const auto found = std::find(shapes.begin(), shapes.end(), name);
    if (found == shapes.end())
      return refuse("shape", "unknown shape '" + name + "'", did_you_mean(name, shapes));
    return static_cast<Shape>(found - shapes.begin());
  }

  // `name`: of what the object describes, as in "a disc". `means`: has a known key a meaning for it?
  template <typename Means>
  void warn_of_keys(const tinygltf::Value& value, const std::string& name, const Means& means) {
    for (const std::string& key : value.Keys()) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        warn(key, "unknown key '" + key + "', ignored", did_you_mean(key, keys));
      else if (!means(key))
        warn(key, std::string(name).append(" has no '").append(key).append("', ignored"));
    }
  }

  std::optional<AreaLight> angular(const tinygltf::Value& value) {
    const std::string own = "angular_diameter";
    const std::string hint = R"(degrees, as in {"angular_diameter": 0.53})";
    if (!value.Has(own)) return refuse({}, "a directional light needs an angular_diameter", hint);
    warn_of_keys(value, "a directional light", [&](const std::string& key) { return key == own; });
    const auto degrees = positive_number(value, own);
    if (!degrees || *degrees >= 180) return refuse(own, "not a number above 0 and below 180", hint);
    return angular_disc(*degrees * kDegree);
  }

  std::optional<AreaLight> rectangle(const tinygltf::Value& value) {
    const auto width = positive_number(value, "width"), height = positive_number(value, "height");
    if (!width || !height) return refuse({}, "needs a width and a height above 0");
    return AreaLight{Shape::rectangle, *width, *height, {}, {}};
  }

  std::optional<AreaLight> round(const tinygltf::Value& value, Shape shape) {
    if (value.Has("radius")) {
      const auto radius = positive_number(value, "radius");
      if (!radius) return refuse("radius", "not a number above 0");
      if (value.Has("width") || value.Has("height"))
        return refuse({}, "has a radius, and a width or height besides", "give one of them");
      return AreaLight{shape, 2 * *radius, 2 * *radius, {}, {}};
    }
    const auto width = positive_number(value, "width"), height = positive_number(value, "height");
    if (!width || !height) return refuse({}, "needs a radius, or a width and a height, above 0");
    if (*width != *height) return refuse("height", "a disc or sphere is as wide as high");
    return AreaLight{shape, *width, *height, {}, {}};
  }

  std::optional<AreaLight> polygon(const tinygltf::Value& value) {
    if (!value.Has("outline")) return refuse({}, "a polygon needs an outline", R"("outline": [[x, y], ...])");
    const tinygltf::Value& corners = value.Get("outline");
    if (!corners.IsArray()) return refuse("outline", "not an array of corners [x, y]");
    std::vector<glm::dvec2> outline;
    for (size_t i = 0; i < corners.ArrayLen(); ++i) {
      const tinygltf::Value& corner = corners.Get(i);
      if (!corner.IsArray() || corner.ArrayLen() != 2 || !corner.Get(0).IsNumber() ||
          !corner.Get(1).IsNumber())
        return refuse(at("outline", i), "not a corner [x, y]");
      outline.emplace_back(corner.Get(0).GetNumberAsDouble(), corner.Get(1).GetNumberAsDouble());
    }
    if (const std::string problem = outline_problem(outline); !problem.empty())
      return refuse("outline", problem);
    return polygon_light(std::move(outline));
  }

  void set_emission(AreaLight& area, const tinygltf::Value& value) {
    const std::optional<Texture> texture = texture_of(value);
    if (!texture) return;
    const auto lit = [](const Texture& t) {
      for (size_t i = 0; i < t.rgba.size(); ++i)
        if (i % 4 != 3 && t.rgba[i] != 0) return true;
      return false;
    };
    if (!lit(*texture)) return warn("emission", "the texture is black, ignored");
    area.emission = add(*texture);
  }

  // An equal texture of a material is shared.
  uint32_t add(const Texture& texture) {
    const auto same = [&](const Texture& t) {
      return t.name == texture.name && t.width == texture.width && t.height == texture.height &&
             t.nearest == texture.nearest && t.wrap_u == texture.wrap_u && t.wrap_v == texture.wrap_v &&
             t.rgba == texture.rgba;
    };
    const auto found = std::find_if(scene_.textures.begin(), scene_.textures.end(), same);
    if (found != scene_.textures.end()) return static_cast<uint32_t>(found - scene_.textures.begin());
    scene_.textures.push_back(texture);
    return static_cast<uint32_t>(scene_.textures.size() - 1);
  }

  std::optional<Texture> texture_of(const tinygltf::Value& value) {
    const auto& textures = gltf_.model.textures;
    if (value.IsString()) return texture_named(value.Get<std::string>());
    const int index = value.IsInt() ? value.GetNumberAsInt() : -1;
    if (index >= 0 && static_cast<size_t>(index) < textures.size())
      return read_texture(gltf_, static_cast<size_t>(index), scene_.warnings);
    warn("emission", "no such texture, ignored",
         "the name of a texture or image, or an index below " + std::to_string(textures.size()));
    return {};
  }

  // A texture of that name, a texture of an image of that name, or the image by itself.
  std::optional<Texture> texture_named(const std::string& name) {
    const auto& textures = gltf_.model.textures;
    const auto& images = gltf_.model.images;
    std::vector<std::string> names;
    for (size_t i = 0; i < textures.size(); ++i) {
      if (textures[i].name == name) return read_texture(gltf_, i, scene_.warnings);
      if (!textures[i].name.empty()) names.push_back(textures[i].name);
    }
    for (size_t i = 0; i < images.size(); ++i) {
      names.push_back(images[i].name);
      if (images[i].name != name) continue;
      for (size_t t = 0; t < textures.size(); ++t)
        if (textures[t].source == static_cast<int>(i)) return read_texture(gltf_, t, scene_.warnings);
      return read_image(gltf_, i, scene_.warnings);
    }
    warn("emission", "no texture or image '" + name + "', ignored", did_you_mean(name, names));
    return {};
  }

  const GltfFile& gltf_;
  const std::string place_;
  const LightType type_;
  Scene& scene_;
};

}  // namespace

std::optional<double> positive_number(const tinygltf::Value& object, const std::string& key) {
  if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsNumber()) return {};
  const double number = object.Get(key).GetNumberAsDouble();
  return std::isfinite(number) && number > 0 ? std::optional(number) : std::nullopt;
}

std::optional<AreaLight> read_area(const GltfFile& gltf, const tinygltf::Value& value,
                                   const std::string& place, LightType type, Scene& scene) {
  return AreaReader(gltf, place, type, scene).read(value);
}

}  // namespace gnomon
