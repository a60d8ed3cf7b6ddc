// Writes the generated scenes as .glb files.
#include "tools/scene_generate.h"

#include <system_error>

#include "engine/base/error.h"
#include "engine/image/image.h"
#include "tools/scenes/scenes.h"

namespace gnomon {
namespace {

struct Entry {
  const char* name;
  const char* description;
  std::string (*make)();
};

constexpr Entry kEntries[] = {
    {"area_shapes", "A square blocker above a plane under five area lights, one of each shape.",
     generate::area_shapes_scene},
    {"colonnade",
     "An arcade of columns and arches under a barrel vault, seen from within, lit low from outside.",
     generate::colonnade},
    {"fence", "Picket fences with rails on a lawn, back-lit, with long thin shadows towards the camera.",
     generate::fence},
    {"foliage",
     "A tree and shrubs of thousands of small overlapping leaves, some of them alpha-masked cards.",
     generate::foliage},
    {"hills", "A large outdoor ground with bumps, trees and boulders under a low sun (directional light).",
     generate::hills},
    {"lattice", "A perforated vault and a perforated ring: fine, holed and curved casters.",
     generate::lattice},
    {"moving_light", "A spot light that circles above a sphere and a post for two seconds.",
     generate::moving_light},
    {"pendulum",
     "A swinging bob above a plane, with a post that stands still; the second camera swings too (2 s).",
     generate::pendulum},
    {"robot", "A figure of boxes at many angles among tumbled crates.", generate::robot},
    {"sphere_plane", "A finely tessellated sphere above a plane, with a closed-form shadow.",
     generate::sphere_plane_scene},
    {"square_plane", "A square blocker above a plane, with a closed-form umbra and penumbra.",
     generate::square_plane_scene},
    {"sun_and_lamp", "A square high above a plane and a post on it, under a sun of 0.53 degrees and a lamp.",
     generate::sun_and_lamp_scene},
};

}  // namespace

std::vector<SceneGenerator> scene_generators() {
  std::vector<SceneGenerator> result;
  for (const Entry& entry : kEntries) result.push_back({entry.name, entry.description});
  return result;
}

std::string scene_bytes(const std::string& name) {
  std::vector<std::string> names;
  for (const Entry& entry : kEntries) {
    if (name == entry.name) return entry.make();
    names.emplace_back(entry.name);
  }
  fail("unknown scene generator '" + name + "'", {}, {}, did_you_mean(name, names));
}

void generate_scene(const std::string& name, const std::filesystem::path& out_dir) {
  const std::string bytes = scene_bytes(name);
  std::error_code error;
  std::filesystem::create_directories(out_dir, error);
  if (error) fail("the folder cannot be made: " + error.message(), out_dir.string());
  write_text(out_dir / (name + ".glb"), bytes);
}

}  // namespace gnomon
