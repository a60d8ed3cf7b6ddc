// Orders a graph's nodes stably, each loop in one piece.
#include "engine/graph/graph_order.h"

#include <algorithm>
#include <functional>
#include <map>
#include <queue>

namespace gnomon {
namespace {

// Successors of a subset of the nodes; an item that is a whole loop is known by the loop's first node.
struct Level {
  std::vector<uint32_t> items;
  std::map<uint32_t, std::vector<uint32_t>> after;
};

using MinHeap = std::priority_queue<uint32_t, std::vector<uint32_t>, std::greater<>>;

std::map<uint32_t, uint32_t> indegrees(const Level& level) {
  std::map<uint32_t, uint32_t> degrees;
  for (const uint32_t item : level.items) degrees[item] = 0;
  for (const auto& [item, successors] : level.after)
    for (const uint32_t successor : successors) ++degrees[successor];
  return degrees;
}

// Among items that all wait for one another: walks backwards until an item comes again.
std::vector<uint32_t> find_cycle(const Level& level, const std::map<uint32_t, uint32_t>& waiting) {
  std::map<uint32_t, uint32_t> predecessor;
  for (const auto& [item, successors] : level.after)
    if (waiting.contains(item))
      for (const uint32_t successor : successors)
        if (waiting.contains(successor)) predecessor.emplace(successor, item);
  std::vector<uint32_t> path;
  uint32_t item = waiting.begin()->first;
  auto seen = path.end();
  while ((seen = std::find(path.begin(), path.end(), item)) == path.end()) {
    path.push_back(item);
    item = predecessor.at(item);
  }
  std::vector<uint32_t> cycle(seen, path.end());
  std::reverse(cycle.begin(), cycle.end());
  std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
  return cycle;
}

// Kahn's algorithm with a heap, so that ties go by index.
Order sort(const Level& level) {
  std::map<uint32_t, uint32_t> waiting = indegrees(level);
  MinHeap ready;
  for (const auto& [item, degree] : waiting)
    if (degree == 0) ready.push(item);
  Order order;
  while (!ready.empty()) {
    const uint32_t item = ready.top();
    ready.pop();
    waiting.erase(item);
    order.nodes.push_back(item);
    const auto successors = level.after.find(item);
    if (successors == level.after.end()) continue;
    for (const uint32_t successor : successors->second)
      if (--waiting.at(successor) == 0) ready.push(successor);
  }
  if (!waiting.empty()) order.cycle = find_cycle(level, waiting);
  return order;
}

}  // namespace

Order stable_order(const std::vector<int>& loop_of, const std::vector<OrderEdge>& edges) {
  Level outer;
  std::map<int, Level> bodies;
  std::vector<uint32_t> item_of(loop_of.size());
  for (uint32_t i = 0; i < loop_of.size(); ++i) {
    item_of[i] = i;
    if (loop_of[i] >= 0) {
      Level& body = bodies[loop_of[i]];
      body.items.push_back(i);
      item_of[i] = body.items.front();
    }
    if (item_of[i] == i) outer.items.push_back(i);
  }
  for (const auto& [before, after] : edges) {
    const bool same_body = loop_of[before] >= 0 && loop_of[before] == loop_of[after];
    if (same_body) {
      bodies[loop_of[before]].after[before].push_back(after);
    } else {
      outer.after[item_of[before]].push_back(item_of[after]);
    }
  }
  Order result;
  Order top = sort(outer);
  result.cycle = std::move(top.cycle);
  for (const uint32_t item : top.nodes) {
    if (loop_of[item] < 0) {
      result.nodes.push_back(item);
      continue;
    }
    Order body = sort(bodies.at(loop_of[item]));
    result.nodes.insert(result.nodes.end(), body.nodes.begin(), body.nodes.end());
    if (result.cycle.empty()) result.cycle = std::move(body.cycle);
  }
  return result;
}

}  // namespace gnomon
