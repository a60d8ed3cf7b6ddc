// gnomon scene: the small scenes that the project makes itself, and what a scene file holds.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "engine/base/error.h"
#include "engine/base/resource_root.h"
#include "engine/graph/graph.h"
#include "engine/image/image.h"
#include "engine/scene/animation.h"
#include "engine/scene/scene.h"
#include "tools/cli.h"
#include "tools/output_folder.h"
#include "tools/scene_export.h"
#include "tools/scene_generate.h"
#include "tools/scene_info.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string name, file;
  fs::path out;
  double time = 0;  // seconds
};

void check_name(const std::string& name) {
  std::vector<std::string> names{"all"};
  for (const SceneGenerator& generator : scene_generators()) {
    if (generator.name == name) return;
    names.push_back(generator.name);
  }
  if (name != "all")
    fail(fmt::format("there is no scene '{}' to generate", name), {}, {}, did_you_mean(name, names));
}

void generate_command(const Options& options) {
  check_name(options.name);
  const fs::path out = options.out.empty() ? resource_root() / "assets" / "scenes" : options.out;
  OutputFolder folder(out);
  std::vector<std::string> names;
  for (const SceneGenerator& generator : scene_generators()) {
    if (options.name != "all" && options.name != generator.name) continue;
    names.push_back(generator.name);
    generate_scene(generator.name, folder.file(generator.name + ".glb").parent_path());
  }
  folder.keep();
  for (const std::string& name : names) {
    const fs::path file = out / (name + ".glb");
    print("{:<16}{:>7} kB  {}\n", name, fs::file_size(file) / 1000, file.lexically_normal().string());
  }
}

void export_command(const Options& options) {
  if (options.out.extension() != ".glb")
    fail("the file's name must end in .glb", options.out.string(), "--out");
  const std::shared_ptr<const Scene> scene = open_scene(options.file, 1);
  if (options.out.has_parent_path()) fs::create_directories(options.out.parent_path());
  write_text(options.out, to_glb(posed(*scene, options.time)));
  print("{}: {} meshes, {} instances, {} triangles\n", options.out.string(), scene->meshes.size(),
        scene->instances.size(), scene->triangles());
}

std::string generator_list() {
  std::string text = "Scenes:\n";
  for (const SceneGenerator& generator : scene_generators())
    text += fmt::format("  {:<16}{}\n", generator.name, generator.description);
  return text + "\nExample:\n  gnomon scene generate fence --out scenes";
}

}  // namespace

void add_scene(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("scene", "generate the small scenes, or say or write what a scene file holds");
  command->require_subcommand(1);
  CLI::App* generate = command->add_subcommand("generate", "write a small scene; the same bytes every time");
  generate->add_option("NAME", options->name, "a scene of the list below, or all")->required();
  generate->add_option("--out,-o", options->out, "folder (default: assets/scenes)")->type_name("DIR");
  generate->footer(generator_list());
  generate->callback([options, &status] {
    generate_command(*options);
    status = exit_done;
  });
  CLI::App* info =
      command->add_subcommand("info", "meshes, materials, lights, cameras, bounds and flaws of a scene");
  info->add_option("FILE", options->file, "a .glb or .gltf file, or the name of a scene in assets/scenes")
      ->required();
  CLI::App* exporting = command->add_subcommand(
      "export", "write a scene as Gnomon has read it: instances, masks, cameras and lights");
  exporting
      ->add_option("FILE", options->file, "a .glb or .gltf file, or the name of a scene in assets/scenes")
      ->required();
  exporting->add_option("--out,-o", options->out, "the file to write")->required()->type_name("FILE.glb");
  exporting->add_option("--time", options->time, "seconds of the scene's animations, whose pose is written")
      ->type_name("S")
      ->capture_default_str();
  exporting->footer("Example:\n  gnomon scene export robot --time 0.5 --out robot-at-half.glb");
  exporting->callback([options, &status] {
    export_command(*options);
    status = exit_done;
  });
  info->callback([options, &status] {
    print_lines(stdout, describe_scene(load_scene(find_scene(options->file))));
    status = exit_done;
  });
}

}  // namespace gnomon
