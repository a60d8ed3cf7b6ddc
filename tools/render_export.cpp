// Writes what a frame is made of, and its truth, as EXR files and one JSON file.
#include "tools/render_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/error/truth.h"
#include "bench/run/progress.h"
#include "engine/base/error.h"
#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"
#include "engine/scene/animation.h"
#include "engine/scene/wide_spot.h"
#include "engine/vulkan/shader.h"
#include "passes/map/map_traits.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Row after row.
json matrix_json(const glm::dmat4& m) {
  json rows = json::array();
  for (int r = 0; r < 4; ++r) rows.push_back({m[0][r], m[1][r], m[2][r], m[3][r]});
  return rows;
}

bool is_shadow_map(const Port& port) {
  const bool made = port.direction == Direction::out || port.direction == Direction::inout;
  return made && !port.is_buffer && !port.behind.empty() && port.image.mips == 1 &&
         port.traits.contains(map_trait::kEncoding) && !port.traits.contains(map_trait::kBasis) &&
         !port.traits.contains(map_trait::kPyramid);
}

// Some channels of an image, by the names they are to have.
Image picked(const Image& from, const std::vector<std::pair<std::string, std::string>>& names) {
  std::vector<std::string> channels;
  for (const auto& [name, source] : names) channels.push_back(name);
  Image image(from.width, from.height, channels);
  for (size_t i = 0; i < names.size(); ++i) {
    const auto plane = from.plane(names[i].second);
    std::copy(plane.begin(), plane.end(), image.plane(i).begin());
  }
  return image;
}

std::string visibility_channel(size_t light) {
  return light == 0 ? "Y" : "light" + std::to_string(light) + ".Y";
}

class Exporter {
 public:
  Exporter(OutputFolder& folder, const RenderJob& job, double seconds)
      : folder_(folder), scene_(job.scene->animation ? posed(*job.scene, seconds) : *job.scene) {
    const Camera& camera = scene_.cameras[job.settings.camera];
    document_ = {{"schema", 1},
                 {"scene", job.scene->file.string()},
                 {"graph", job.graph.name},
                 {"seconds", seconds},
                 {"size", {job.settings.width, job.settings.height}},
                 {"rows", "row 0 at the top"},
                 {"camera", camera_json(camera, double(job.settings.width) / job.settings.height)},
                 {"lights", json::array()},
                 {"files", json::object()},
                 {"shadow_maps", json::array()}};
    for (const auto& [name, value] : job.graph.vars) document_["vars"][name] = to_string(value);
    for (const Light& light : scene_.lights) document_["lights"].push_back(light_json(light));
  }

  const Scene& scene() const { return scene_; }

  void add(const std::string& name, const Image& image, const std::string& meaning) {
    write_exr(folder_.file(name), image);
    document_["files"][name] = {{"channels", image.channels}, {"meaning", meaning}};
  }

  void add_surfaces(const Image& reference) {
    add("depth.exr", picked(reference, {{"Z", "Z"}}),
        "distance along the view axis, world units; infinite where there is no geometry");
    add("normal.exr",
        picked(reference, {{"geometric.X", "N.x"},
                           {"geometric.Y", "N.y"},
                           {"geometric.Z", "N.z"},
                           {"X", "Ns.x"},
                           {"Y", "Ns.y"},
                           {"Z", "Ns.z"}}),
        "unit shading normal, and the triangle's own; world axes, towards the camera on double-sided meshes");
    add("albedo.exr", picked(reference, {{"R", "albedo.R"}, {"G", "albedo.G"}, {"B", "albedo.B"}}),
        "linear base colour");
    add("position.exr", picked(reference, {{"X", "P.x"}, {"Y", "P.y"}, {"Z", "P.z"}}),
        "world axes and units, relative to the camera's position");
    std::vector<std::pair<std::string, std::string>> visible;
    for (size_t i = 0; i < scene_.lights.size(); ++i)
      visible.emplace_back(visibility_channel(i), visibility_channel(i));
    add("reference.exr", picked(reference, visible),
        "ray-traced visibility, a channel a light: 0 umbra, 1 lit");
  }

  void add_map(const std::string& port, const Image& image, const Renderer::MapViews& map) {
    const std::string name = "map_" + as_file_name(port) + ".exr";
    add(name, image, "depth from the light, a channel a view; 1 where there is nothing");
    json views = json::array();
    for (size_t i = 0; i < map.views.size(); ++i) {
      const LightView& view = map.views[i];
      views.push_back({{"channel", image.channels.at(i)},
                       {"light", view.light},
                       {"projection", view.orthographic ? "orthographic" : "perspective"},
                       {"near", view.near},
                       {"far", view.far},
                       {"half_width", view.half_width},
                       {"half_height", view.half_height},
                       {"light_from_world", matrix_json(view.light_from_world)},
                       {"clip_from_light", matrix_json(view.clip_from_light())}});
    }
    document_["shadow_maps"].push_back({{"file", name},
                                        {"port", port},
                                        {"encoding", to_string(map.traits.at(map_trait::kEncoding))},
                                        {"views", views}});
  }

  void finish() { write_text(folder_.file("frame.json"), document_.dump(2) + "\n"); }

 private:
  static json camera_json(const Camera& camera, double aspect) {
    const glm::dvec2 half = half_extent(camera, aspect);
    return {{"name", camera.name},
            {"projection", camera.span ? "orthographic" : "perspective"},
            {"world_from_camera", matrix_json(camera.world_from_camera)},
            {"half_width", half.x},  // tangents of the half angles, or world units
            {"half_height", half.y},
            {"near", camera.near}};
  }

  static json light_json(const Light& light) {
    const char* types[] = {"spot", "point", "directional"};  // as LightType has them
    json result = {{"name", light.name},
                   {"type", types[static_cast<size_t>(light.type)]},
                   {"world_from_light", matrix_json(light.world_from_light)},
                   {"color", {light.color.r, light.color.g, light.color.b}},
                   {"intensity", light.intensity}};
    if (light.type == LightType::spot) result["outer_cone"] = light.outer_cone;
    if (light.area) result["area"] = {light.area->width, light.area->height};
    return result;
  }

  OutputFolder& folder_;
  Scene scene_;
  json document_;
};

}  // namespace

void check_export_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error)) fail("is no folder", folder.string(), "--export");
  if (!fs::is_empty(folder, error))
    fail("the folder is not empty, and nothing in it is overwritten", folder.string(), "--export",
         "name a new folder");
}

std::vector<std::string> shadow_map_ports(const RenderJob& job) {
  const Scene& scene = *job.scene;
  Declaration::Setting setting;
  setting.viewport = {job.settings.width, job.settings.height};
  setting.lights = static_cast<uint32_t>(scene.lights.size());
  setting.memory = job.settings.memory;
  for (const Light& light : scene.lights) setting.light_types.push_back(view_type(light));
  setting.scene = scene_sizes(scene);
  const SceneFacts facts = scene_facts(scene, scene.cameras[job.settings.camera],
                                       double(job.settings.width) / job.settings.height, job.settings.height);
  CompileOptions options;
  options.keep_all = job.settings.keep_all;
  const Plan plan =
      compile(job.graph, setting, job.settings.keep_all ? promising_nothing(facts) : facts, options);
  std::vector<std::string> ports;
  for (const PlanNode& node : plan.nodes)
    for (const Port& port : node.declaration.ports())
      if (is_shadow_map(port) && node.resources.contains(port.name))
        ports.push_back(node.id + "." + port.name);
  return ports;
}

void write_export(OutputFolder& folder, const RenderJob& job, Renderer& renderer, const Image& visibility,
                  const std::vector<std::string>& ports, double seconds) {
  Exporter exporter(folder, job, seconds);
  ReferenceSettings settings;
  settings.width = job.settings.width, settings.height = job.settings.height;
  settings.samples = job.samples.value_or(0), settings.camera = job.settings.camera;
  Progress progress("reference " + job.scene->name);
  settings.progress = [&](double share) { progress.update(share); };
  exporter.add_surfaces(to_image(cached_reference(exporter.scene(), settings, cache_folder())));
  exporter.add("visibility.exr", visibility, "the technique's visibility, a channel a light: 0 umbra, 1 lit");
  for (const std::string& port : ports)
    if (const auto map = renderer.map_views(port)) exporter.add_map(port, renderer.read(port), *map);
  exporter.finish();
}

}  // namespace gnomon
