// Materials and textures of a glTF file: what decides a surface's coverage and its base colour.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/base/error.h"
#include "engine/scene/gltf_image.h"
#include "engine/scene/gltf_uri.h"
#include "engine/scene/scene_primitive.h"

namespace gnomon {
namespace {

void add_warning(SceneWarnings& warnings, const GltfFile& gltf, const std::string& place,
                 const std::string& what) {
  warnings.messages.push_back(gltf.file + ": " + place + ": " + what);
}

const tinygltf::Value& member(const tinygltf::Value& object, const std::string& name) {
  static const tinygltf::Value none;
  return object.IsObject() && object.Has(name) ? object.Get(name) : none;
}

// Finite numbers of a JSON array, else what stands there already.
template <size_t N>
void take_numbers(const tinygltf::Value& array, std::array<double, N>& values) {
  if (!array.IsArray() || array.ArrayLen() != N) return;
  for (size_t i = 0; i < N; ++i)
    if (const tinygltf::Value& value = array.Get(i); value.IsNumber())
      if (const double number = value.GetNumberAsDouble(); std::isfinite(number)) values[i] = number;
}

constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

// What a material says of its base colour, in either of the two ways.
struct BaseColor {
  std::array<double, 4> factor{1, 1, 1, 1};
  tinygltf::TextureInfo texture;
  std::string place;  // of the texture, in the material
};

// tinygltf reads textures of its own materials only.
tinygltf::TextureInfo texture_info(const tinygltf::Value& value) {
  tinygltf::TextureInfo info;
  const tinygltf::Value &index = member(value, "index"), &set = member(value, "texCoord");
  if (index.IsInt()) info.index = index.GetNumberAsInt();
  if (set.IsInt()) info.texCoord = set.GetNumberAsInt();
  const tinygltf::Value& transform = member(member(value, "extensions"), "KHR_texture_transform");
  if (transform.IsObject()) info.extensions["KHR_texture_transform"] = transform;
  return info;
}

// The older workflow's diffuse colour stands for the base colour, alpha included.
BaseColor base_color_of(const tinygltf::Material& material) {
  BaseColor result;
  const auto older = material.extensions.find(kSpecularGlossiness);
  if (older != material.extensions.end()) {
    take_numbers(member(older->second, "diffuseFactor"), result.factor);
    result.texture = texture_info(member(older->second, "diffuseTexture"));
    result.place = std::string("extensions/") + kSpecularGlossiness + "/diffuseTexture";
    return result;
  }
  const auto& factor = material.pbrMetallicRoughness.baseColorFactor;
  for (size_t c = 0; c < 4 && c < factor.size(); ++c)
    if (std::isfinite(factor[c])) result.factor[c] = factor[c];
  result.texture = material.pbrMetallicRoughness.baseColorTexture;
  result.place = "pbrMetallicRoughness/baseColorTexture";
  return result;
}

// The first source that is there; where an extension's alone, its name.
struct TextureSource {
  int image = -1;
  std::string unreadable;
};

TextureSource source_of(const tinygltf::Texture& texture) {
  if (texture.source >= 0) return {texture.source, {}};
  for (const char* name :
       {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"}) {
    const auto found = texture.extensions.find(name);
    if (found == texture.extensions.end()) continue;
    const tinygltf::Value& source = member(found->second, "source");
    if (!source.IsInt()) continue;
    if (name == std::string("EXT_texture_webp")) return {source.GetNumberAsInt(), {}};
    return {-1, name};
  }
  return {};
}

class MaterialReader {
 public:
  MaterialReader(const GltfFile& gltf, Scene& scene) : gltf_(gltf), scene_(scene) {}

  void read() {
    for (size_t i = 0; i < gltf_.model.materials.size(); ++i) scene_.materials.push_back(material(i));
    Material standard;
    standard.name = "default";
    scene_.materials.push_back(standard);
  }

 private:
  Material material(size_t index) {
    const tinygltf::Material& source = gltf_.model.materials[index];
    const std::string place = at("/materials", index);
    Material result;
    result.name = source.name.empty() ? "material" + std::to_string(index) : source.name;
    const BaseColor color = base_color_of(source);
    for (size_t c = 0; c < 4; ++c)
      result.base_color[static_cast<int>(c)] = static_cast<float>(std::clamp(color.factor[c], 0.0, 1.0));
    result.double_sided = source.doubleSided;
    result.alpha_masked = source.alphaMode == "MASK";
    result.alpha_cutoff = std::isfinite(source.alphaCutoff) ? static_cast<float>(source.alphaCutoff) : 0.5f;
    if (source.alphaMode == "BLEND")
      add_warning(scene_.warnings, gltf_, at(place, "alphaMode"), "BLEND is drawn as opaque");
    if (color.texture.index >= 0)
      result.base_color_texture = texture(color.texture.index, at(place, color.place), result.alpha_masked);
    return result;
  }

  std::optional<uint32_t> texture(int index, const std::string& place, bool masked) {
    const auto& textures = gltf_.model.textures;
    if (static_cast<size_t>(index) >= textures.size())
      fail("no texture " + std::to_string(index) + "; there are " + std::to_string(textures.size()),
           gltf_.file, at(place, "index"));
    if (const std::string kind = source_of(textures[static_cast<size_t>(index)]).unreadable;
        masked && !kind.empty())
      fail("the mask is an image of " + kind + ", which is not read: its coverage is unknown", gltf_.file,
           at("/textures", static_cast<size_t>(index)), "export the scene with PNG, JPEG or WebP textures");
    const auto [found, fresh] = loaded_.try_emplace(index);
    if (fresh) found->second = load(static_cast<size_t>(index));
    return found->second;
  }

  std::optional<uint32_t> load(size_t index) {
    std::optional<Texture> texture = read_texture(gltf_, index, scene_.warnings);
    if (!texture) return {};
    scene_.textures.push_back(std::move(*texture));
    return static_cast<uint32_t>(scene_.textures.size() - 1);
  }

  const GltfFile& gltf_;
  Scene& scene_;
  std::map<int, std::optional<uint32_t>> loaded_;
};

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

void set_sampler(const GltfFile& gltf, int index, const std::string& place, Texture& texture) {
  if (index < 0) return;
  if (static_cast<size_t>(index) >= gltf.model.samplers.size())
    fail("no sampler " + std::to_string(index), gltf.file, at(place, "sampler"));
  const tinygltf::Sampler& sampler = gltf.model.samplers[static_cast<size_t>(index)];
  texture.wrap_u = wrap_of(sampler.wrapS);
  texture.wrap_v = wrap_of(sampler.wrapT);
  texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

}  // namespace

std::optional<Texture> read_image(const GltfFile& gltf, size_t index, SceneWarnings& warnings) {
  const tinygltf::Image& image = gltf.model.images[index];
  Texture result;
  result.name = image.name;
  const std::string why = decode_image(gltf, index, result);
  if (why.empty()) return result;
  const std::string from = image.uri.empty() ? "" : " '" + shown_uri(image.uri) + "'";
  add_warning(warnings, gltf, at("/images", index),
              "the image" + from + " cannot be read; white is used (" + why + ")");
  return {};
}

std::optional<Texture> read_texture(const GltfFile& gltf, size_t index, SceneWarnings& warnings) {
  const tinygltf::Texture& texture = gltf.model.textures[index];
  const std::string place = at("/textures", index);
  const TextureSource source = source_of(texture);
  if (source.image < 0) {
    add_warning(warnings, gltf, place,
                source.unreadable.empty()
                    ? "no image that can be read; white is used"
                    : "images of " + source.unreadable + " are not read; white is used");
    return {};
  }
  if (static_cast<size_t>(source.image) >= gltf.model.images.size())
    fail("no image " + std::to_string(source.image), gltf.file, at(place, "source"));
  std::optional<Texture> result = read_image(gltf, static_cast<size_t>(source.image), warnings);
  if (!result) return {};
  if (result->name.empty()) result->name = "texture" + std::to_string(index);
  set_sampler(gltf, texture.sampler, place, *result);
  return result;
}

TextureCoordinates texture_coordinates(const GltfFile& gltf, int material) {
  TextureCoordinates result;
  if (material < 0 || static_cast<size_t>(material) >= gltf.model.materials.size()) return result;
  const tinygltf::TextureInfo texture =
      base_color_of(gltf.model.materials[static_cast<size_t>(material)]).texture;
  result.used = texture.index >= 0;
  result.set = texture.texCoord;
  const auto found = texture.extensions.find("KHR_texture_transform");
  if (found == texture.extensions.end()) return result;
  std::array<double, 2> offset{0, 0}, scale{1, 1};
  take_numbers(member(found->second, "offset"), offset);
  take_numbers(member(found->second, "scale"), scale);
  const tinygltf::Value &angle = member(found->second, "rotation"), &set = member(found->second, "texCoord");
  const double radians =
      angle.IsNumber() && std::isfinite(angle.GetNumberAsDouble()) ? angle.GetNumberAsDouble() : 0;
  if (set.IsInt()) result.set = set.GetNumberAsInt();
  const double c = std::cos(radians), s = std::sin(radians);
  // Counter-clockwise in an image whose rows run down.
  result.transform =
      glm::dmat3(c * scale[0], -s * scale[0], 0, s * scale[1], c * scale[1], 0, offset[0], offset[1], 1);
  return result;
}

void read_materials(const GltfFile& gltf, Scene& scene) { MaterialReader(gltf, scene).read(); }

}  // namespace gnomon
