// What a pass is: the interface that techniques implement, and the declaration that everything else is made
// from.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/shape.h"
#include "engine/scene/scene_sizes.h"

namespace gnomon {

struct SceneFacts;     // engine/light/scene_facts.h
class Environment;     // engine/render/environment.h
class Context;         // engine/render/context.h
enum class LightType;  // engine/scene/scene.h

// How a pass touches a port. Flags: a buffer may be read in several ways by one pass.
enum class Access : uint32_t {
  sampled = 1 << 0,        // image read through a sampler or texelFetch
  storage_read = 1 << 1,   // storage image or buffer
  storage_write = 1 << 2,  // storage image or buffer, every element that is read later is written
  color = 1 << 3,          // colour attachment
  depth = 1 << 4,          // depth (and stencil) attachment, written
  depth_test = 1 << 5,     // depth attachment, read only
  vertex = 1 << 6,         // vertex buffer
  indirect = 1 << 7,       // arguments of an indirect draw or dispatch
  transfer_read = 1 << 8,
  transfer_write = 1 << 9,
  host_read = 1 << 10,   // output: mapped by the host when its segment is done. input, or a loop
                         // controller's own output: what decide() reads
  uniform = 1 << 11,     // input buffer read as a uniform block, all of it: small, and its loads are uniform
  host_write = 1 << 12,  // output buffer that the pass maps and writes while it is recorded
};
constexpr Access operator|(Access a, Access b) { return Access(uint32_t(a) | uint32_t(b)); }
constexpr bool has(Access set, Access one) { return (uint32_t(set) & uint32_t(one)) != 0; }
constexpr bool writes(Access access) {
  return has(access, Access::storage_write | Access::color | Access::depth | Access::transfer_write |
                         Access::host_write);
}

enum class Direction { in, out, inout, transient };

// A buffer that belongs to what an image shows, such as the views that the layers of a map are.
struct Behind {
  uint32_t node = 0;  // that makes it, by its index in the resolved graph
  std::string port;
  BufferShape shape;
};

struct Port {
  std::string name;
  Direction direction = Direction::in;
  Access access = Access::sampled;
  bool is_buffer = false;
  bool array = false;     // GLSL sees a 2D array (layers); otherwise a plain 2D image
  bool optional = false;  // an input that may be left unconnected
  bool kept =
      false;  // an output or transient that keeps its content from iteration to iteration and frame to frame
  bool omittable = false;  // an output that is not there when nobody reads it
  // Of an input that is a shadow map, or made of one: how far from a receiver's place in it texels are read
  // that count. Absent: anywhere.
  std::optional<uint32_t> reach;
  std::string reach_through;  // then the output that those texels are read for; empty: the map ends here
  // What readers may ask for beside the port itself, by name (Declaration::input_behind); of an input: what
  // its source offers.
  std::map<std::string, Behind, std::less<>> behind;
  std::string beside;  // of an input that is connected by itself: the input whose source offers it
  ImageShape image;    // of an input: that of the connected output
  BufferShape buffer;
  Values traits;  // of an input: what its source says of itself; of an output: what this pass does
  std::string help;
};

enum class PassKind { compute, raster, mixed };

// The answer to "does this scene need this pass?", with the reason a person reads.
struct Need {
  enum class Kind { run, constant, bypass } kind = Kind::run;
  struct Constant {
    std::string port;
    float value[4];
  };  // every pixel of `port` has this value
  struct Bypass {
    std::string output, input;
  };  // `output` is `input`, untouched
  std::vector<Constant> constants;
  std::vector<Bypass> bypasses;
  std::string reason;

  static Need run(std::string why = {}) { return {Kind::run, {}, {}, std::move(why)}; }
  static Need constant(std::string port, float value, std::string why) {
    return {Kind::constant, {{std::move(port), {value, value, value, value}}}, {}, std::move(why)};
  }
  static Need bypass(std::string out, std::string in, std::string why) {
    return {Kind::bypass, {}, {{std::move(out), std::move(in)}}, std::move(why)};
  }
};

// Collects one pass instance's ports and parameters. declare() runs as ordinary code: parameters return their
// resolved values and inputs the shape of what is connected, so output shapes may depend on both. It is also
// run with defaults and nothing connected, for listings and for the JSON schema.
class Declaration {
 public:
  // What declare() may depend on beside parameters and inputs; all of it known without a device.
  struct Setting {
    Extent viewport{1280, 720};
    uint32_t lights = 1;                  // lights of the scene; images per light have that many layers
    uint64_t memory = uint64_t{1} << 30;  // bytes that a technique's shadow maps may take at a time
    std::vector<LightType> light_types;   // of each light; empty: not known
    SceneSizes scene{};                   // its geometry
  };
  // shapes and traits of the connected outputs, by input name; empty: nothing is connected (listing)
  struct Connected {
    std::optional<ImageShape> image;
    std::optional<BufferShape> buffer;
    Values traits = {};
    std::map<std::string, Behind, std::less<>> behind;
    uint32_t node = 0;  // the source
    std::string port;
  };
  using Inputs = std::map<std::string, Connected, std::less<>>;

  Declaration() = default;  // listing: defaults, nothing connected
  Declaration(Setting setting, Values given, Inputs inputs)
      : setting_(std::move(setting)), given_(std::move(given)), inputs_(std::move(inputs)) {}

  const Setting& setting() const { return setting_; }

  void kind(PassKind kind) { kind_ = kind; }                      // default: compute
  void summary(std::string text) { summary_ = std::move(text); }  // one sentence
  void cite(std::string text) { cite_ = std::move(text); }        // paper and equations

  // Parameters. Return the resolved value. Ranges are inclusive.
  bool flag(std::string name, bool standard, std::string help);
  int64_t integer(std::string name, int64_t standard, int64_t min, int64_t max, std::string unit,
                  std::string help);
  double number(std::string name, double standard, double min, double max, std::string unit,
                std::string help);
  std::string choice(std::string name, std::string standard, std::vector<std::string> choices,
                     std::string help);
  // A declared parameter's value is refused for what its range cannot say: "'kernel' is 4: must be odd".
  void refuse(std::string_view name, std::string_view must_be);

  // A number that the pass shares with its shaders: they see `const int` or `const float NAME = value`, by
  // its type. Declared again it must be the same.
  void constant(std::string name, Value value);

  // Image ports. `array`: GLSL sees an array with layers. Return the connected image's shape (listing: 1x1).
  ImageShape input(std::string name, Access access, bool array, std::string help);
  std::optional<ImageShape> optional_input(std::string name, Access access, bool array, std::string help);
  ImageShape inout(std::string name, Access access, bool array, std::string help);
  void output(std::string name, Access access, bool array, ImageShape shape, std::string help);
  // An image of this pass alone, aliased with others' like every intermediate.
  void transient(std::string name, Access access, bool array, ImageShape shape, std::string help);

  // Of an image of its own: what one iteration of a loop or one frame wrote, the next one finds. Undefined
  // before the first write.
  void keep(std::string_view name);

  // Of an output: it need not be there when nobody reads it (Environment::connected).
  void omit_unread(std::string_view name);
  // Of an input that is a shadow map, or made of one: what is further than `texels` from a receiver's place
  // in it cannot change what this pass makes. `through`: of a pass that makes another map of it, that output.
  // Casters that only unread texels show need not be drawn (Environment::reach).
  void reads_around(std::string_view input, uint32_t texels, std::string_view through = {});

  // Traits: what is true of an output beside its shape, by name, for those who read it: how depth is encoded,
  // what was filtered. The engine carries them and knows none of them.
  void set_trait(std::string_view output, std::string key, Value value);
  // What the source of an input says of itself is true of the output, too, but for what is set later. An
  // inout has its source's traits by itself. So is what stands behind it (below).
  void carry_traits(std::string_view input, std::string_view output);
  // Of an input's source; nullptr: it says nothing of that, or nothing is connected.
  const Value* trait(std::string_view input, std::string_view key) const;
  bool is_connected(std::string_view input) const;
  // The source of `input` is not what this pass can read: "holds moments, not depth". Told with both nodes.
  void refuse_source(std::string_view input, std::string why);
  // A value that `input`'s source decides (spec.default_value): the pass and its shaders see it as a
  // parameter; a graph file cannot set it.
  void derived(std::string_view input, ParamSpec spec);

  // Readers of the image `output` may ask for what the buffer `input` of this pass is connected to, by that
  // name; of an image `input`, for all that they may ask its source for.
  void offer_behind(std::string_view input, std::string_view output);
  // A buffer that the source of the input `beside` offers by this name. It is connected by itself; the second
  // kind only where there is one.
  BufferShape input_behind(std::string name, std::string_view beside, Access access, std::string help);
  std::optional<BufferShape> optional_input_behind(std::string name, std::string_view beside, Access access,
                                                   std::string help);

  // This pass darkens surfaces that no caster shades: with its own errors it stays even then.
  void darkens_lit_surfaces() { darkens_ = true; }

  // Buffer ports.
  BufferShape input_buffer(std::string name, Access access, std::string help);
  std::optional<BufferShape> optional_input_buffer(std::string name, Access access, std::string help);
  BufferShape inout_buffer(std::string name, Access access, std::string help);
  void output_buffer(std::string name, Access access, BufferShape shape, std::string help);
  void transient_buffer(std::string name, Access access, BufferShape shape, std::string help);

  PassKind kind() const { return kind_; }
  bool darkens() const { return darkens_; }
  const std::string& summary() const { return summary_; }
  const std::string& cite() const { return cite_; }
  const std::vector<Port>& ports() const { return ports_; }
  const std::vector<ParamSpec>& param_specs() const { return specs_; }
  const Values& constants() const { return constants_; }
  const Port* find(std::string_view port) const;
  // Values given but not declared are for the caller to report; out-of-range or mistyped ones are collected
  // here as sentences ("'size' is 0: must be in 1..16384 texels").
  const std::vector<std::string>& value_errors() const { return value_errors_; }
  std::vector<std::string> undeclared() const;  // names given that are no parameter of a graph file
  Params params() const;                        // every parameter: given value, default, or derived
  struct SourceError {
    std::string input, why;
  };
  const std::vector<SourceError>& source_errors() const { return source_errors_; }

 private:
  using Offers = std::map<std::string, Behind, std::less<>>;
  Setting setting_;
  std::map<std::string, Offers, std::less<>> offers_;  // of outputs that may yet be declared
  Values given_, resolved_, constants_;
  Inputs inputs_;
  PassKind kind_ = PassKind::compute;
  bool darkens_ = false;
  std::string summary_, cite_;
  std::vector<Port> ports_;
  std::vector<ParamSpec> specs_;
  std::vector<std::string> value_errors_;
  std::vector<SourceError> source_errors_;

  Port& declared(std::string_view port);
};

// What a loop's controller sees when the segment that wrote its host-read inputs is done.
struct HostView {
  uint32_t iteration = 0;                                                   // counted from 0
  std::function<std::span<const std::byte>(std::string_view port)> buffer;  // of a host_read port
  // Of a host_read output of its own: what decide() writes, every later pass sees.
  std::function<std::span<std::byte>(std::string_view port)> writable;
};
enum class Step { again, done };

struct Pass {
  virtual ~Pass() = default;
  virtual void declare(Declaration&) const = 0;  // ports, parameters; no device
  virtual Need need(const SceneFacts&, const Params&) const { return Need::run(); }
  virtual void prepare(Environment&) {}                                 // pipelines, once
  virtual void record(Context&) = 0;                                    // once per execution
  virtual Step decide(const HostView&) { return Step::done; }           // only for a loop's controller
  virtual std::map<std::string, double> figures() const { return {}; }  // of the last frame, for run.json
};

// Pass types by name. Filled by GNOMON_PASS before main(); read-only afterwards.
class PassRegistry {
 public:
  using Make = std::unique_ptr<Pass> (*)();
  static PassRegistry& instance();
  bool add(std::string type, Make make);
  std::unique_ptr<Pass> make(std::string_view type) const;  // nullptr: no such type
  std::vector<std::string> types() const;                   // sorted

 private:
  std::map<std::string, Make, std::less<>> makers_;
};

}  // namespace gnomon

// Registers a pass type: GNOMON_PASS("mean_filter", MeanFilter) at namespace scope of its .cpp.
#define GNOMON_PASS(name, Class)                                                                  \
  [[maybe_unused]] static const bool registered_##Class = ::gnomon::PassRegistry::instance().add( \
      name, [] { return std::unique_ptr<::gnomon::Pass>(new Class()); })
