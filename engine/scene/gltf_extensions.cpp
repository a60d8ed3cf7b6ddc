// The table of known glTF extensions.
#include "engine/scene/gltf_extensions.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/base/error.h"
#include "engine/base/json_text.h"
#include "engine/scene/gltf_file.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;

constexpr std::array kRead = {"KHR_lights_punctual",
                              "KHR_mesh_quantization",
                              "KHR_texture_transform",
                              "KHR_node_visibility",
                              "KHR_materials_pbrSpecularGlossiness",
                              "EXT_mesh_gpu_instancing",
                              "EXT_meshopt_compression",
                              "KHR_meshopt_compression",
                              "KHR_draco_mesh_compression",
                              "EXT_texture_webp",
                              "KHR_animation_pointer",
                              "EXT_lights_area"};

struct Ignored {
  const char* name;
  const char* meaning;  // of leaving it out
};
constexpr const char* kLooks = "a surface's look; shadows stay the same";
constexpr const char* kPasses = "light that passes a surface; its shadows are those of an opaque one";
constexpr const char* kOther = "data beside the scene; shadows stay the same";
constexpr const char* kImage = "images of this kind; shadows stay the same, a mask in one is refused";
constexpr const char* kPose = "properties that move; shadows can differ";
constexpr std::array kIgnored = {
    Ignored{"KHR_materials_anisotropy", kLooks},
    Ignored{"KHR_materials_clearcoat", kLooks},
    Ignored{"KHR_materials_dispersion", kLooks},
    Ignored{"KHR_materials_emissive_strength", kLooks},
    Ignored{"KHR_materials_ior", kLooks},
    Ignored{"KHR_materials_iridescence", kLooks},
    Ignored{"KHR_materials_sheen", kLooks},
    Ignored{"KHR_materials_specular", kLooks},
    Ignored{"KHR_materials_unlit", kLooks},
    Ignored{"KHR_materials_transmission", kPasses},
    Ignored{"KHR_materials_diffuse_transmission", kPasses},
    Ignored{"KHR_materials_volume", kPasses},
    Ignored{"KHR_materials_variants", "materials to choose from, the first is used; shadows can differ"},
    Ignored{"KHR_texture_basisu", kImage},
    Ignored{"MSFT_texture_dds", kImage},
    Ignored{"EXT_texture_avif", kImage},
    Ignored{"MSFT_lod", "coarser levels of detail; shadows are those of the finest"},
    Ignored{"EXT_lights_image_based", "light from all around; shadows stay the same"},
    Ignored{"EXT_lights_ies", "the distribution of a light; shadows stay the same"},
    Ignored{"KHR_xmp", kOther},
    Ignored{"KHR_xmp_json_ld", kOther},
    Ignored{"KHR_audio_emitter", kOther},
    Ignored{"KHR_interactivity", kPose},
    Ignored{"KHR_node_hoverability", kOther},
    Ignored{"KHR_node_selectability", kOther},
    Ignored{"KHR_physics_rigid_bodies", kPose},
    Ignored{"KHR_implicit_shapes", kOther},
    Ignored{"EXT_mesh_features", kOther},
    Ignored{"EXT_instance_features", kOther},
    Ignored{"EXT_structural_metadata", kOther},
    Ignored{"EXT_mesh_manifold", kOther},
    Ignored{"MSFT_packing_normalRoughnessMetallic", kLooks},
    Ignored{"MSFT_packing_occlusionRoughnessMetallic", kLooks},
};

bool is_read(const std::string& name) { return std::find(kRead.begin(), kRead.end(), name) != kRead.end(); }

const Ignored* find_ignored(const std::string& name) {
  const auto found =
      std::find_if(kIgnored.begin(), kIgnored.end(), [&](const Ignored& e) { return e.name == name; });
  return found == kIgnored.end() ? nullptr : &*found;
}

}  // namespace

void check_extensions(const Json& document, const std::string& file, SceneWarnings& warnings) {
  std::set<std::string> told;
  for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
    const auto names = document.find(list);
    if (names == document.end() || !names->is_array()) continue;
    for (size_t i = 0; i < names->size(); ++i) {
      if (!(*names)[i].is_string()) continue;
      const std::string name = (*names)[i].get<std::string>(), place = at(at("", list), i);
      if (is_read(name) || !told.insert(name).second) continue;
      const Ignored* ignored = find_ignored(name);
      if (!ignored && list == std::string("extensionsRequired"))
        fail("required extension " + in_quotes(name) + " is not known", file, place,
             "export the scene without it");
      const std::string what = ignored
                                   ? std::string(" is ignored: ").append(ignored->meaning)
                                   : " is not known and is ignored; what it leaves out can change shadows";
      warnings.messages.push_back(to_string({"extension " + in_quotes(name) + what, file, place, {}}));
    }
  }
}

}  // namespace gnomon
