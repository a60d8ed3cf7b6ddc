// The command line: its commands, and exit statuses for what goes wrong.
#include "tools/cli.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/run/row.h"
#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/base/failure.h"
#include "engine/base/interrupt.h"
#include "engine/base/resource_root.h"
#include "engine/graph/graph.h"
#include "engine/image/image.h"
#include "engine/scene/area_light.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kMaxSide = 16384;  // pixels

constexpr const char* kFooter = R"(Examples:
  gnomon render fence --graph rbsm_nonconservative --set shadow_map=2048 --out out/fence
  gnomon bench demo                          every technique on small scenes, with a table
  gnomon explain fence --graph shadow_volumes
  gnomon list graphs

Exit status: 0 done, 1 a comparison or measurement failed, 2 bad input (nothing is written).
Run 'gnomon COMMAND --help' for the options of a command.)";

// Lines of one message after the first are set in, so that none passes for a message of its own.
void print_error(std::string text) {
  while (text.ends_with('\n')) text.pop_back();  // of compilers' logs
  const char* start = "gnomon: ";
  size_t begin = 0;
  while (begin <= text.size()) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    print(stderr, "{}{}\n", start, text.substr(begin, end - begin));
    begin = end + 1;
    start = "gnomon:   ";
  }
}

// What was given where a command was expected: "unknown command 'rendr' (did you mean 'render'?)"; empty:
// nothing was.
std::string unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* at = &app;
  int given = 1;
  for (; !at->get_subcommands().empty(); ++given) at = at->get_subcommands().front();
  if (given >= argc || argv[given][0] == '-') return {};
  std::vector<std::string> names;
  for (const CLI::App* command : at->get_subcommands({})) names.push_back(command->get_name());
  return to_string(
      Problem{fmt::format("unknown command '{}'", argv[given]), {}, {}, did_you_mean(argv[given], names)});
}

int parse(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
    return exit_done;
  } catch (const CLI::Success& done) {  // --help, --version
    app.exit(done);
    return exit_done;
  } catch (const CLI::ParseError& error) {
    const bool no_command = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
                            std::string(error.what()).find("subcommand") != std::string::npos;
    const std::string unknown = no_command ? unknown_command(app, argc, argv) : std::string();
    print_error(unknown.empty() ? error.what() : unknown);
    print(stderr, "Run 'gnomon --help' for the commands, 'gnomon COMMAND --help' for their options.\n");
    return exit_bad_input;
  }
}

int run(int argc, const char* const* argv) {
  CLI::App app(
      "Gnomon: real-time shadow techniques, their error against a ray-traced reference and their run time.",
      "gnomon");
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("gnomon ") + version());
  app.require_subcommand(1);
  int status = exit_done;
  add_render(app, status);
  add_reference(app, status);
  add_compare(app, status);
  add_bench(app, status);
  add_report(app, status);
  add_pick(app, status);
  add_explain(app, status);
  add_check(app, status);
  add_list(app, status);
  add_scene(app, status);
  add_edt(app, status);
  add_stability(app, status);
  const int parsed = parse(app, argc, argv);
  return parsed == exit_done ? status : parsed;
}

// What a command was given to work on: "render fence"; for errors that name no place.
std::string input_of(int argc, const char* const* argv) {
  std::string text;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i)
    text += (text.empty() ? "" : " ") + std::string(argv[i]);
  return text;
}

}  // namespace

void print_problems(const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) print_error(to_string(problem));
}

void write_rows(const fs::path& file, const std::vector<Row>& rows) {
  nlohmann::json list = nlohmann::json::array();
  for (const Row& row : rows) list.push_back(to_json(row));
  write_text(file, list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

int run_cli(int argc, const char* const* argv) {
  // Standard output is for results.
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("gnomon", std::make_shared<spdlog::sinks::stderr_sink_mt>()));
  spdlog::set_pattern("gnomon: warning: %v");
  try {
    return run(argc, argv);
  } catch (const Interrupted& interrupted) {
    print_error(fmt::format("ended by {}", interrupted.signal == SIGINT ? "SIGINT" : "SIGTERM"));
    constexpr int killed = 128;  // as shells report it
    return killed + interrupted.signal;
  } catch (...) {
    print_problems(problems_of(std::current_exception(), input_of(argc, argv)));
  }
  return exit_bad_input;
}

Extent parse_size(const std::string& text) {
  const char* const end = text.data() + text.size();
  Extent size{0, 0};
  const auto width = std::from_chars(text.data(), end, size.width);
  bool good = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  if (good) {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    good = height.ec == std::errc() && height.ptr == end;
  }
  if (!good) fail(fmt::format("size '{}' is not WIDTHxHEIGHT", text), {}, "--size", "--size 1280x720");
  const auto in_range = [](uint32_t side) { return side >= 1 && side <= kMaxSide; };
  if (!in_range(size.width) || !in_range(size.height))
    fail(fmt::format("size {}: each side must be in 1..{} pixels", text, kMaxSide), {}, "--size");
  return size;
}

Values parse_set(const std::vector<std::string>& settings) {
  Values values;
  Problems problems;
  for (const std::string& setting : settings) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == setting.size())
      problems.add(fmt::format("'{}' is not NAME=VALUE", setting), {}, "--set", "--set shadow_map=2048");
    else if (!values.emplace(setting.substr(0, equals), parse_value(setting.substr(equals + 1))).second)
      problems.add(fmt::format("'{}' is set twice", setting.substr(0, equals)), {}, "--set");
  }
  problems.raise();
  return values;
}

bool parse_camera_z(const std::string& text) {
  if (text != "reversed" && text != "standard")
    fail(fmt::format("camera depth '{}' is not known", text), {}, "--camera-z", "one of: reversed, standard");
  return text == "reversed";
}

const Camera& camera_of(const Scene& scene, uint32_t index) {
  if (index >= scene.cameras.size())
    fail(fmt::format("camera {} does not exist: the scene has {} (counted from 0)", index,
                     scene.cameras.size()),
         scene.file.string(), "--camera");
  return scene.cameras[index];
}

fs::path find_scene(const std::string& name_or_file) {
  fs::path given(name_or_file);
  // A folder of the scene's name (images of it, say) is not meant.
  if (fs::is_regular_file(given)) return given;
  const fs::path folder = resource_root() / "assets" / "scenes";
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".glb" && path.extension() != ".gltf") continue;
    if (path.stem() == name_or_file) return path;
    names.push_back(path.stem().string());
  }
  std::sort(names.begin(), names.end());
  fail("no such scene file", name_or_file, {}, did_you_mean(name_or_file, names));
}

std::shared_ptr<const Scene> open_scene(const std::string& name_or_file, double light_scale) {
  auto scene =
      std::make_shared<const Scene>(with_light_scale(load_scene(find_scene(name_or_file)), light_scale));
  for (const std::string& message : scene->warnings.messages) warn(message);
  return scene;
}

void add_light_scale(CLI::App& command, double& light_scale) {
  command
      .add_option("--light-scale", light_scale,
                  "factor of the size of the scene's area lights; 0: all shine from their centre")
      ->type_name("X")
      ->capture_default_str();
}

void add_device_options(CLI::App& command, DeviceFlags& flags) {
  command
      .add_option(
          "--device", flags.part,
          "part of the device's name, any case (default: a GPU, else lavapipe; see 'gnomon list devices')")
      ->type_name("PART");
  command
      .add_option("--memory", flags.memory,
                  "limit of what a technique's images and buffers take, as 512MB or 2GB: further maps of "
                  "area lights wait their turn, and what needs more is refused")
      ->transform(CLI::AsSizeValue(false))
      ->check(CLI::Range(uint64_t{1} << 20, uint64_t{1} << 40))
      ->default_str("1GB");
  command.add_flag("--validation", flags.validation,
                   "Vulkan validation and synchronisation validation; a message makes the exit status 1");
}

std::shared_ptr<Device> open_device(const DeviceFlags& flags) {
  return open_device(DeviceOptions{flags.part, flags.validation});
}

int report_validation(const Device& device) {
  const std::vector<std::string>& messages = validation_messages(device);
  for (const std::string& message : messages) print(stderr, "gnomon: validation: {}\n", message);
  return messages.empty() ? exit_done : exit_failed;
}

void warn(const std::string& line) { print(stderr, "gnomon: warning: {}\n", line); }

}  // namespace gnomon
