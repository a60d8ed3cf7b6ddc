// The quad-tree that adaptive sampling refines an area light by.
#include "passes/area/light_quads.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/error.h"
#include "engine/scene/scene.h"

namespace gnomon {
namespace {

constexpr std::array<glm::uvec2, 4> kCorners = {glm::uvec2{0, 0}, {1, 0}, {0, 1}, {1, 1}};
constexpr uint32_t kOffLight = ~0u;

glm::dvec2 place_of(const glm::uvec2& point, uint32_t level) {
  return glm::dvec2(point) / double(1u << level);
}

}  // namespace

LightSurface whole_rectangle() {
  return {[](glm::dvec2) { return true; },
          [](glm::dvec2 min, glm::dvec2 max) { return (max.x - min.x) * (max.y - min.y); }};
}

LightQuads::LightQuads(uint32_t levels, QuadOrder order, LightSurface surface)
    : levels_(levels), order_(order), surface_(std::move(surface)) {
  const size_t side = (size_t{1} << levels) + 1;
  index_.assign(side * side, 0);
  waiting_.push_back({});
  next();
}

uint32_t LightQuads::sample_at(glm::uvec2 point, uint32_t level) {
  const glm::dvec2 place = place_of(point, level);
  if (!surface_.holds(place)) return kOffLight;
  const glm::uvec2 fine = point << (levels_ - level);
  uint32_t& known = index_[size_t{fine.y} * ((size_t{1} << levels_) + 1) + fine.x];
  if (known == 0) {
    places_.push_back(place);
    created_.push_back(level);
    known = uint32_t(places_.size());
  }
  return known - 1;
}

// Finds or makes the samples at a quad's corners. Returns how many of them are on the light.
uint32_t LightQuads::corners(Quad& quad) {
  uint32_t some = kOffLight, on = 0;
  for (size_t i = 0; i < 4; ++i) {
    quad.samples[i] = sample_at(quad.corner + kCorners[i], quad.level);
    if (quad.samples[i] == kOffLight) continue;
    some = quad.samples[i];
    quad.on[i] = true;
    ++on;
  }
  for (uint32_t& sample : quad.samples)
    if (sample == kOffLight) sample = some;
  return on;
}

bool LightQuads::touches_light(const Quad& quad) const {
  return surface_.power(place_of(quad.corner, quad.level), place_of(quad.corner + 1u, quad.level)) > 0;
}

void LightQuads::children(const Quad& quad, std::vector<Quad>& into) const {
  for (const glm::uvec2& corner : kCorners)
    into.push_back({quad.level + 1, 2u * quad.corner + corner, {}, {}});
}

// A quad without a corner on the light cannot be asked about: it is divided as long as it holds a part of the
// light. So is a large one of which one or two corners are: their answers say little about the rest.
void LightQuads::open(const Quad& asked) {
  constexpr uint32_t kAskedFrom = 2;  // level
  constexpr uint32_t kEnough = 3;     // corners
  if (!touches_light(asked)) return;
  Quad quad = asked;
  const uint32_t sampled = corners(quad);
  if (quad.level == levels_) {
    if (sampled > 0) leaves_.push_back(quad);
  } else if (sampled >= kEnough || (sampled > 0 && quad.level >= kAskedFrom)) {
    questions_.push_back(quad);
  } else {
    std::vector<Quad> parts;
    children(quad, parts);
    for (const Quad& part : parts) open(part);
  }
}

// Opens what waits: all of it, or, depth-first, until there is a question.
void LightQuads::next() {
  first_new_ = uint32_t(places_.size());
  questions_.clear();
  if (order_ == QuadOrder::breadth_first) {
    const std::vector<Quad> level = std::move(waiting_);
    waiting_.clear();
    for (const Quad& quad : level) open(quad);
    return;
  }
  while (questions_.empty() && !waiting_.empty()) {
    const Quad quad = waiting_.back();
    waiting_.pop_back();
    open(quad);
  }
}

void LightQuads::answer(const std::vector<bool>& divide) {
  std::vector<Quad> parts;
  for (size_t i = 0; i < questions_.size(); ++i) {
    if (i < divide.size() && divide[i])
      children(questions_[i], parts);
    else
      leaves_.push_back(questions_[i]);
  }
  if (order_ == QuadOrder::depth_first) std::reverse(parts.begin(), parts.end());
  waiting_.insert(waiting_.end(), parts.begin(), parts.end());
  next();
}

std::vector<double> LightQuads::weights(SampleWeights kind) const {
  std::vector<double> weights(places_.size(), 0.0);
  std::vector<uint32_t> finest(places_.size(), 0);
  for (const Quad& leaf : leaves_) {
    const double power =
        surface_.power(place_of(leaf.corner, leaf.level), place_of(leaf.corner + 1u, leaf.level));
    const auto corners = double(std::count(leaf.on.begin(), leaf.on.end(), true));
    for (size_t i = 0; i < 4; ++i) {
      if (!leaf.on[i]) continue;
      weights[leaf.samples[i]] += power / corners;
      finest[leaf.samples[i]] = std::max(finest[leaf.samples[i]], leaf.level);
    }
  }
  if (kind != SampleWeights::area)
    for (size_t i = 0; i < weights.size(); ++i) {
      const double points = std::exp2(kind == SampleWeights::leaf ? finest[i] : created_[i]) + 1;
      weights[i] = 1 / (points * points);  // (6.5)
    }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight = sum > 0 ? weight / sum : 1.0 / double(weights.size());
  return weights;
}

uint32_t LightQuads::deepest_level() const {
  uint32_t deepest = 0;
  for (const Quad& leaf : leaves_) deepest = std::max(deepest, leaf.level);
  return deepest;
}

std::vector<bool> any_passed(std::span<const uint32_t> results) {
  std::vector<bool> passed;
  for (size_t i = 0; i + 1 < results.size(); i += 2) {
    if (results[i + 1] == 0) fail("the device did not answer an occlusion query");
    passed.push_back(results[i] != 0);
  }
  return passed;
}

}  // namespace gnomon
