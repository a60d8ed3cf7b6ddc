// The penumbra that distances are found for is the one that is made of them.
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/graph/graph_resolve.h"

namespace gnomon {
namespace {

Params params_of(const Graph& graph, const std::string& id) {
  Problems problems;
  const ResolvedGraph resolved = resolve_graph(graph, {}, problems);
  problems.raise();
  return resolved.nodes[resolved.index.at(id)].declaration.params();
}

TEST(PenumbraTraits, ComeWithTheDistances) {
  for (const char* name : {"edtsm", "edtsm_bilateral"}) {
    const Graph graph =
        load_graph(find_graph(name), {{"penumbra", 0.5}, {"pixels", 20.0}, {"depth_tolerance", 0.002}});
    const Params edt = params_of(graph, "edt"), soft = params_of(graph, "soft");
    EXPECT_EQ(soft.number("penumbra"), 0.5) << name;
    for (const char* key : {"penumbra", "penumbra_relative", "pixels", "depth_tolerance"})
      EXPECT_EQ(soft.number(key), edt.number(key)) << name << " " << key;
  }
}

TEST(PenumbraTraits, AScreenPenumbraNeedsItsWidth) {
  try {
    load_graph(find_graph("edtsm"), {{"metric", std::string("screen")}, {"pixels", 0.0}});
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("'soft' (distance_penumbra) cannot read 'nearest' of 'edt' (distance_transform)"),
              std::string::npos)
        << what;
    EXPECT_NE(what.find("without a width in pixels"), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace gnomon
