#include "tests/reference/independent_set.hpp"

#include <catch2/catch.hpp>
#include <utility>

namespace runstone::test {
namespace {

using namespace reference;

/// Returns the set of a graph, as left and right members, from the right vertices of each left one.
std::pair<std::vector<bool>, std::vector<bool>> set_of(
    const std::vector<std::vector<std::uint32_t>>& edges, std::uint32_t right_count) {
  static IndependentSet set;  // the remains of one graph would show in the next
  BipartiteGraph graph;
  graph.right_count = right_count;
  for (const auto& of : edges) {
    graph.edges.insert(graph.edges.end(), of.begin(), of.end());
    graph.end_left();
  }
  set.find(graph);
  std::pair<std::vector<bool>, std::vector<bool>> out;
  for (std::uint32_t left = 0; left < edges.size(); ++left) out.first.push_back(set.has_left(left));
  for (std::uint32_t right = 0; right < right_count; ++right)
    out.second.push_back(set.has_right(right));
  return out;
}

using Members = std::vector<bool>;

TEST_CASE("independent set: all vertices where there are no edges", "[mesh][reference]") {
  CHECK(set_of({}, 0) == std::pair{Members{}, Members{}});
  CHECK(set_of({{}, {}}, 3) == std::pair{Members{true, true}, Members{true, true, true}});
}

TEST_CASE("independent set: the larger side of a star", "[mesh][reference]") {
  CHECK(set_of({{0, 1, 2}}, 3) == std::pair{Members{false}, Members{true, true, true}});
  CHECK(set_of({{0}, {0}, {0}}, 1) == std::pair{Members{true, true, true}, Members{false}});
}

TEST_CASE("independent set: a path that has to be augmented twice", "[mesh][reference]") {
  // left 0 - right 0 - left 1 - right 1 - left 2: three of five.
  CHECK(set_of({{0}, {0, 1}, {1}}, 2) ==
        std::pair{Members{true, true, true}, Members{false, false}});
}

}  // namespace
}  // namespace runstone::test
