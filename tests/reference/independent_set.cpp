#include "tests/reference/independent_set.hpp"

#include <algorithm>
#include <utility>

namespace runstone::reference {

void IndependentSet::find(const BipartiteGraph& graph) {
  left_partner_.assign(graph.left_count(), kFar);
  right_partner_.assign(graph.right_count, kFar);
  // The last search reaches no unmatched vertex on the right. The vertices that it reached decide:
  // the smallest cover is the left vertices that it did not reach and the right ones that it
  // reached (König).
  while (reach_free(graph)) {
    next_edge_.assign(graph.first.begin(), graph.first.end() - 1);
    for (std::uint32_t left = 0; left < graph.left_count(); ++left) {
      if (left_partner_[left] == kFar) augment(graph, left);
    }
  }
}

/// Searches breadth first from all unmatched left vertices, along edges to the right and along
/// partners back to the left, down to the first unmatched right vertices. Returns true if there are
/// any.
bool IndependentSet::reach_free(const BipartiteGraph& graph) {
  distance_.assign(graph.left_count(), kFar);
  reached_.assign(graph.right_count, 0);
  queue_.clear();
  shortest_ = kFar;
  for (std::uint32_t left = 0; left < graph.left_count(); ++left) {
    if (left_partner_[left] != kFar) continue;
    distance_[left] = 0;
    queue_.push_back(left);
  }
  for (std::size_t i = 0; i < queue_.size() && distance_[queue_[i]] < shortest_; ++i) {
    const std::uint32_t left = queue_[i];
    for (std::uint32_t e = graph.first[left]; e < graph.first[left + 1]; ++e) {
      const std::uint32_t right = graph.edges[e];
      if (std::exchange(reached_[right], std::uint8_t{1}) != 0) continue;
      const std::uint32_t beyond = right_partner_[right];
      if (beyond == kFar) {
        shortest_ = distance_[left] + 1;
      } else {
        distance_[beyond] = distance_[left] + 1;
        queue_.push_back(beyond);
      }
    }
  }
  return shortest_ != kFar;
}

/// Matches an unmatched left vertex if a shortest path from it to an unmatched right one exists. It
/// exchanges the edges of that path that are in the matching and those that are not. Depth first,
/// each edge once a phase.
void IndependentSet::augment(const BipartiteGraph& graph, std::uint32_t root) {
  path_.assign(1, root);
  while (!path_.empty()) {
    const std::uint32_t left = path_.back();
    if (next_edge_[left] == graph.first[left + 1]) {
      path_.pop_back();
      continue;
    }
    std::uint32_t right = graph.edges[next_edge_[left]++];
    const std::uint32_t beyond = right_partner_[right];
    if (beyond != kFar) {
      const bool nearer = distance_[beyond] == distance_[left] + 1 && distance_[beyond] < shortest_;
      if (nearer) path_.push_back(beyond);
      continue;
    }
    for (; !path_.empty(); path_.pop_back()) {
      right_partner_[right] = path_.back();
      std::swap(left_partner_[path_.back()], right);
    }
  }
}

}  // namespace runstone::reference
