// Silhouette edges of casters, against a count on the CPU.
#include <algorithm>
#include <fstream>
#include <map>

#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

constexpr uint32_t kSide = 64;  // of the image that shows the edges

// Shows each light's number of edges, then the first light's edges, four words each.
class ShowEdges : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.input_buffer("edges", Access::storage_read, "silhouette edges");
    d.input_buffer("counts", Access::storage_read, "numbers of them");
    d.output("words", Access::storage_write, false, {{kSide, kSide}, 1, 1, VK_FORMAT_R32_UINT}, "both");
  }
  void prepare(Environment& e) override {
    const auto file = test::scratch_folder() / "show_edges.glsl";
    std::ofstream(file) << R"(layout(local_size_x = 8, local_size_y = 8) in;
      void main() {
        ivec2 at = ivec2(gl_GlobalInvocationID.xy);
        uint i = uint(at.x + 64 * at.y), word = i - LIGHT_COUNT;
        uint value = i < LIGHT_COUNT ? counts[i] : word / 4 < counts[0] ? edges[word / 4][word % 4] : 0;
        imageStore(words, at, uvec4(value));
      })";
    pipeline_ = e.compute(file.string());
  }
  void record(Context& c) override { c.dispatch_over(pipeline_, {kSide, kSide}); }

 private:
  Pipeline pipeline_;
};
GNOMON_PASS("test_show_edges", ShowEdges);

// Its poles are one point each, to the bit.
Mesh closed_sphere() {
  constexpr int kRings = 12, kSegments = 24;
  Mesh mesh = analytic::sphere(1, kRings, kSegments);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const size_t ring = i / kSegments;
    if (ring == 0 || ring == kRings) mesh.positions[i] = {0, ring == 0 ? 1 : -1, 0};
  }
  return mesh;
}

struct Edge {
  uint32_t a, b, instance, mesh_edge;
};

// Two frames with the same edges, of the first light; `counts`: of all lights.
std::vector<Edge> silhouette(const Scene& scene, std::vector<uint32_t>* counts = nullptr) {
  const auto file = test::scratch_folder() / "silhouettes.json";
  std::ofstream(file) << R"({ "schema": 1, "name": "silhouettes", "passes": [
    { "id": "silhouettes", "type": "silhouettes" },
    { "id": "show", "type": "test_show_edges",
      "in": { "edges": "silhouettes.edges", "counts": "silhouettes.counts" } } ],
    "outputs": { "words": "show.words" } })";
  const size_t messages = validation_messages(*hard_shadow::device()).size();
  Renderer renderer(hard_shadow::device(), std::make_shared<Scene>(scene), load_graph(file),
                    hard_shadow::settings(true));
  renderer.render(TimingMode::none);
  renderer.render(TimingMode::none);
  const std::vector<uint32_t> words = renderer.read_words("words");
  EXPECT_EQ(validation_messages(*hard_shadow::device()).size(), messages);
  const size_t lights = scene.lights.size();
  if (counts) counts->assign(words.begin(), words.begin() + std::ptrdiff_t(lights));
  std::vector<Edge> edges;
  for (uint32_t i = 0; i < words[0] && lights + 4 * i + 3 < words.size(); ++i) {
    const uint32_t* w = &words[lights + size_t{4} * i];
    edges.push_back({w[0], w[1], w[2], w[3]});
  }
  return edges;
}

glm::vec3 position(const Scene& scene, uint32_t vertex) {
  for (const Mesh& mesh : scene.meshes) {
    if (vertex < mesh.positions.size()) return mesh.positions[vertex];
    vertex -= uint32_t(mesh.positions.size());
  }
  return glm::vec3(0);
}

// A silhouette bounds an area on a closed surface: as many edges end at a point as begin there.
void expect_loops(const Scene& scene, const std::vector<Edge>& edges) {
  std::map<std::array<float, 3>, int> balance;
  for (const Edge& e : edges) {
    const glm::vec3 a = position(scene, e.a), b = position(scene, e.b);
    ++balance[{a.x, a.y, a.z}], --balance[{b.x, b.y, b.z}];
  }
  for (const auto& [point, sum] : balance)
    EXPECT_EQ(sum, 0) << point[0] << ' ' << point[1] << ' ' << point[2];
}

// Edges of a closed mesh at the origin between a triangle that faces the light and one that does not.
size_t edges_between(const Mesh& mesh, const glm::dvec3& light) {
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> sides;
  for (size_t t = 0; t < mesh.triangles(); ++t) {
    std::array<std::array<float, 3>, 3> corner;
    glm::dvec3 p[3];
    for (size_t k = 0; k < 3; ++k) {
      const glm::vec3 v = mesh.positions[mesh.indices[3 * t + k]];
      corner[k] = {v.x, v.y, v.z}, p[k] = glm::dvec3(v);
    }
    const bool front = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), light - p[0]) > 0;
    for (size_t k = 0; k < 3; ++k) sides[std::minmax(corner[k], corner[(k + 1) % 3])] += front ? 1 : -1;
  }
  return size_t(std::count_if(sides.begin(), sides.end(), [](const auto& s) { return s.second == 0; }));
}

TEST(Silhouettes, AClosedMeshHasClosedLoopsWhereFrontMeetsBack) {
  const glm::dvec3 at(1.5, 7, 1);
  for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
    Scene scene;
    analytic::add(scene, closed_sphere(), {0, 0, 0});
    analytic::add(scene, analytic::square(9), {0, -2, 0});
    scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 0, 0}));
    scene.lights.push_back(analytic::light(type, at));
    std::vector<Edge> of_sphere;
    for (const Edge& e : silhouette(scene))
      if (e.instance == 0) of_sphere.push_back(e);
    const glm::dvec3 place = type == LightType::directional ? 1e6 * at : at;
    EXPECT_EQ(of_sphere.size(), edges_between(scene.meshes[0], place));
    EXPECT_GT(of_sphere.size(), 20u);
    expect_loops(scene, of_sphere);
  }
}

// A square is its own boundary; two that share an edge of one mesh are one, a bend towards the light
// included.
TEST(Silhouettes, AnOpenMeshHasItsBoundary) {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {0.5, 7, 0.25}));
  const std::vector<Edge> edges = silhouette(scene);
  EXPECT_EQ(edges.size(), 8u);  // ground and blocker
  expect_loops(scene, edges);
}

// Where the light is in the plane of a triangle, that casts nothing; a fold seen from its edge bounds twice.
TEST(Silhouettes, AFoldBoundsTwice) {
  Scene scene;
  Mesh fold;
  fold.positions = {{0, 0, -1}, {0, 0, 1}, {0.5, -1, 0}, {0.5, 1, 0}};
  fold.normals.assign(4, {1, 0, 0});
  fold.uvs.assign(4, {0, 0});
  fold.indices = {0, 1, 2, 1, 0, 3};
  analytic::finish(fold);
  analytic::add(scene, fold, {0, 2, 0});
  analytic::add(scene, analytic::square(9), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 1, 0}));
  scene.lights.push_back(analytic::light(LightType::spot, {0, 7, 0}));
  std::vector<Edge> edges = silhouette(scene);
  std::erase_if(edges, [](const Edge& e) { return e.instance != 0; });
  EXPECT_EQ(edges.size(), 6u);  // four of the border, the fold twice
  EXPECT_EQ(std::count_if(edges.begin(), edges.end(), [](const Edge& e) { return e.a + e.b == 1; }), 2);
  expect_loops(scene, edges);
}

TEST(Silhouettes, EveryLightHasItsOwn) {
  Scene scene;
  analytic::add(scene, closed_sphere(), {0, 2, 0});
  analytic::add(scene, analytic::square(9), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 1, 0}));
  const Light lights[] = {analytic::light(LightType::spot, {1.5, 7, 1}),
                          analytic::light(LightType::directional, {-3, 5, 2})};
  std::vector<uint32_t> one[2], both;
  for (int i : {0, 1}) {
    scene.lights = {lights[i]};
    silhouette(scene, &one[i]);
  }
  scene.lights = {lights[0], lights[1]};
  silhouette(scene, &both);
  EXPECT_EQ(both, (std::vector<uint32_t>{one[0][0], one[1][0]}));
}

}  // namespace
}  // namespace gnomon
