// What is exported is read back as the same scene.
#include "tools/scene_export.h"

#include <gtest/gtest.h>

#include "engine/base/resource_root.h"
#include "engine/scene/animation.h"
#include "engine/truth/reference.h"
#include "tests/engine/scene/gltf_draft.h"

namespace gnomon {
namespace {

// Visibility depends on the same values, to the bit.
TEST(SceneExport, ScenesAreReadBackAsTheyWere) {
  for (const char* name : {"fence", "foliage", "robot", "hills", "square_plane", "area_shapes", "pendulum"}) {
    const Scene scene =
        posed(load_scene(resource_root() / "assets" / "scenes" / (std::string(name) + ".glb")), 0.25);
    const test::Folder folder;
    const Scene back = load_scene(folder.write("back.glb", to_glb(scene)));
    ASSERT_EQ(back.instances.size(), scene.instances.size()) << name;
    for (size_t i = 0; i < scene.instances.size(); ++i) {
      const Instance &a = scene.instances[i], &b = back.instances[i];
      EXPECT_EQ(a.world_from_object, b.world_from_object);
      EXPECT_EQ(scene.meshes[a.mesh].positions, back.meshes[b.mesh].positions);
      EXPECT_EQ(scene.meshes[a.mesh].indices, back.meshes[b.mesh].indices);
      EXPECT_EQ(scene.meshes[a.mesh].uvs, back.meshes[b.mesh].uvs);
      EXPECT_EQ(scene.meshes[a.mesh].watertight, back.meshes[b.mesh].watertight);
      const Material &m = scene.materials[scene.meshes[a.mesh].material],
                     &n = back.materials[back.meshes[b.mesh].material];
      EXPECT_EQ(m.alpha_masked, n.alpha_masked);
      EXPECT_EQ(m.alpha_cutoff, n.alpha_cutoff);
      EXPECT_EQ(m.double_sided, n.double_sided);
      EXPECT_EQ(m.base_color, n.base_color);
      ASSERT_EQ(m.base_color_texture.has_value(), n.base_color_texture.has_value());
      if (!m.base_color_texture) continue;
      EXPECT_EQ(scene.textures[*m.base_color_texture].rgba, back.textures[*n.base_color_texture].rgba);
      EXPECT_EQ(scene.textures[*m.base_color_texture].wrap_u, back.textures[*n.base_color_texture].wrap_u);
    }
    ASSERT_EQ(back.lights.size(), scene.lights.size()) << name;
    for (size_t i = 0; i < scene.lights.size(); ++i) {
      EXPECT_EQ(back.lights[i].type, scene.lights[i].type);
      EXPECT_EQ(back.lights[i].intensity, scene.lights[i].intensity);
      EXPECT_NEAR(back.lights[i].map_fov, scene.lights[i].map_fov, 1e-12);
      ASSERT_EQ(back.lights[i].area.has_value(), scene.lights[i].area.has_value());
      if (!scene.lights[i].area) continue;
      EXPECT_EQ(back.lights[i].area->shape, scene.lights[i].area->shape);
      EXPECT_EQ(back.lights[i].area->width, scene.lights[i].area->width);
      EXPECT_EQ(back.lights[i].area->emission.has_value(), scene.lights[i].area->emission.has_value());
    }
    EXPECT_EQ(back.cameras.size(), scene.cameras.size());
    EXPECT_EQ(back.cameras[0].fov_y, scene.cameras[0].fov_y);
  }
}

TEST(SceneExport, HiddenInstancesAreLeftOut) {
  Scene scene = test::load({});
  scene.instances.push_back(scene.instances[0]);
  scene.instances[1].visible = false;
  const test::Folder folder;
  EXPECT_EQ(load_scene(folder.write("back.glb", to_glb(scene))).instances.size(), 1u);
}

}  // namespace
}  // namespace gnomon
