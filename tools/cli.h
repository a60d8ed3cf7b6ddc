// The command line `gnomon`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/params.h"
#include "engine/graph/pass.h"
#include "engine/render/renderer.h"
#include "engine/scene/scene.h"

namespace CLI {
class App;
}

namespace gnomon {

struct Problem;  // engine/base/error.h
struct Row;      // bench/run/row.h

// Exit statuses of the program.
enum ExitStatus : int {
  exit_done = 0,
  exit_failed = 1,     // a comparison or a measurement failed
  exit_bad_input = 2,  // with a message on stderr; nothing half-written
};

// Parses and runs one command; never throws.
int run_cli(int argc, const char* const* argv);

// Each command adds its subcommand and, when chosen, writes its exit status to `status`.
void add_render(CLI::App& app, int& status);
void add_reference(CLI::App& app, int& status);
void add_compare(CLI::App& app, int& status);
void add_bench(CLI::App& app, int& status);
void add_check(CLI::App& app, int& status);
void add_list(CLI::App& app, int& status);
void add_explain(CLI::App& app, int& status);
void add_scene(CLI::App& app, int& status);
void add_edt(CLI::App& app, int& status);
void add_stability(CLI::App& app, int& status);
void add_report(CLI::App& app, int& status);
void add_pick(CLI::App& app, int& status);

// ---- what several commands share ----

// "1280x720": each side in 1..16384 pixels, otherwise Error.
Extent parse_size(const std::string& text);
// "name=value", each name once; Error otherwise.
Values parse_set(const std::vector<std::string>& settings);
// "reversed" or "standard".
bool parse_camera_z(const std::string& text);
// Error when the scene has no such camera.
const Camera& camera_of(const Scene& scene, uint32_t index);
// NAME of assets/scenes (with or without .glb) or FILE.
std::filesystem::path find_scene(const std::string& name_or_file);
// Prints the scene's warnings to stderr. `light_scale`: as with_light_scale().
std::shared_ptr<const Scene> open_scene(const std::string& name_or_file, double light_scale = 1);
void add_light_scale(CLI::App& command, double& light_scale);  // the option --light-scale

struct DeviceFlags {
  std::string part;
  bool validation = false;
  uint64_t memory = uint64_t{1} << 30;  // bytes: RenderSettings::memory
};
void add_device_options(CLI::App& command, DeviceFlags& flags);
std::shared_ptr<Device> open_device(const DeviceFlags& flags);
// Prints the layers' messages; exit_failed when there is one, exit_done otherwise.
int report_validation(const Device& device);

void warn(const std::string& line);                         // "gnomon: warning: line" on stderr
void print_problems(const std::vector<Problem>& problems);  // "gnomon: FILE: ..." on stderr
// Result rows as one JSON array.
void write_rows(const std::filesystem::path& file, const std::vector<Row>& rows);

}  // namespace gnomon
