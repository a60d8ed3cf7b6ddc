// The renderer with small passes of the test's own: loops, history, memory, times, what is left out, bad
// requests.
#include "engine/render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>

#include "engine/base/error.h"
#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R32_SFLOAT;
constexpr Access kWritten = Access::storage_write;

// What the loop's controller saw, turn by turn.
struct Turn {
  uint32_t iteration, recorded, counted;
};
std::vector<Turn> turns;           // of the controller below; cleared by each test
std::vector<uint32_t> host_reads;  // of test_host

std::filesystem::path shader(const std::string& name, const std::string& body) {
  const std::filesystem::path file = test::scratch_folder() / (name + ".glsl");
  if (!std::filesystem::exists(file))
    std::ofstream(file) << "layout(local_size_x = 8, local_size_y = 8) in;\n" << body;
  return file;
}

// Writes `value` to every pixel of `result`.
std::string per_pixel(const std::string& value) {
  return "void main() { ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
         "if (any(greaterThanEqual(at, imageSize(result)))) return;\n"
         "imageStore(result, at, vec4(" +
         value + ")); }\n";
}

ImageShape full_screen(const Declaration& d) { return {d.setting().viewport, 1, 1, kFormat}; }

// A compute pass over the pixels of its output `result`.
class PixelPass : public Pass {
 public:
  PixelPass(std::string name, std::string value) : name_(std::move(name)), value_(std::move(value)) {}
  void prepare(Environment& e) override { pipeline_ = e.compute(shader(name_, per_pixel(value_)).string()); }
  void record(Context& c) override { c.dispatch_over(pipeline_, c.shape("result").extent); }

 private:
  std::string name_, value_;
  Pipeline pipeline_;
};

struct Ramp : PixelPass {
  Ramp() : PixelPass("ramp", "float(at.x + 64 * at.y)") {}
  void declare(Declaration& d) const override {
    d.output("result", kWritten, false, full_screen(d), "a ramp");
  }
};

struct Mix : PixelPass {
  Mix() : PixelPass("mix", "a_at(at).x * 0.75 + b_at(at).x * params.weight + 1.0") {}
  void declare(Declaration& d) const override {
    d.input("a", Access::sampled, false, "one");
    d.input("b", Access::sampled, false, "other");
    d.number("weight", 0.5, 0, 1, "1", "the other's weight");
    d.output("result", kWritten, false, full_screen(d), "a mixture");
  }
};

struct Accumulate : PixelPass {
  Accumulate() : PixelPass("accumulate", "last_at(at).x + 1.0") {}
  void declare(Declaration& d) const override {
    d.input("last", Access::sampled, false, "the frame before");
    d.output("result", kWritten, false, full_screen(d), "one more");
  }
};

// Half of its input, unless the strength is 0: then the scene does not need it.
struct Constant : PixelPass {
  Constant() : PixelPass("constant", "0.25 + 0.0 * params.strength") {}
  void declare(Declaration& d) const override {
    d.number("strength", 0, 0, 1, "1", "0: a constant");
    d.output("result", kWritten, false, full_screen(d), "a quarter everywhere");
  }
  Need need(const SceneFacts&, const Params& p) const override {
    return p.number("strength") > 0 ? Need::run() : Need::constant("result", 0.25f, "the strength is 0");
  }
};
struct Bypass : PixelPass {
  Bypass() : PixelPass("bypass", "source_at(at).x") {}
  void declare(Declaration& d) const override {
    d.output("result", kWritten, false, d.input("source", Access::sampled, false, "source"), "the source");
  }
  Need need(const SceneFacts&, const Params&) const override {
    return Need::bypass("result", "source", "it changes nothing");
  }
};

struct Zero : Pass {
  void declare(Declaration& d) const override {
    d.output_buffer("data", Access::transfer_write, {16, 4, "uint"}, "zeros");
  }
  void record(Context& c) override { c.fill("data", 0); }
};

// state[0] counts, state[1 + turn] says which turn wrote it; `votes` is what the host reads.
struct Step : Pass {
  void declare(Declaration& d) const override {
    d.inout_buffer("state", Access::storage_read | Access::storage_write, "counter");
    d.output_buffer("votes", kWritten | Access::host_read, {2, 4, "uint"}, "turn and counter");
  }
  void prepare(Environment& e) override {
    pipeline_ = e.compute(shader("step",
                                 "layout(push_constant) uniform Push { uint turn; };\n"
                                 "void main() { if (gl_GlobalInvocationID.xy != uvec2(0)) return;\n"
                                 "state[0] += 1; if (turn < 15) state[1 + turn] = turn + 100;\n"
                                 "votes[0] = turn; votes[1] = state[0]; }\n")
                              .string());
  }
  void record(Context& c) override {
    c.push(pipeline_, c.iteration());
    c.dispatch(pipeline_, 1);
  }
  Pipeline pipeline_;
};

class Until : public PixelPass {
 public:
  Until() : PixelPass("until", "float(params.turns)") {}
  void declare(Declaration& d) const override {
    d.integer("turns", 5, 1, 1000, "1", "how often");
    d.input_buffer("votes", Access::host_read, "counter");
    d.output("result", kWritten, false, full_screen(d), "the number of turns asked for");
  }
  void prepare(Environment& e) override {
    PixelPass::prepare(e);
    turns_ = uint32_t(e.params().integer("turns"));
  }
  gnomon::Step decide(const HostView& view) override {
    const auto bytes = view.buffer("votes");
    uint32_t votes[2];
    std::memcpy(votes, bytes.data(), sizeof votes);
    turns.push_back({view.iteration, votes[0], votes[1]});
    return votes[1] >= turns_ ? gnomon::Step::done : gnomon::Step::again;
  }

 private:
  uint32_t turns_ = 0;
};

struct Show : PixelPass {
  Show() : PixelPass("show", "at.y == 0 && at.x < 16 ? float(data[at.x]) : 0.0") {}
  void declare(Declaration& d) const override {
    d.input_buffer("data", Access::storage_read, "16 numbers");
    d.output("result", kWritten, false, full_screen(d), "the numbers, in row 0");
  }
};

// Reads on the host, while recording, what the device wrote in the segment before.
struct Host : Pass {
  void declare(Declaration& d) const override {
    d.input_buffer("votes", Access::host_read, "read when recording");
    d.output("result", kWritten, false, full_screen(d), "what the host read");
  }
  void prepare(Environment& e) override {
    pipeline_ = e.compute(
        shader("host", "layout(push_constant) uniform Push { uint value; };\n" + per_pixel("float(value)"))
            .string());
  }
  void record(Context& c) override {
    uint32_t votes[2];
    std::memcpy(votes, c.buffer("votes").bytes().data(), sizeof votes);
    host_reads.push_back(votes[1]);
    c.push(pipeline_, votes[1]);
    c.dispatch_over(pipeline_, c.shape("result").extent);
  }
  Pipeline pipeline_;
};

// Copies the buffer of the frame before through its handle, then counts.
struct CopyBuffer : Pass {
  void declare(Declaration& d) const override {
    d.input_buffer("last", Access::transfer_read, "the frame before");
    d.output_buffer("data", Access::transfer_write | Access::storage_read | kWritten, {16, 4, "uint"},
                    "counters");
  }
  void prepare(Environment& e) override {
    pipeline_ = e.compute(shader("copy_buffer",
                                 "void main() { uint i = gl_GlobalInvocationID.x;\n"
                                 "if (i < 16 && gl_GlobalInvocationID.y == 0) data[i] += i + 1; }\n")
                              .string());
  }
  void record(Context& c) override {
    const VkBufferCopy all{0, 0, 64};
    vkCmdCopyBuffer(c.commands(), c.buffer("last").handle(), c.buffer("data").handle(), 1, &all);
    c.own_barrier();
    c.dispatch(pipeline_, 2);
  }
  Pipeline pipeline_;
};

template <class T>
std::unique_ptr<Pass> make() {
  return std::make_unique<T>();
}

std::string file_with(const std::string& passes, const std::string& outputs) {
  return R"({"schema": 1, "name": "test", "passes": [)" + passes + R"(], "outputs": )" + outputs + "}";
}

// A loop that counts to `wanted`, and shows its state.
std::string loop_graph(int wanted, int max) {
  return file_with(R"({"id": "zero", "type": "test_zero"},
    {"id": "again", "type": "loop", "controller": "until", "max": )" +
                       std::to_string(max) + R"(, "passes": [
      {"id": "step", "type": "test_step", "in": {"state": "zero.data"}},
      {"id": "until", "type": "test_until", "in": {"votes": "step.votes"}, "params": {"turns": )" +
                       std::to_string(wanted) + R"(}}]},
    {"id": "show", "type": "test_show", "in": {"data": "step.state"}})",
                   R"({"visibility": "show.result", "wanted": "until.result"})");
}

// Eight full-screen images, each needed by the next two passes only.
std::string chain() {
  std::string passes = R"({"id": "p0", "type": "test_ramp"}, {"id": "p1", "type": "test_ramp"})";
  for (int i = 2; i < 10; ++i) {
    const auto id = [](int k) { return "\"p" + std::to_string(k); };
    passes += R"(, {"id": )" + id(i) + R"(", "type": "test_mix", "in": {"a": )" + id(i - 2) +
              R"(.result", "b": )" + id(i - 1) + R"(.result"}})";
  }
  return file_with(passes, R"({"visibility": "p9.result"})");
}

class GpuRenderer : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    PassRegistry& r = PassRegistry::instance();
    if (!r.add("test_ramp", make<Ramp>)) return;
    r.add("test_mix", make<Mix>);
    r.add("test_accumulate", make<Accumulate>);
    r.add("test_constant", make<Constant>);
    r.add("test_bypass", make<Bypass>);
    r.add("test_zero", make<Zero>);
    r.add("test_step", make<Step>);
    r.add("test_until", make<Until>);
    r.add("test_show", make<Show>);
    r.add("test_host", make<Host>);
    r.add("test_copy_buffer", make<CopyBuffer>);
  }
  void SetUp() override {
    turns.clear();
    host_reads.clear();
    messages_ = validation_messages(*device()).size();
  }
  void TearDown() override {
    const auto& all = validation_messages(*device());
    for (size_t i = messages_; i < all.size(); ++i) ADD_FAILURE() << all[i];
  }
  static std::shared_ptr<Device> device() { return test::kernel_device(); }
  static RenderSettings settings() {
    RenderSettings s;
    s.width = 64, s.height = 48;
    return s;
  }
  static Renderer renderer(const std::string& graph, const RenderSettings& s = settings()) {
    const auto scene =
        std::make_shared<Scene>(analytic::square_over_plane(analytic::light(LightType::spot, {1.5, 7, 1})));
    return Renderer(device(), scene, parse_graph(graph, "test.json"), s);
  }
  static std::vector<float> plane(Renderer& r, const std::string& output = "visibility") {
    const Image image = r.read(output);
    const auto y = image.plane("Y");
    return {y.begin(), y.end()};
  }
  static std::vector<const PassTiming*> rows(const FrameTiming& t, const std::string& id) {
    std::vector<const PassTiming*> found;
    for (const PassTiming& p : t.passes)
      if (p.id == id) found.push_back(&p);
    return found;
  }

 private:
  size_t messages_ = 0;
};

TEST_F(GpuRenderer, LoopTurnsUntilItsControllerIsDone) {
  Renderer r = renderer(loop_graph(5, 50));
  for (const TimingMode mode : {TimingMode::overlapped, TimingMode::isolated}) {
    turns.clear();
    const FrameTiming t = r.render(mode);
    ASSERT_EQ(turns.size(), 5u);
    for (uint32_t i = 0; i < 5; ++i) {
      EXPECT_EQ(turns[i].iteration, i);
      EXPECT_EQ(turns[i].recorded, i);  // what the body was recorded with
      EXPECT_EQ(turns[i].counted, i + 1);
    }
    const auto values = plane(r);
    EXPECT_EQ(values[0], 5.0f);
    for (int i = 1; i < 16; ++i) EXPECT_EQ(values[i], i <= 5 ? 99.0f + float(i) : 0.0f);
    EXPECT_EQ(plane(r, "wanted")[100], 5.0f);
    // Every turn has a row a pass, and one wait; outside the loop nobody waits.
    EXPECT_EQ(rows(t, "zero").size(), 1u);
    EXPECT_EQ(rows(t, "show").size(), 1u);
    const auto step = rows(t, "step"), until = rows(t, "until");
    ASSERT_EQ(step.size(), 5u);
    ASSERT_EQ(until.size(), 5u);
    std::map<uint32_t, int> waits;
    for (const PassTiming& p : t.passes) {
      const bool inside = p.id == "step" || p.id == "until";
      if (p.host_wait_ms > 0 && inside) ++waits[p.iteration];
      EXPECT_TRUE(inside || p.host_wait_ms == 0) << p.id;
    }
    EXPECT_EQ(waits.size(), 5u);
    for (const auto& [turn, count] : waits) EXPECT_EQ(count, 1) << "turn " << turn;
    for (uint32_t i = 0; i < 5; ++i) EXPECT_EQ(step[i]->iteration, i);
  }
}

TEST_F(GpuRenderer, LoopEndsAtItsLimit) {
  Renderer r = renderer(loop_graph(1000, 3));
  for (int frame = 0; frame < 2; ++frame) {
    turns.clear();
    r.render(TimingMode::none);
    EXPECT_EQ(turns.size(), 3u);
    EXPECT_EQ(plane(r)[0], 3.0f);
  }
}

TEST_F(GpuRenderer, LoopOfOneTurn) {
  Renderer r = renderer(loop_graph(1, 10));
  r.render(TimingMode::none);
  EXPECT_EQ(turns.size(), 1u);
  EXPECT_EQ(plane(r)[0], 1.0f);
}

TEST_F(GpuRenderer, HostReadsWhatTheSegmentBeforeWrote) {
  Renderer r = renderer(file_with(R"({"id": "zero", "type": "test_zero"},
    {"id": "step", "type": "test_step", "in": {"state": "zero.data"}},
    {"id": "host", "type": "test_host", "in": {"votes": "step.votes"}})",
                                  R"({"visibility": "host.result"})"));
  const FrameTiming t = r.render(TimingMode::overlapped);
  EXPECT_EQ(host_reads, (std::vector<uint32_t>{1}));
  EXPECT_EQ(plane(r)[77], 1.0f);
  ASSERT_EQ(rows(t, "step").size(), 1u);
  EXPECT_GT(rows(t, "step")[0]->host_wait_ms, 0.0);
  EXPECT_EQ(rows(t, "zero")[0]->host_wait_ms, 0.0);
}

TEST_F(GpuRenderer, HistoryIsTheFrameBefore) {
  const std::string graph =
      file_with(R"({"id": "acc", "type": "test_accumulate", "in": {"last": "acc.result@previous"}})",
                R"({"visibility": "acc.result"})");
  Renderer r = renderer(graph);
  for (int frame = 1; frame <= 4; ++frame) {
    r.render(frame % 2 ? TimingMode::none : TimingMode::overlapped);
    const auto values = plane(r);
    EXPECT_EQ(std::count(values.begin(), values.end(), float(frame)), 64 * 48);
  }
  Renderer other = renderer(graph);  // starts from zero again
  other.render(TimingMode::none);
  EXPECT_EQ(plane(other)[0], 1.0f);
}

// After an even and an odd number of frames: the copies of history have changed places or not.
TEST_F(GpuRenderer, PlayForgetsTheFramesBefore) {
  Renderer r =
      renderer(file_with(R"({"id": "acc", "type": "test_accumulate", "in": {"last": "acc.result@previous"}})",
                         R"({"visibility": "acc.result"})"));
  for (const int frames : {2, 3, 1}) {
    r.play();
    for (int frame = 1; frame <= frames; ++frame) {
      r.render(TimingMode::none);
      EXPECT_EQ(plane(r)[17], float(frame));
      EXPECT_EQ(r.seconds(), (frame - 1) * settings().frame_seconds);
    }
  }
}

TEST_F(GpuRenderer, HistoryOfABuffer) {
  Renderer r =
      renderer(file_with(R"({"id": "copy", "type": "test_copy_buffer", "in": {"last": "copy.data@previous"}},
    {"id": "show", "type": "test_show", "in": {"data": "copy.data"}})",
                         R"({"visibility": "show.result"})"));
  for (int frame = 1; frame <= 4; ++frame) {
    r.render(TimingMode::none);
    const auto values = plane(r);
    for (int i = 0; i < 16; ++i) EXPECT_EQ(values[i], float(frame * (i + 1))) << "frame " << frame;
  }
}

// Kept buffers are the same whichever copy of the history is in use.
TEST_F(GpuRenderer, HistoryBesideKeptBuffers) {
  const std::string volumes = R"({"id": "gbuffer", "type": "gbuffer"},
    {"id": "silhouettes", "type": "silhouettes"},
    {"id": "volumes", "type": "shadow_volumes", "in": {"depth": "gbuffer.depth", "geometric": "gbuffer.geometric",
      "triangles": "silhouettes.triangles", "facing": "silhouettes.facing", "edges": "silhouettes.edges",
      "counts": "silhouettes.counts"}})";
  Renderer plain = renderer(file_with(volumes, R"({"visibility": "volumes.visibility"})"));
  plain.render(TimingMode::none);
  const auto wanted = plane(plain);
  ASSERT_GT(std::count(wanted.begin(), wanted.end(), 0.0f), 10);
  Renderer r = renderer(file_with(
      volumes + R"(, {"id": "acc", "type": "test_accumulate", "in": {"last": "acc.result@previous"}})",
      R"({"visibility": "volumes.visibility", "count": "acc.result"})"));
  for (int frame = 1; frame <= 3; ++frame) {
    r.render(TimingMode::none);
    EXPECT_EQ(plane(r), wanted) << "frame " << frame;
    EXPECT_EQ(plane(r, "count")[5], float(frame));
  }
}

TEST_F(GpuRenderer, AliasingSavesMemoryAndChangesNothing) {
  RenderSettings s = settings();
  Renderer on = renderer(chain(), s);
  s.alias = false;
  Renderer off = renderer(chain(), s);
  on.render(TimingMode::none);
  off.render(TimingMode::none);
  const auto a = plane(on), b = plane(off);
  EXPECT_EQ(a, b);
  // The same chain on the CPU.
  for (const size_t i : {0u, 63u, 1000u, 3071u}) {
    const float ramp = float(i);
    float p[10] = {ramp, ramp};
    for (int k = 2; k < 10; ++k) p[k] = p[k - 2] * 0.75f + p[k - 1] * 0.5f + 1.0f;
    EXPECT_NEAR(a[i], p[9], 1e-5 * std::max(1.0f, p[9])) << i;
  }
  const MemoryUse with = on.memory(), without = off.memory();
  EXPECT_EQ(with.transient_bytes_without_aliasing, without.transient_bytes);
  EXPECT_GE(with.transient_bytes_without_aliasing, 9u * 64 * 48 * 4);
  EXPECT_LE(double(with.transient_bytes), 0.75 * double(with.transient_bytes_without_aliasing));
  EXPECT_GE(with.transient_bytes, 3u * 64 * 48 * 4);  // three live at once
  EXPECT_GE(with.peak_bytes, with.transient_bytes);
}

TEST_F(GpuRenderer, TimesArePresentAndAddUp) {
  Renderer r = renderer(chain());
  const auto ids = r.passes();
  ASSERT_EQ(ids.size(), 10u);
  r.render(TimingMode::none);  // pipelines are compiled on first use
  for (const TimingMode mode : {TimingMode::overlapped, TimingMode::isolated}) {
    const FrameTiming t = r.render(mode);
    ASSERT_EQ(t.passes.size(), ids.size());
    double sum = 0;
    for (size_t i = 0; i < ids.size(); ++i) {
      EXPECT_EQ(t.passes[i].id, ids[i]);
      EXPECT_EQ(t.passes[i].type, i < 2 ? "test_ramp" : "test_mix");
      EXPECT_EQ(t.passes[i].iteration, 0u);
      EXPECT_GE(t.passes[i].gpu_ms, 0.0);
      EXPECT_GT(t.passes[i].cpu_ms, 0.0);
      EXPECT_EQ(t.passes[i].host_wait_ms, 0.0);
      sum += t.passes[i].gpu_ms;
    }
    EXPECT_GT(t.gpu_ms, 0.0);
    EXPECT_NEAR(sum, t.gpu_ms, 0.03 * t.gpu_ms);
    EXPECT_LE(t.gpu_ms, t.frame_ms);
    EXPECT_GT(t.record_ms, 0.0);
    EXPECT_LE(t.record_ms, t.frame_ms);
  }
  const FrameTiming none = r.render(TimingMode::none);
  EXPECT_TRUE(none.passes.empty());
  EXPECT_EQ(none.gpu_ms, 0.0);
  EXPECT_GT(none.frame_ms, 0.0);
  EXPECT_GT(none.record_ms, 0.0);
}

// With several segments, too, nothing between first and last stamp is lost.
TEST_F(GpuRenderer, TimesOfSegmentsAddUp) {
  Renderer r = renderer(loop_graph(4, 9));
  r.render(TimingMode::none);
  const FrameTiming t = r.render(TimingMode::overlapped);
  double sum = 0;
  for (const PassTiming& p : t.passes) sum += p.gpu_ms;
  EXPECT_EQ(t.passes.size(), 2u + 2 * 4);
  EXPECT_NEAR(sum, t.gpu_ms, 0.03 * t.gpu_ms);
  EXPECT_LE(t.gpu_ms, t.frame_ms);
}

std::string optional_graph(const std::string& strength) {
  return file_with(R"({"id": "ramp", "type": "test_ramp"},
    {"id": "level", "type": "test_constant", "params": {"strength": )" +
                       strength + R"(}},
    {"id": "same", "type": "test_bypass", "in": {"source": "ramp.result"}},
    {"id": "mix", "type": "test_mix", "in": {"a": "same.result", "b": "level.result"}})",
                   R"({"visibility": "mix.result", "level": "level.result", "same": "same.result"})");
}

TEST_F(GpuRenderer, WhatIsLeftOutHasNoRowAndItsConsumersSeeItsValue) {
  Renderer r = renderer(optional_graph("0"));
  EXPECT_EQ(r.passes(), (std::vector<std::string>{"ramp", "mix"}));
  std::map<std::string, std::string> reasons;
  for (const LeftOutPass& l : r.left_out()) reasons[l.pass] = l.reason;
  ASSERT_EQ(reasons.size(), 2u);
  EXPECT_NE(reasons["level"].find("the strength is 0"), std::string::npos);
  EXPECT_NE(reasons["same"].find("it changes nothing"), std::string::npos);
  const FrameTiming t = r.render(TimingMode::overlapped);
  EXPECT_EQ(t.passes.size(), 2u);
  EXPECT_TRUE(rows(t, "level").empty());
  EXPECT_TRUE(rows(t, "same").empty());

  RenderSettings all = settings();
  all.keep_all = true;
  Renderer kept = renderer(optional_graph("0"), all);
  EXPECT_TRUE(kept.left_out().empty());
  EXPECT_EQ(kept.render(TimingMode::overlapped).passes.size(), 4u);
  for (const char* output : {"visibility", "level", "same"}) {
    const auto values = plane(r, output);
    ASSERT_EQ(values.size(), 64u * 48) << output;
    EXPECT_EQ(values, plane(kept, output)) << output;
  }
  EXPECT_EQ(plane(r, "level")[3000], 0.25f);
  EXPECT_EQ(plane(r, "same")[3000], 3000.0f);
  EXPECT_EQ(plane(r)[3000], 3000.0f * 0.75f + 0.25f * 0.5f + 1.0f);
  EXPECT_EQ(renderer(optional_graph("1")).passes().size(), 3u);  // needed: it runs
}

TEST_F(GpuRenderer, CapturesOfPorts) {
  RenderSettings s = settings();
  s.captures = {"p3.result", "p0.result"};
  Renderer r = renderer(chain(), s);
  Renderer without = renderer(chain());
  r.render(TimingMode::none);
  r.render(TimingMode::none);
  without.render(TimingMode::none);
  EXPECT_EQ(plane(r), plane(without));
  EXPECT_EQ(plane(r, "p0.result")[130], 130.0f);
  const float p2 = 130 * 1.25f + 1;
  EXPECT_EQ(plane(r, "p3.result")[130], 130 * 0.75f + p2 * 0.5f + 1);
  EXPECT_THROW(r.read("p4.result"), Error);
  EXPECT_THROW(r.read("nothing"), Error);
  s.captures = {"p3.no_such_port"};
  EXPECT_THROW(renderer(chain(), s), Error);
  s.captures = {"nobody.result"};
  EXPECT_THROW(renderer(chain(), s), Error);
}

TEST_F(GpuRenderer, CaptureOfALeftOutPort) {
  RenderSettings s = settings();
  s.captures = {"level.result", "same.result"};
  Renderer r = renderer(optional_graph("0"), s);
  r.render(TimingMode::none);
  EXPECT_EQ(plane(r, "level.result"), std::vector<float>(64 * 48, 0.25f));
  EXPECT_EQ(plane(r, "same.result")[99], 99.0f);
}

TEST_F(GpuRenderer, CapturesOfDepthAndLayers) {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::point, {1.5, 7, 1}));
  RenderSettings s = settings();
  s.captures = {"map.depth", "gbuffer.depth", "gbuffer.normal"};
  Renderer r(device(), std::make_shared<Scene>(scene),
             load_graph(find_graph("shadow_mapping"), {{"shadow_map", int64_t(32)}}), s);
  r.render(TimingMode::none);
  const Image map = r.read("map.depth");
  EXPECT_EQ(map.width, 32u);
  EXPECT_EQ(map.channels.size(), 6u);
  size_t seen = 0;  // texels of geometry, over all faces
  for (int face = 0; face < 6; ++face) {
    const auto y = map.plane(face == 0 ? "Y" : "light" + std::to_string(face) + ".Y");
    for (const float d : y) {
      ASSERT_TRUE(d >= 0 && d <= 1);
      seen += d < 1;
    }
  }
  EXPECT_GT(seen, 32u * 32u);
  EXPECT_LT(seen, 4u * 32u * 32u);  // nothing lies above the light
  EXPECT_EQ(r.read("gbuffer.depth").width, 64u);
  EXPECT_EQ(r.read("gbuffer.normal").channels.size(), 2u);
}

// What `make` throws, as text; empty when it does not.
template <class Make>
std::string error_of(Make&& make) {
  try {
    make();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST_F(GpuRenderer, GraphsThatDrawNoSceneNeedNone) {
  Renderer with = renderer(chain()),
           without(device(), nullptr, parse_graph(chain(), "test.json"), settings());
  with.render(TimingMode::none);
  without.render(TimingMode::none);
  EXPECT_EQ(plane(without), plane(with));
  const std::string draws =
      file_with(R"({"id": "gbuffer", "type": "gbuffer"})", R"({"depth": "gbuffer.depth"})");
  const std::string message = error_of([&] {
    Renderer(device(), nullptr, parse_graph(draws, "test.json"), settings()).render(TimingMode::none);
  });
  EXPECT_NE(message.find("pass 'gbuffer' draws the scene, and there is none"), std::string::npos) << message;
}

TEST_F(GpuRenderer, SizesThatTheDeviceCannotDo) {
  for (const auto& [w, h] : {std::pair{1u << 20, 16u}, {16u, 1u << 20}, {0xffffffffu, 0xffffffffu}}) {
    RenderSettings s = settings();
    s.width = w, s.height = h;
    EXPECT_NE(error_of([&] { renderer(chain(), s); }), "") << w << "x" << h;
    EXPECT_NE(
        error_of([&] {
          renderer(file_with(R"({"id": "gbuffer", "type": "gbuffer"})", R"({"visibility": "gbuffer.depth"})"),
                   s);
        }),
        "")
        << w << "x" << h;
  }
  for (const auto& [w, h] : {std::pair{0u, 16u}, {16u, 0u}}) {
    RenderSettings s = settings();
    s.width = w, s.height = h;
    EXPECT_NE(error_of([&] { renderer(chain(), s); }), "") << w << "x" << h;
  }
}

TEST_F(GpuRenderer, ACameraThatIsNotThere) {
  RenderSettings s = settings();
  s.camera = 1;
  EXPECT_NE(error_of([&] { renderer(chain(), s); }).find("1 camera"), std::string::npos);
}

TEST_F(GpuRenderer, AnUnknownDeviceNamesThoseThereAre) {
  const std::string text = error_of([] { open_device({"no such device", false}); });
  EXPECT_NE(text.find("no such device"), std::string::npos) << text;
  const auto devices = list_devices();
  ASSERT_FALSE(devices.empty());
  for (const DeviceInfo& d : devices) EXPECT_NE(text.find(d.name), std::string::npos) << text;
}

TEST_F(GpuRenderer, OnePixel) {
  RenderSettings s = settings();
  s.width = s.height = 1;
  Renderer r = renderer(chain(), s);
  r.render(TimingMode::isolated);
  EXPECT_EQ(plane(r).size(), 1u);
}

}  // namespace
}  // namespace gnomon
