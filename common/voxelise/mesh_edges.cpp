#include "common/voxelise/mesh_edges.hpp"

#include <algorithm>
#include <bit>
#include <random>
#include <utility>

#include "common/core/hash.hpp"

namespace runstone {
namespace {

/// The edges that are held at once: 64 MiB. Those of one vertex are held in any case.
constexpr std::size_t kEdgesAtOnce = std::size_t{1} << 24;

/// Returns a number that no author of a file can know. The results do not depend on it.
std::uint64_t secret_number() {
  static const std::uint64_t number = [] {
    std::random_device device;
    return std::uint64_t{device()} << 32 | device();
  }();
  return number;
}

/// Returns for each vertex the first one with the same snapped position. Open addressing; the places are
/// not those that a file could choose to make all of them collide.
std::vector<std::uint32_t> joined_vertices(const Model& model, const ModelPlacement& placement) {
  std::vector<std::uint32_t> out(model.positions.size());
  const std::size_t places = std::bit_ceil(model.positions.size() + model.positions.size() / 2 + 1);
  std::vector<std::uint32_t> table(places, UINT32_MAX);
  // Vertices that no triangle has may lie outside the box, and are not snapped.
  std::vector<bool> is_used(model.positions.size());
  for (const auto& triangle : model.triangles) {
    for (const std::uint32_t vertex : triangle) is_used[vertex] = true;
  }
  const std::uint64_t secret = secret_number();
  for (std::uint32_t vertex = 0; vertex < out.size(); ++vertex) {
    out[vertex] = vertex;
    if (!is_used[vertex]) continue;
    const UnitPoint at = placement.at(model.positions[vertex]);
    const std::uint64_t packed = static_cast<std::uint64_t>(at[0]) << 42 |
                                 static_cast<std::uint64_t>(at[1]) << 21 |
                                 static_cast<std::uint64_t>(at[2]);
    for (std::size_t place = mix64(packed ^ secret) & (places - 1);;
         place = (place + 1) & (places - 1)) {
      if (table[place] == UINT32_MAX) {
        table[place] = vertex;
        break;
      }
      if (placement.at(model.positions[table[place]]) == at) {
        out[vertex] = table[place];
        break;
      }
    }
  }
  return out;
}

/// Counts the edges between joined vertices.
class EdgeCount {
 public:
  EdgeCount(const Model& model, const ModelPlacement& placement)
      : model_(model), placement_(placement), joined_(joined_vertices(model, placement)) {}

  Result<MeshEdges> count() {
    begins_.assign(model_.positions.size() + 1, 0);
    for_each_edge([&](std::uint32_t low, std::uint32_t, std::uint32_t) { ++begins_[low + 1]; });
    MeshEdges out;
    out.closure = MeshClosure::closed;
    for (std::uint32_t first = 0; first < model_.positions.size();) {
      std::size_t held = 0;
      std::uint32_t last = first;
      while (last < model_.positions.size() &&
             (last == first || held + begins_[last + 1] <= kEdgesAtOnce))
        held += begins_[++last];
      if (held != 0) {
        if (auto counted = count_range(first, last, held, out); !counted)
          return failure(counted.error());
      }
      first = last;
    }
    return out;
  }

 private:
  /// Calls f(lower vertex, higher vertex, 1 if the edge runs from the higher one, otherwise 0).
  template <class F>
  void for_each_edge(F&& f) const {
    for (const auto& triangle : model_.triangles) {
      const std::array<std::uint32_t, 3> v{joined_[triangle[0]], joined_[triangle[1]],
                                           joined_[triangle[2]]};
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = v[i], to = v[(i + 1) % 3];
        if (from < to) {
          f(from, to, 0U);
        } else {
          f(to, from, 1U);
        }
      }
    }
  }

  /// Counts the edges whose lower vertex is in [first, last).
  Result<void> count_range(std::uint32_t first, std::uint32_t last, std::size_t held,
                           MeshEdges& out) {
    static_assert(kModelVerticesMax < std::size_t{1} << 31);
    std::vector<std::uint32_t> ends(held);  // the higher vertex and the direction
    std::vector<std::uint32_t> next(std::size_t{last} - first + 1);
    for (std::uint32_t v = first; v < last; ++v)
      next[v - first + 1] = next[v - first] + begins_[v + 1];
    for_each_edge([&](std::uint32_t low, std::uint32_t high, std::uint32_t backward) {
      if (low >= first && low < last) ends[next[low - first]++] = high << 1 | backward;
    });
    // next[i] is the end of vertex i now.
    std::size_t begin = 0;
    for (std::uint32_t v = first; v < last; ++v) {
      const std::size_t end = next[v - first];
      std::sort(ends.begin() + static_cast<std::ptrdiff_t>(begin),
                ends.begin() + static_cast<std::ptrdiff_t>(end));
      while (begin < end) {
        const std::uint32_t high = ends[begin] >> 1;
        std::int32_t forward = 0, backward = 0;
        for (; begin < end && ends[begin] >> 1 == high; ++begin)
          ++((ends[begin] & 1) != 0 ? backward : forward);
        if (forward == 1 && backward == 1) continue;
        if (forward + backward != 2) {
          out.closure = MeshClosure::open;
        } else if (out.closure == MeshClosure::closed) {
          out.closure = MeshClosure::inverted;
        }
        if (forward == backward) continue;
        if (out.open.size() == kOpenEdgesMax)
          return fail(ErrorCode::limit_exceeded,
                      "the mesh has more than 1,000,000 open edges: voxelise its surface only");
        out.open.push_back({placement_.at(model_.positions[v]),
                            placement_.at(model_.positions[high]), forward - backward});
      }
    }
    return {};
  }

  const Model& model_;
  const ModelPlacement& placement_;
  const std::vector<std::uint32_t> joined_;
  std::vector<std::uint32_t> begins_;  // [v + 1]: the edges whose lower vertex is v
};

}  // namespace

Result<MeshEdges> mesh_edges(const Model& model, const ModelPlacement& placement) {
  return EdgeCount(model, placement).count();
}

}  // namespace runstone
