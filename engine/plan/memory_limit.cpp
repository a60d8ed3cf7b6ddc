// Adds up what a plan takes and compares it with the limit.
#include "engine/plan/memory_limit.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

constexpr uint64_t kMegabyte = uint64_t{1} << 20,
                   kGigabyte = uint64_t{1} << 30;  // as the command line has them

std::string shown_size(uint64_t bytes) {
  return bytes < kGigabyte ? fmt::format("{:.3g} MB", double(bytes) / double(kMegabyte))
                           : fmt::format("{:.3g} GB", double(bytes) / double(kGigabyte));
}

uint64_t copies(const Resource& resource) { return resource.history ? 2 : 1; }

uint64_t taken(const Resource& resource) {
  return copies(resource) * (in_heap(resource) ? resource.size : bytes_of(resource));
}

uint64_t sum(uint64_t a, uint64_t b) { return a > UINT64_MAX - b ? UINT64_MAX : a + b; }

// The largest first, and how much the others are.
std::string largest(const Plan& plan) {
  constexpr size_t told = 5;
  std::vector<const Resource*> all;
  for (const Resource& resource : plan.resources) all.push_back(&resource);
  std::stable_sort(all.begin(), all.end(),
                   [](const Resource* a, const Resource* b) { return taken(*a) > taken(*b); });
  std::string text;
  for (size_t i = 0; i < std::min(told, all.size()); ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", all[i]->name, shown_size(taken(*all[i])));
  uint64_t rest = 0;
  for (size_t i = told; i < all.size(); ++i) rest = sum(rest, taken(*all[i]));
  if (rest > 0) text += fmt::format(", {} more {}", all.size() - told, shown_size(rest));
  return text;
}

}  // namespace

uint64_t memory_of(const Plan& plan) {
  uint64_t bytes = plan.heap_bytes;
  for (const Resource& resource : plan.resources)
    if (!in_heap(resource)) bytes = sum(bytes, taken(resource));
  return bytes;
}

void check_memory(const Plan& plan, const Graph& graph, const Declaration::Setting& setting,
                  const SceneFacts& facts, const CompileOptions& options) {
  if (memory_of(plan) <= setting.memory) return;
  Declaration::Setting thrifty = setting;
  thrifty.memory = 1;
  const Plan least = compile(graph, thrifty, facts, options);
  const uint64_t bytes = memory_of(least);
  if (bytes <= setting.memory) return;
  fail(fmt::format("it needs {} of memory, and {} are allowed: {}", shown_size(bytes),
                   shown_size(setting.memory), largest(least)),
       graph.file.empty() ? graph.name : graph.file.string(), {},
       fmt::format("smaller maps or a smaller --size take less; --memory {}GB allows it",
                   (bytes - 1) / kGigabyte + 1));
}

}  // namespace gnomon
