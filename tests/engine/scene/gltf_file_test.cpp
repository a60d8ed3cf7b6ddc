// Files, URIs and accessors of glTF.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>

#include "engine/scene/gltf_uri.h"
#include "tests/engine/scene/gltf_draft.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;
using test::Draft;
using test::error_of;
using test::Folder;
using test::load;
using test::raw;
using test::square;
using test::warns;

// The draft as .gltf, with its buffer at `uri`.
std::string text_with(const Draft& draft, const std::string& uri) {
  Json document = draft.document;
  document["buffers"][0]["uri"] = uri;
  return document.dump();
}

std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string error_at(const std::filesystem::path& file) {
  try {
    load_scene(file);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(GltfUri, PercentSignsAndPlusesAreThoseOfRfc3986) {
  EXPECT_EQ(percent_decoded("a+b%2Bc%20d"), "a+b+c d");
  EXPECT_EQ(percent_decoded("%C3%B6.bin"), "\xC3\xB6.bin");
  EXPECT_EQ(percent_decoded("leaf%3.png"), "leaf%3.png");
  EXPECT_EQ(percent_decoded("100%"), "100%");
}

TEST(GltfUri, BuffersAreFoundByTheirUris) {
  const Draft draft;
  const Folder folder;
  folder.write("a+b.bin", draft.data);
  folder.write("with space.bin", draft.data + "more than byteLength");
  for (const char* uri : {"a+b.bin", "a%2Bb.bin", "./a+b.bin", "with%20space.bin", "with space.bin"}) {
    const Scene scene = load_scene(folder.write("draft.gltf", text_with(draft, uri)));
    EXPECT_EQ(scene.triangles(), 2u) << uri;
    EXPECT_FALSE(warns(scene, "outside")) << uri;
  }
}

TEST(GltfUri, DataUrisOfEveryMediaTypeAreRead) {
  const Draft draft;
  const Folder folder;
  for (const char* kind : {"application/octet-stream", "application/gltf-buffer", "application/binary", "",
                           "application/octet-stream;charset=utf-8"})
    EXPECT_EQ(load_scene(folder.write("draft.gltf", text_with(draft, std::string("data:") + kind +
                                                                         ";base64," + base64(draft.data))))
                  .triangles(),
              2u)
        << kind;
}

TEST(GltfUri, ErrorsCutDataUrisAndNameThePlace) {
  const Draft draft;
  const std::string uri = "data:application/octet-stream;base64," + std::string(5000, '?');
  const std::string error = error_of("draft.gltf", text_with(draft, uri));
  EXPECT_NE(error.find("/buffers/0/uri"), std::string::npos) << error;
  EXPECT_NE(error.find(uri.substr(0, 40) + "..."), std::string::npos) << error;
  EXPECT_LT(error.size(), 300u);
  EXPECT_NE(error_of("a.gltf", text_with(draft, "http://example.org/a.bin")).find("relative reference"),
            std::string::npos);
  EXPECT_NE(error_of("a.gltf", text_with(draft, "a%00b")).find("names no file"), std::string::npos);
}

TEST(GltfUri, OnlyRegularFilesAreRead) {
  const Draft draft;
  const Folder folder;
  const std::filesystem::path scene = folder.write("draft.gltf", text_with(draft, "pipe"));
  ASSERT_EQ(mkfifo((scene.parent_path() / "pipe").c_str(), 0600), 0);
  EXPECT_NE(error_at(scene).find("not a file"), std::string::npos);
  EXPECT_NE(error_at(folder.write("draft.gltf", text_with(draft, "/dev/zero"))).find("not a file"),
            std::string::npos);
  EXPECT_NE(error_at(scene.parent_path() / "pipe").find("not a file"), std::string::npos);
  folder.write("short.bin", "1234");
  EXPECT_NE(error_at(folder.write("draft.gltf", text_with(draft, "short.bin"))).find("there are 4 bytes"),
            std::string::npos);
}

// However the way out is written.
TEST(GltfUri, FilesOutsideTheFolderAreTold) {
  const Draft draft;
  const Folder folder;
  const std::filesystem::path home = folder.write("data.bin", draft.data).parent_path(),
                              inner = home / "inner";
  std::filesystem::create_directories(inner);
  std::filesystem::create_symlink(home / "data.bin", inner / "link.bin");
  const std::string absolute = (home / "data.bin").string();
  for (const std::string& uri :
       {std::string("../data.bin"), std::string("%2e%2e/data.bin"), std::string("link.bin"), absolute}) {
    const std::filesystem::path scene = folder.write("inner/draft.gltf", text_with(draft, uri));
    EXPECT_TRUE(warns(load_scene(scene), "/buffers/0: the buffer is outside the scene's folder")) << uri;
  }
  Draft pictured = draft;
  pictured.document["images"] = {{{"uri", "%2e%2e/none.png"}}};
  EXPECT_TRUE(warns(load_scene(folder.write("inner/draft.gltf", text_with(pictured, "../data.bin"))),
                    "/images/0: the image is outside the scene's folder"));
}

TEST(GltfAccessor, SparseIndicesReplaceThose) {
  Draft draft;
  // The draft's indices with the last triangle's replaced: 0 1 2, 0 2 3 become 0 1 2, 1 2 3.
  draft.document["accessors"][1]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", draft.add_view(raw<uint16_t>({3, 4}))}, {"componentType", 5123}}},
      {"values", {{"bufferView", draft.add_view(raw<uint16_t>({1, 2}))}}}};
  EXPECT_EQ(load(draft).meshes[0].triangles(), 2u);
  EXPECT_EQ(load(draft).meshes[0].positions[3], glm::vec3(1, 0, 0));
  // Without a buffer view all others are zeros, which leaves one triangle.
  draft.document["accessors"][1].erase("bufferView");
  draft.document["accessors"][1]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", draft.add_view(raw<uint16_t>({1, 2}))}, {"componentType", 5123}}},
      {"values", {{"bufferView", draft.add_view(raw<uint16_t>({1, 2}))}}}};
  const Scene scene = load(draft);
  EXPECT_EQ(scene.meshes[0].triangles(), 1u);
  EXPECT_EQ(scene.warnings.degenerate_triangles, 1u);
  draft.document["accessors"][1]["sparse"]["values"]["bufferView"] = draft.add_view(raw<uint16_t>({1, 9}));
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("index 9 at 2 is out of range"), std::string::npos);
}

TEST(GltfAccessor, WithoutABufferViewItIsZeros) {
  Draft draft;
  draft.document["accessors"].push_back({{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  draft.primitive()["attributes"]["NORMAL"] = 2;
  const Scene scene = load(draft);
  for (const glm::vec3& n : scene.meshes[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  draft.primitive()["attributes"]["POSITION"] = 2;
  const std::string error = error_of("a.glb", draft.bytes());
  EXPECT_NE(error.find("dropped 2 triangles without area"), std::string::npos) << error;
  draft.document["accessors"][2]["count"] = 2000000000;
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("claims 2000000000 elements"), std::string::npos);
}

TEST(GltfFile, ErrorsSayWhatWasLeftOut) {
  Draft draft;
  draft.primitive()["mode"] = 0;
  draft.document["meshes"][0]["primitives"].push_back(draft.primitive());
  draft.document["meshes"][0]["primitives"][1]["mode"] = 3;
  std::string error = error_of("a.glb", draft.bytes());
  EXPECT_NE(error.find("/meshes/0/primitives/0: points are left out"), std::string::npos) << error;
  EXPECT_NE(error.find("/meshes/0/primitives/1: lines are left out"), std::string::npos) << error;
  draft = Draft{};
  std::vector<float> infinite = square;
  for (size_t i = 0; i < infinite.size(); i += 3) infinite[i] = std::numeric_limits<float>::infinity();
  draft.data.replace(0, 48, raw(infinite));
  error = error_of("a.glb", draft.bytes());
  EXPECT_NE(error.find("dropped 2 triangles with NaN or infinite vertices"), std::string::npos) << error;
}

TEST(GltfFile, DepthOfJsonIsLimited) {
  Draft draft;
  Json extras = 1;
  for (int i = 0; i < 40; ++i) extras = Json::array({extras});
  draft.document["extras"] = extras;
  EXPECT_EQ(load(draft).triangles(), 2u);
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  EXPECT_NE(error_of("a.gltf", R"({"asset":{"version":"2.0"},"extras":)" + deep + "}").find("nested deeper"),
            std::string::npos);
  // Brackets in strings are none.
  draft.document["extras"] = "\\\"" + std::string(100, '[');
  EXPECT_EQ(load(draft).triangles(), 2u);
}

// Ten times the nodes take about ten times the time; what is quadratic takes a hundred times.
TEST(GltfFile, ManyNodesAreReadInLinearTime) {
  const auto seconds = [](size_t count) {
    Draft draft;
    std::string nodes = draft.document["nodes"][0].dump();
    for (size_t i = 0; i < count; ++i) nodes += ",{}";
    draft.document["nodes"] = "NODES";
    std::string text = text_with(draft, "data:;base64," + base64(draft.data));
    text.replace(text.find("\"NODES\""), 7, "[" + nodes + "]");
    const Folder folder;
    const std::filesystem::path file = folder.write("many.gltf", text);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(load_scene(file).triangles(), 2u);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  double few = seconds(20000);
  for (int i = 0; i < 2; ++i) few = std::min(few, seconds(20000));
  EXPECT_LT(seconds(200000), 40 * few);
}

}  // namespace
}  // namespace gnomon
