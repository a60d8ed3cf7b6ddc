// extras.area_light of a glTF node or scene. Internal to the scene loader.
#pragma once

#include <optional>
#include <string>

#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"

namespace gnomon {

// A finite number above zero in a JSON object, else nothing.
std::optional<double> positive_number(const tinygltf::Value& object, const std::string& key);

// The size that `value` describes. Of a directional light:
//   {"angular_diameter": degrees, in (0, 180)}
// of a point light a sphere, whose "shape" may be left out, and of a spot light
//   {"shape": "rectangle" (default) | "disc" | "sphere" | "polygon",
//    "width", "height": world units, above 0; equal for discs and spheres, which may give "radius" instead,
//    "outline": [[x, y], ...]: a polygon's corners (outline_problem() in area_light.h says which cannot be
//    used), "emission": of a rectangle, an index into the file's textures, or the name of a texture or image}
// Nothing, with a warning that names `place`, when it cannot be used; a bad "emission" or a key without a
// meaning is ignored alone, with a warning. An emission texture is added to the scene.
std::optional<AreaLight> read_area(const GltfFile& gltf, const tinygltf::Value& value,
                                   const std::string& place, LightType type, Scene& scene);

}  // namespace gnomon
