// Passes that only declare, for tests of the compiler.
#include <algorithm>

#include "engine/light/scene_facts.h"
#include "tests/engine/plan/fake_passes.h"

namespace gnomon::test {
namespace {

constexpr VkFormat value_format = VK_FORMAT_R32_SFLOAT;
constexpr Access sampled = Access::sampled;
constexpr Access written = Access::storage_write;
constexpr Access changed = Access::storage_read | Access::storage_write;
constexpr Access counted = Access::storage_write | Access::host_read;

struct Fake : Pass {
  void record(Context&) override {}
};

ImageShape full_screen(const Declaration& d, VkFormat format = value_format, uint32_t layers = 1) {
  return {d.setting().viewport, layers, 1, format};
}

void result(Declaration& d, ImageShape shape) { d.output("result", written, false, shape, "the result"); }

struct Source : Fake {
  void declare(Declaration& d) const override {
    d.kind(PassKind::raster);
    d.summary("draws");
    d.output("color", Access::color, false, full_screen(d, VK_FORMAT_R8G8B8A8_UNORM), "colour");
    d.output("depth", Access::depth, false, full_screen(d, VK_FORMAT_D32_SFLOAT), "depth");
  }
};

struct PlainValue : Fake {
  void declare(Declaration& d) const override {
    d.number("level", 0.5, 0, 1, "1", "the value");
    result(d, full_screen(d));
  }
};

struct Filter : Fake {
  void declare(Declaration& d) const override {
    d.summary("filters");
    d.integer("width", 3, 1, 31, "texels", "side of the kernel");
    d.choice("mode", "box", {"box", "tent", "gauss"}, "shape of the kernel");
    d.flag("clamp", true, "clamp to the border");
    d.number("scale", 1, 0.5, 2, "world units", "scale");
    ImageShape shape = d.input("source", sampled, false, "what to filter");
    result(d, full_screen(d));
    (void)shape;
  }
};

struct Blend : Fake {
  void declare(Declaration& d) const override {
    d.input("a", sampled, false, "one");
    d.input("b", sampled, false, "other");
    d.optional_input("c", sampled, false, "a third");
    result(d, full_screen(d));
  }
};

struct Modify : Fake {
  void declare(Declaration& d) const override {
    d.inout("target", changed, false, "changed in place");
    d.optional_input("guide", sampled, false, "guide");
  }
};

struct Overlay : Fake {
  void declare(Declaration& d) const override {
    d.kind(PassKind::raster);
    d.inout("target", Access::color, false, "drawn over");
  }
};

struct Count : Fake {
  void declare(Declaration& d) const override {
    d.input("source", sampled, false, "what is counted");
    d.output_buffer("count", counted, {16, 4, "uint"}, "how many");
  }
};

struct Host : Fake {
  void declare(Declaration& d) const override {
    d.input_buffer("count", Access::host_read, "read when recording");
    d.optional_input("source", sampled, false, "source");
    result(d, full_screen(d));
  }
};

struct StepPass : Fake {
  void declare(Declaration& d) const override {
    d.inout_buffer("state", changed, "state of the loop");
    d.optional_input("guide", sampled, false, "guide");
    d.output_buffer("votes", counted, {4, 4, "uint"}, "whether to go on");
  }
};

struct Decide : Fake {
  void declare(Declaration& d) const override {
    d.input_buffer("votes", Access::host_read, "whether to go on");
    d.optional_input("source", sampled, false, "source");
    result(d, full_screen(d));
  }
};

struct MakeBuffer : Fake {
  void declare(Declaration& d) const override {
    d.output_buffer("data", written, {1024, 16, "vec4"}, "data");
  }
};

struct Sum : Fake {
  void declare(Declaration& d) const override {
    d.input_buffer("data", Access::storage_read, "data");
    result(d, full_screen(d));
  }
};

struct History : Fake {
  void declare(Declaration& d) const override {
    d.input("source", sampled, false, "this frame");
    d.optional_input("last", sampled, false, "the frame before");
    result(d, full_screen(d));
  }
};

struct Scratch : Fake {
  void declare(Declaration& d) const override {
    d.input("source", sampled, false, "source");
    d.transient("rows", changed, false, full_screen(d), "rows only");
    result(d, full_screen(d));
  }
};

struct Constant : Filter {
  Need need(const SceneFacts& facts, const Params&) const override {
    return facts.triangles ? Need::run() : Need::constant("result", 1, "nothing casts a shadow");
  }
};

struct BypassPass : Fake {
  void declare(Declaration& d) const override { result(d, d.input("source", sampled, false, "source")); }
  Need need(const SceneFacts& facts, const Params&) const override {
    return facts.triangles ? Need::run() : Need::bypass("result", "source", "nothing to filter");
  }
};

struct Layers : Fake {
  void declare(Declaration& d) const override {
    d.output("result", written, true, full_screen(d, value_format, d.setting().lights), "one layer a light");
  }
};

struct Huge : Fake {
  void declare(Declaration& d) const override {
    const auto side = uint32_t(d.integer("side", 1, 0, 4294967295, "texels", "side"));
    result(d, {{side, side}, 4096, 1, VK_FORMAT_R32G32B32A32_SFLOAT});
  }
};

struct Batches : Fake {
  void declare(Declaration& d) const override {
    constexpr uint64_t layer = 64 * 64 * 4;
    const auto layers = uint32_t(std::clamp<uint64_t>(d.setting().memory / layer, 1, 16));
    d.transient("maps", changed, true, {{64, 64}, layers, 1, value_format}, "as many as fit");
    result(d, full_screen(d));
  }
};

struct Target : Fake {
  void declare(Declaration& d) const override {
    d.output("target", written, false, full_screen(d), "to be changed in place");
    d.output("guide", written, false, full_screen(d), "beside it");
  }
};

struct Says : Fake {
  void declare(Declaration& d) const override {
    const std::string tone = d.choice("tone", "warm", {"warm", "cold"}, "of the result");
    result(d, full_screen(d));
    d.set_trait("result", "tone", tone);
    d.set_trait("result", "parts", int64_t{3});
  }
};

struct Carries : Fake {
  void declare(Declaration& d) const override {
    d.input("source", sampled, false, "source");
    result(d, full_screen(d));
    d.carry_traits("source", "result");
    d.set_trait("result", "filtered", true);
  }
};

struct Asks : Fake {
  void declare(Declaration& d) const override {
    d.input("source", sampled, false, "source");
    d.optional_input("last", sampled, false, "the frame before");
    const Value* tone = d.trait("source", "tone");
    if (d.is_connected("source") && !tone) d.refuse_source("source", "has no tone");
    d.derived("source", {"tone",
                         ParamType::choice,
                         tone ? *tone : Value(std::string("warm")),
                         0,
                         0,
                         {"warm", "cold"},
                         {},
                         "of the source"});
    d.integer("width", 3, 1, 31, "texels", "side of the kernel");
    result(d, full_screen(d));
  }
};

template <typename T>
std::unique_ptr<Pass> make() {
  return std::make_unique<T>();
}

}  // namespace

void register_fake_passes() {
  PassRegistry& registry = PassRegistry::instance();
  if (!registry.add("t_source", make<Source>)) return;
  registry.add("t_value", make<PlainValue>);
  registry.add("t_filter", make<Filter>);
  registry.add("t_blend", make<Blend>);
  registry.add("t_modify", make<Modify>);
  registry.add("t_overlay", make<Overlay>);
  registry.add("t_count", make<Count>);
  registry.add("t_host", make<Host>);
  registry.add("t_step", make<StepPass>);
  registry.add("t_decide", make<Decide>);
  registry.add("t_buffer", make<MakeBuffer>);
  registry.add("t_sum", make<Sum>);
  registry.add("t_history", make<History>);
  registry.add("t_scratch", make<Scratch>);
  registry.add("t_constant", make<Constant>);
  registry.add("t_bypass", make<BypassPass>);
  registry.add("t_layers", make<Layers>);
  registry.add("t_huge", make<Huge>);
  registry.add("t_batches", make<Batches>);
  registry.add("t_target", make<Target>);
  registry.add("t_says", make<Says>);
  registry.add("t_carries", make<Carries>);
  registry.add("t_asks", make<Asks>);
}

}  // namespace gnomon::test
