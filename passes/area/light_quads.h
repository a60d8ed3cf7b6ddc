// The quad-tree that adaptive sampling refines an area light by. Device-free.
// Schwaerzler et al. 2012; Macedo 2018, ch. 6.1.1 and algorithm 6.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace gnomon {

// What the tree has to know of its light. Places are in [0, 1]^2 over the light's bounding rectangle.
struct LightSurface {
  std::function<bool(glm::dvec2)> holds;  // is a place on the light?
  std::function<double(glm::dvec2 min, glm::dvec2 max)>
      power;  // emission of a part: its area on the light, weighted
};
LightSurface whole_rectangle();

enum class QuadOrder {
  breadth_first,  // a level's quads together
  depth_first     // a quad at a time, its children before its neighbours
};

enum class SampleWeights {
  area,     // each leaf gives its corners equal parts of its power: the trapezoid rule
  leaf,     // (6.5) with the level of the finest leaf that touches the sample
  creation  // (6.5) with the level that a sample was made at
};

class LightQuads {
 public:
  struct Quad {
    uint32_t level = 0;
    glm::uvec2 corner{0};  // lower corner, on a grid of 2^level cells a side
    std::array<uint32_t, 4>
        samples{};  // at its corners (0,0) (1,0) (0,1) (1,1); where one is off the light, another's
    std::array<bool, 4> on{};  // is the corner on the light?
  };

  // `levels`: how often a quad may be divided, 0..5: at most (2^levels + 1)^2 samples.
  LightQuads(uint32_t levels, QuadOrder order, LightSurface surface = whole_rectangle());

  // Places of all samples so far; those from first_new() on are to be rendered for the questions.
  const std::vector<glm::dvec2>& samples() const { return places_; }
  uint32_t first_new() const { return first_new_; }
  // Quads of which it is to be found out whether they must be divided. Empty: the tree is complete.
  std::span<const Quad> questions() const { return questions_; }
  // One answer a question: does the quad have to be divided? Leads to the next questions and samples.
  void answer(const std::vector<bool>& divide);

  std::vector<double> weights(SampleWeights kind) const;  // one a sample, their sum is 1
  const std::vector<Quad>& leaves() const { return leaves_; }
  uint32_t deepest_level() const;  // of any leaf

 private:
  void open(const Quad& quad);
  void children(const Quad& quad, std::vector<Quad>& into) const;
  bool touches_light(const Quad& quad) const;
  uint32_t corners(Quad& quad);
  uint32_t sample_at(glm::uvec2 point, uint32_t level);
  void next();

  uint32_t levels_;
  QuadOrder order_;
  LightSurface surface_;
  std::vector<glm::dvec2> places_;
  std::vector<uint32_t> created_;  // level, of each sample
  std::vector<uint32_t> index_;    // of a point of the finest grid: its sample + 1
  std::vector<Quad> waiting_;      // to be opened; depth-first: the last one is next
  std::vector<Quad> questions_, leaves_;
  uint32_t first_new_ = 0;
};

// What occlusion queries say, two words each: samples that passed, and whether there is an answer. Error when
// there is none: refining on would be guessing.
std::vector<bool> any_passed(std::span<const uint32_t> results);

}  // namespace gnomon
