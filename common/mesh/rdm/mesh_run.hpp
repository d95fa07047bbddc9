// MeshRun: a run with the one fact of its material that culling needs, and the rule for two that touch.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::rdm {

/// Covers [end of the run before it, end) of a flattened chunk or layer.
struct MeshRun {
  std::uint32_t end = 0;
  Material material = kEmpty;
  Visibility visibility = Visibility::empty;
};
static_assert(sizeof(MeshRun) == 8);

/// Which of two touching voxels shows its face: bit 0 the one in `a`, bit 1 the one in `b`.
/// The same rule as VisibilityTable::face_drawn, both ways in one look-up.
inline unsigned faces_between(const MeshRun& a, const MeshRun& b) {
  constexpr auto kFaces = [] {
    std::uint32_t bits = 0;
    for (unsigned va = 0; va < 3; ++va) {
      for (unsigned vb = 0; vb < 3; ++vb) {
        const auto shows = [](unsigned of, unsigned towards) {
          return static_cast<Visibility>(of) != Visibility::empty &&
                 static_cast<Visibility>(towards) != Visibility::opaque;
        };
        const unsigned faces = (shows(va, vb) ? 1u : 0u) | (shows(vb, va) ? 2u : 0u);
        bits |= faces << (2 * (va * 4 + vb));
      }
    }
    return bits;
  }();
  if (a.material == b.material) return 0;
  return (kFaces >> (2 * (static_cast<unsigned>(a.visibility) * 4 + static_cast<unsigned>(b.visibility)))) &
         3u;
}

/// Replaces `out` by all runs of a chunk. O(runs).
void chunk_runs(const RunChunk& chunk, const VisibilityTable& visibility, std::vector<MeshRun>& out);

/// Replaces `out` by the runs of the layer `axis` = `at`, flattened with `u_axis` fastest; neighbours differ.
/// Read straight from the chunk's runs where `u_axis` is the lower of the layer's two axes in the chunk's
/// order; otherwise through `layer`, which then holds that one layer's materials. Requires at < side(axis)
/// and u_axis != axis. Cost: the slowest axis O(runs of the layer), the middle one O(log runs) more per row
/// that is not covered whole, the fastest one O(runs); O(layer) more to transpose.
void layer_runs(const RunChunk& chunk, Axis axis, std::uint32_t at, Axis u_axis,
                const VisibilityTable& visibility, std::vector<Material>& layer, std::vector<MeshRun>& out);

}  // namespace runstone::rdm
