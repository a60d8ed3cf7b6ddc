// glTF primitives, materials and textures as the scene's. Internal to the scene loader.
#pragma once

#include <optional>
#include <vector>

#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"

namespace gnomon {

// One primitive as a clean mesh; nothing when it holds no triangles (points, lines, all dropped). Counts what
// it drops.
std::optional<Mesh> read_primitive(const GltfFile& gltf, size_t mesh, size_t primitive,
                                   SceneWarnings& warnings);

// Its two steps, for shapes that change in between. The first reads it as the file has it, normals none where
// it has none. The second cleans it and may leave nothing: false; with `origins` (may be null) it keeps what
// may get an area, and tells each vertex's place before.
std::optional<Mesh> read_raw_primitive(const GltfFile& gltf, size_t mesh, size_t primitive,
                                       SceneWarnings& warnings);
bool clean_primitive(const GltfFile& gltf, size_t mesh, size_t primitive, Mesh& shape,
                     std::vector<uint32_t>* origins, SceneWarnings& warnings);

// Where a material's base colour texture is looked up: a set of coordinates, and KHR_texture_transform.
struct TextureCoordinates {
  bool used = false;  // there is such a texture
  int set = 0;
  std::optional<glm::dmat3> transform;
};
// Of a material by its index in the file; one out of range has none.
TextureCoordinates texture_coordinates(const GltfFile& gltf, int material);

// An image of the file, or one of its textures (an image and its sampler); nothing, with a warning, when the
// image cannot be read. `index` must be in range; Error when a reference in the texture is not.
std::optional<Texture> read_image(const GltfFile& gltf, size_t index, SceneWarnings& warnings);
std::optional<Texture> read_texture(const GltfFile& gltf, size_t index, SceneWarnings& warnings);

// All materials, then the default one (glTF 2.0, 3.9.6), which primitives without a material use; and the
// textures that the materials need.
void read_materials(const GltfFile& gltf, Scene& scene);

}  // namespace gnomon
