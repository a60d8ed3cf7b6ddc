// Reads a glTF file's materials and textures.
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/error.h"
#include "engine/scene/scene_primitive.h"

namespace gnomon {
namespace {

void add_warning(SceneWarnings& warnings, const GltfFile& gltf, const std::string& place,
                 const std::string& what) {
  warnings.messages.push_back(gltf.file + ": " + place + ": " + what);
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
  void warn(const std::string& place, const std::string& what) {
    add_warning(scene_.warnings, gltf_, place, what);
  }

  Material material(size_t index) {
    const tinygltf::Material& source = gltf_.model.materials[index];
    const std::string place = at("/materials", index);
    Material result;
    result.name = source.name.empty() ? "material" + std::to_string(index) : source.name;
    const auto& factor = source.pbrMetallicRoughness.baseColorFactor;
    for (size_t c = 0; c < 4 && c < factor.size(); ++c)
      result.base_color[static_cast<int>(c)] =
          std::isfinite(factor[c]) ? static_cast<float>(std::clamp(factor[c], 0.0, 1.0)) : 1.0f;
    result.double_sided = source.doubleSided;
    result.alpha_masked = source.alphaMode == "MASK";
    result.alpha_cutoff = std::isfinite(source.alphaCutoff) ? static_cast<float>(source.alphaCutoff) : 0.5f;
    if (source.alphaMode == "BLEND") warn(at(place, "alphaMode"), "BLEND is drawn as opaque");
    const tinygltf::TextureInfo& info = source.pbrMetallicRoughness.baseColorTexture;
    if (info.index >= 0)
      result.base_color_texture = texture(info, place + "/pbrMetallicRoughness/baseColorTexture");
    return result;
  }

  std::optional<uint32_t> texture(const tinygltf::TextureInfo& info, const std::string& place) {
    const auto& textures = gltf_.model.textures;
    if (static_cast<size_t>(info.index) >= textures.size())
      fail("no texture " + std::to_string(info.index) + "; there are " + std::to_string(textures.size()),
           gltf_.file, at(place, "index"));
    if (info.texCoord != 0) warn(place, "only TEXCOORD_0 is read");
    if (info.extensions.count("KHR_texture_transform") != 0) warn(place, "KHR_texture_transform is ignored");
    const auto [found, fresh] = loaded_.try_emplace(info.index);
    if (fresh) found->second = load(static_cast<size_t>(info.index));
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

void set_sampler(const GltfFile& gltf, int index, const std::string& place, SceneWarnings& warnings,
                 Texture& texture) {
  if (index < 0) return;
  if (static_cast<size_t>(index) >= gltf.model.samplers.size())
    fail("no sampler " + std::to_string(index), gltf.file, at(place, "sampler"));
  const tinygltf::Sampler& sampler = gltf.model.samplers[static_cast<size_t>(index)];
  texture.repeat_u = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  texture.repeat_v = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  if (sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ||
      sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT)
    add_warning(warnings, gltf, at(place, "sampler"), "mirrored repeat is drawn as repeat");
}

}  // namespace

std::optional<Texture> read_image(const GltfFile& gltf, size_t index, SceneWarnings& warnings) {
  const tinygltf::Image& image = gltf.model.images[index];
  Texture result;
  result.name = image.name;
  if (decode_image(image, result.width, result.height, result.rgba)) return result;
  const std::string from =
      image.uri.empty() || image.uri.rfind("data:", 0) == 0 ? "" : " '" + image.uri + "'";
  add_warning(warnings, gltf, at("/images", index), "the image" + from + " cannot be read; white is used");
  return {};
}

std::optional<Texture> read_texture(const GltfFile& gltf, size_t index, SceneWarnings& warnings) {
  const tinygltf::Texture& source = gltf.model.textures[index];
  const std::string place = at("/textures", index);
  if (source.source < 0) {
    add_warning(warnings, gltf, place, "no image that can be read; white is used");
    return {};
  }
  if (static_cast<size_t>(source.source) >= gltf.model.images.size())
    fail("no image " + std::to_string(source.source), gltf.file, at(place, "source"));
  std::optional<Texture> result = read_image(gltf, static_cast<size_t>(source.source), warnings);
  if (!result) return {};
  if (result->name.empty()) result->name = "texture" + std::to_string(index);
  set_sampler(gltf, source.sampler, place, warnings, *result);
  return result;
}

void read_materials(const GltfFile& gltf, Scene& scene) { MaterialReader(gltf, scene).read(); }

}  // namespace gnomon
