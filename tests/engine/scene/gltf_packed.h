// The square of a draft, compressed.
#pragma once

#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/engine/scene/gltf_draft.h"

namespace gnomon::test {

inline std::string text(const std::vector<unsigned char>& bytes) { return {bytes.begin(), bytes.end()}; }

inline std::string packed_vertices(const void* values, size_t count, size_t stride) {
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values, count, stride));
  return text(out);
}

// Views 0 and 1 of the draft are packed by `name`; they refer to a buffer without data.
// `vertices`: packed; empty: those of the square.
inline Draft packed_square(const char* name, bool sequence = false, const std::string& vertices = {}) {
  Draft draft;
  const std::vector<uint32_t> indices(square_indices.begin(), square_indices.end());
  std::vector<unsigned char> out(
      std::max(meshopt_encodeIndexBufferBound(6, 4), meshopt_encodeIndexSequenceBound(6, 4)));
  out.resize(sequence ? meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), 6)
                      : meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), 6));
  const std::string packed[] = {vertices.empty() ? packed_vertices(square.data(), 4, 12) : vertices,
                                text(out)};
  draft.data.clear();
  for (size_t i = 0; i < 2; ++i) {
    nlohmann::json& view = draft.document["bufferViews"][i];
    view["buffer"] = 1;
    view["extensions"][name] = {{"buffer", 0},
                                {"byteOffset", draft.data.size()},
                                {"byteLength", packed[i].size()},
                                {"byteStride", i == 0 ? 12 : 2},
                                {"count", i == 0 ? 4 : 6},
                                {"mode", i == 0     ? "ATTRIBUTES"
                                         : sequence ? "INDICES"
                                                    : "TRIANGLES"}};
    draft.data += packed[i];
  }
  draft.document["buffers"] = {{{"byteLength", draft.data.size()}},
                               {{"byteLength", 60}, {"extensions", {{name, {{"fallback", true}}}}}}};
  draft.document["extensionsRequired"] = {name};
  return draft;
}

inline std::string packed_draco() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const auto corner = [](size_t i) { return &square[3 * square_indices[i]]; };
  for (uint32_t f = 0; f < 2; ++f)
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), corner(3 * f), corner(3 * f + 1),
                                      corner(3 * f + 2));
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::ExpertEncoder encoder(*mesh);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) throw std::runtime_error("Draco packs no square");
  return {buffer.data(), buffer.size()};
}

inline Draft draco_square() {
  Draft draft;
  const size_t view = draft.add_view(packed_draco());
  draft.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                                   {"attributes", {{"POSITION", 0}}}};
  draft.document["accessors"][0].erase("bufferView");
  draft.document["accessors"][1].erase("bufferView");
  draft.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return draft;
}

}  // namespace gnomon::test
