// IndependentSet: the largest set of vertices of a bipartite graph of which no two are joined. By
// König's theorem it is the complement of a smallest vertex cover. The cover follows from a largest
// matching, which is found by augmenting along shortest paths, many of one length at a time (J.
// Hopcroft and R. Karp, SIAM J. Comput. 2, 1973).
#pragma once
#include <cstdint>
#include <vector>

namespace runstone::reference {

/// A graph with vertices on two sides. Edges join the two sides only.
struct BipartiteGraph {
  std::uint32_t right_count = 0;
  std::vector<std::uint32_t> first = {0};  // edges of left vertex l: from first[l] to first[l + 1]
  std::vector<std::uint32_t> edges;        // the right vertex of each

  std::uint32_t left_count() const { return static_cast<std::uint32_t>(first.size() - 1); }
  void clear() {
    right_count = 0;
    first.assign(1, 0);
    edges.clear();
  }
  /// Ends the edges of a left vertex. The next edges belong to the next vertex.
  void end_left() { first.push_back(static_cast<std::uint32_t>(edges.size())); }
};

/// Finds such sets. An object keeps its buffers between calls. Thread: one.
class IndependentSet {
 public:
  /// Finds the set of a graph. Cost: O(edges * sqrt(vertices)).
  void find(const BipartiteGraph& graph);

  /// Returns true if the set of the last graph has the vertex.
  bool has_left(std::uint32_t vertex) const { return distance_[vertex] != kFar; }
  bool has_right(std::uint32_t vertex) const { return reached_[vertex] == 0; }

 private:
  static constexpr std::uint32_t kFar = ~std::uint32_t{0};

  bool reach_free(const BipartiteGraph& graph);
  void augment(const BipartiteGraph& graph, std::uint32_t root);

  // A partner is an index on the other side, or kFar if there is none.
  std::vector<std::uint32_t> left_partner_, right_partner_;
  // The distance of each left vertex from an unmatched one, in pairs of edges.
  std::vector<std::uint32_t> distance_;
  // The right vertices that the same search reached.
  std::vector<std::uint8_t> reached_;
  std::vector<std::uint32_t> queue_, next_edge_, path_;
  // The distance of the left vertices before the nearest unmatched right ones.
  std::uint32_t shortest_ = kFar;
};

}  // namespace runstone::reference
