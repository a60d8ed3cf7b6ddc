// Compressed geometry and textures: packed by the libraries' own encoders, read back to the same scene.
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <cmath>
#include <cstring>
#include <set>

#include "engine/scene/meshopt_stream.h"
#include "tests/engine/scene/gltf_packed.h"

namespace gnomon {
namespace {

using Json = nlohmann::json;
using test::draco_square;
using test::Draft;
using test::error_of;
using test::load;
using test::packed_square;
using test::packed_vertices;
using test::raw;
using test::square;
using test::square_indices;
using test::warns;

// Triangles as sets of corners: compression may turn and reorder them.
std::set<std::set<std::vector<float>>> shape(const Scene& scene) {
  std::set<std::set<std::vector<float>>> triangles;
  for (const Mesh& mesh : scene.meshes)
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      std::set<std::vector<float>> corners;
      for (size_t k = 0; k < 3; ++k) {
        const glm::vec3& p = mesh.positions[mesh.indices[i + k]];
        corners.insert({p.x, p.y, p.z});
      }
      triangles.insert(corners);
    }
  return triangles;
}

TEST(MeshoptCompression, ViewsAreUnpacked) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    for (const bool sequence : {false, true}) {
      const Scene scene = load(packed_square(name, sequence));
      EXPECT_EQ(shape(scene), shape(load(Draft{}))) << name;
      EXPECT_FALSE(warns(scene, "meshopt"));
    }
}

TEST(MeshoptCompression, FiltersAreApplied) {
  Draft draft = packed_square("EXT_meshopt_compression");
  std::vector<float> bits(12);
  meshopt_encodeFilterExp(bits.data(), 4, 12, 20, square.data());
  const std::string packed = packed_vertices(bits.data(), 4, 12);
  Json& extension = draft.document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
  extension["byteOffset"] = draft.data.size();
  extension["byteLength"] = packed.size();
  extension["filter"] = "EXPONENTIAL";
  draft.data += packed;
  draft.document["buffers"][0]["byteLength"] = draft.data.size();
  EXPECT_EQ(shape(load(draft)), shape(load(Draft{})));
  extension["filter"] = "OCTAHEDRAL";
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("filter 'OCTAHEDRAL' with elements of 12 bytes"),
            std::string::npos);
}

TEST(MeshoptCompression, BrokenStreamsNameTheExtensionOrFallBack) {
  Draft draft = packed_square("KHR_meshopt_compression");
  draft.data[0] = 0;
  const std::string error = error_of("a.glb", draft.bytes());
  EXPECT_NE(error.find("/bufferViews/0: KHR_meshopt_compression: the stream is broken"), std::string::npos)
      << error;
  draft = packed_square("KHR_meshopt_compression");
  Json& extension = draft.document["bufferViews"][0]["extensions"]["KHR_meshopt_compression"];
  extension["count"] = 5;
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("count times byteStride"), std::string::npos);
  extension["count"] = 4;
  extension["byteLength"] = 1 << 20;
  EXPECT_NE(error_of("a.glb", draft.bytes()).find("not inside buffer 0"), std::string::npos);

  // With an uncompressed fallback it is read.
  Draft whole = packed_square("KHR_meshopt_compression");
  whole.data[0] = 0;
  const size_t begin = whole.data.size();
  whole.data += raw(square) + raw(square_indices);
  for (size_t i = 0; i < 2; ++i) {
    whole.document["bufferViews"][i]["buffer"] = 0;
    whole.document["bufferViews"][i]["byteOffset"] = begin + 48 * i;
  }
  whole.document["buffers"] = {{{"byteLength", whole.data.size()}}};
  whole.document.erase("extensionsRequired");
  const Scene scene = load(whole);
  EXPECT_EQ(shape(scene), shape(load(Draft{})));
  EXPECT_TRUE(warns(scene, "the uncompressed fallback is read"));
}

// 20 elements of three channels, with deltas of bytes, of words, and of bits turned by five; made by the
// meshoptimizer 1.0 encoder.
TEST(MeshoptStream, VersionOneOfAttributes) {
  const std::vector<unsigned char> stream = {
      161, 86,  119, 104, 5,   42,  186, 174, 171, 7,   7,   7,   170, 0,   0,   0,   2,   4,   69,  69,
      68,  84,  84,  69,  69,  15,  0,   4,   4,   5,   4,   2,   6,   54,  51,  99,  99,  54,  54,  51,
      15,  0,   6,   3,   6,   3,   0,   208, 208, 208, 208, 208, 208, 208, 208, 208, 208, 208, 208, 208,
      208, 208, 208, 208, 208, 208, 2,   7,   119, 119, 119, 119, 119, 119, 119, 15,  0,   7,   7,   7,
      7,   0,   87,  87,  87,  87,  87,  87,  87,  87,  87,  87,  87,  87,  87,  87,  87,  87,  87,  87,
      87,  5,   42,  170, 170, 170, 170, 0,   0,   0,   1,   4,   0,   15,  2,   8,   244, 196, 242, 98,
      226, 98,  241, 248, 28,  62,  15,  0,   3,   1,   7,   1,   0,   0,   0,   0,   0,   0,   0,   0,
      0,   0,   50,  100, 150, 0,   0,   232, 253, 0,   0,   128, 63,  0,   1,   82};
  std::vector<unsigned char> out(20 * 12);
  ASSERT_TRUE(decode_attributes_v1(out, 20, 12, stream));
  for (uint32_t i = 0; i < 20; ++i) {
    for (uint32_t k = 0; k < 4; ++k) EXPECT_EQ(out[12 * i + k], k * 50 + i * k % 5);
    uint16_t words[2];
    std::memcpy(words, &out[12 * i + 4], 4);
    EXPECT_EQ(words[0], 1000 * i);
    EXPECT_EQ(words[1], 65000 - 300 * i);
    float value = 0;
    std::memcpy(&value, &out[12 * i + 8], 4);
    EXPECT_EQ(value, 1 + 0.5f * float(i));
  }
  for (size_t length = 0; length < stream.size(); ++length)
    EXPECT_FALSE(decode_attributes_v1(out, 20, 12, std::span(stream).first(length))) << length;
  std::vector<unsigned char> longer = stream;
  longer.insert(longer.begin() + 100, 0);
  EXPECT_FALSE(decode_attributes_v1(out, 20, 12, longer));
}

TEST(MeshoptStream, ColourFilter) {
  std::vector<unsigned char> colors = {144, 95, 241, 255, 127, 0, 127, 192, 102, 205, 0, 230};
  decode_color_filter(colors, 4);
  // (1, 1/2, 1/4, 1), (0, 1, 0, 1/2) and (0.2, 0.4, 0.6, 0.8), to the eight bits that the encoder kept.
  const int expected[] = {255, 128, 64, 255, 0, 255, 0, 128, 51, 102, 153, 204};
  for (size_t i = 0; i < colors.size(); ++i) EXPECT_NEAR(colors[i], expected[i], 2) << i;
}

TEST(DracoCompression, PrimitivesAreUnpacked) {
  const Scene scene = load(draco_square());
  EXPECT_EQ(shape(scene), shape(load(Draft{})));
  EXPECT_EQ(scene.meshes[0].normals[0], glm::vec3(0, 0, 1));
  EXPECT_FALSE(warns(scene, "draco"));
}

TEST(DracoCompression, BrokenStreamsNameTheExtensionOrFallBack) {
  Draft draft = draco_square();
  draft.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 0;
  const std::string error = error_of("a.glb", draft.bytes());
  EXPECT_NE(error.find("/meshes/0/primitives/0: KHR_draco_mesh_compression"), std::string::npos) << error;
  draft.document["accessors"][0]["bufferView"] = 0;
  draft.document["accessors"][1]["bufferView"] = 1;
  const Scene scene = load(draft);
  EXPECT_EQ(shape(scene), shape(load(Draft{})));
  EXPECT_TRUE(warns(scene, "the uncompressed fallback is read"));
}

TEST(WebpTextures, AreDecoded) {
  const std::vector<uint8_t> texels = {255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 128, 9, 8, 7, 255};
  uint8_t* encoded = nullptr;
  const size_t size = WebPEncodeLosslessRGBA(texels.data(), 2, 2, 8, &encoded);
  ASSERT_GT(size, 0u);
  const std::string bytes(reinterpret_cast<const char*>(encoded), size);
  WebPFree(encoded);
  Draft draft;
  draft.document["images"] = {{{"bufferView", draft.add_view(bytes)}, {"mimeType", "image/webp"}}};
  draft.document["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
  draft.document["materials"] = Json::array(
      {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  draft.primitive()["material"] = 0;
  draft.document["extensionsRequired"] = {"EXT_texture_webp"};
  const Scene scene = load(draft);
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].width, 2u);
  for (size_t i = 0; i < 4; ++i) {  // colours of transparent texels are not kept
    EXPECT_EQ(scene.textures[0].rgba[4 * i + 3], texels[4 * i + 3]) << i;
    if (texels[4 * i + 3] > 0) {
      EXPECT_EQ(scene.textures[0].rgba[4 * i + 2], texels[4 * i + 2]) << i;
    }
  }
  draft.document["bufferViews"].back()["byteLength"] = size - 8;
  EXPECT_TRUE(warns(load(draft), "cannot be read"));
}

}  // namespace
}  // namespace gnomon
