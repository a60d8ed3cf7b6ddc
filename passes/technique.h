// What a technique is, asked of its graph: what its passes say of what they make.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/pass.h"

namespace gnomon {

struct Graph;  // engine/graph/graph.h

// What the shadows of a visibility are.
enum class ShadowKind {
  hard,      // of a light without size
  filtered,  // softened by a width that is not the light's
  soft       // of the light's own size: penumbrae as wide as they are
};

// Of a pass that gives out visibility; an output that is modified in place keeps its kind.
void makes_shadows(Declaration& d, const std::string& output, ShadowKind kind);

// Of a graph's visibility; hard where no pass says so.
ShadowKind shadow_kind(const Graph& graph);

// Of a pass that draws maps of depth: they are as wide as the integer parameter `side` says.
void draws_maps(Declaration& d, const std::string& port, const std::string& side);

// Texels: the side of a graph's widest map of a light's depth; nothing where it draws none.
std::optional<uint32_t> map_side(const Graph& graph);
// The variables that set it.
std::vector<std::string> map_side_variables(const Graph& graph);

}  // namespace gnomon
