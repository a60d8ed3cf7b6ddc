// Stable topological order of a graph whose loops stay in one piece.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

struct OrderEdge {
  uint32_t before = 0, after = 0;  // node indices
};

struct Order {
  std::vector<uint32_t> nodes;  // all of them, or fewer when there is a cycle
  std::vector<uint32_t> cycle;  // nodes on one cycle, in edge order; empty when there is none
};

// `loop_of[i]`: the loop that node i belongs to, or -1; a loop's nodes are contiguous. Among nodes that may
// run next, the one with the lowest index does. An edge between a loop's node and one outside it concerns the
// whole loop. O(n log n + edges).
Order stable_order(const std::vector<int>& loop_of, const std::vector<OrderEdge>& edges);

}  // namespace gnomon
