#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/chunk_sweep.hpp"
#include "common/mesh/rdm/part_seams.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/mesh/rdm/side_axes.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {
namespace {

using rdm::side_of;
using LayerSet = std::bitset<kSideMax>;

/// Returns the first member of a set from `from` on, or kSideMax if there is none.
std::uint32_t next_member(const LayerSet& set, std::uint32_t from) {
  while (from < kSideMax && !set[from]) ++from;
  return from;
}

template <class Row>
Row row_of(const LayerSet& set) {
  static const LayerSet kLow(~0ULL);
  auto row = static_cast<Row>((set & kLow).to_ullong());
  if constexpr (sizeof(Row) > 8) row |= static_cast<Row>((set >> 64).to_ullong()) << 64;
  return row;
}

/// The layers that an edit touched.
class TouchedLayers {
 public:
  TouchedLayers(const RunChunk& chunk, const MeshNeighbours& neighbours, const DirtyLayers& dirty,
                const std::array<DirtyLayers, kDirectionCount>& beyond) {
    const auto sides = chunk.extent.sides();
    const Axis slow_axis = axes_of(chunk.order)[2];
    const auto slow_at = static_cast<std::size_t>(slow_axis);
    slow = dirty.layer[slow_at];
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const auto axis = static_cast<std::size_t>(axis_of(direction));
      const bool positive = is_positive(direction);
      const unsigned side = sides[axis];
      const LayerSet& changed = dirty.layer[axis];
      faces[d] =
          (changed | (positive ? changed >> 1 : changed << 1)) & ~LayerSet() >> (kSideMax - side);
      const RunChunk* const neighbour = neighbours[d];
      if (neighbour == nullptr) continue;
      for (std::size_t other = 0; other < 3; ++other) {
        RUNSTONE_ASSERT(other == axis || neighbour->extent.sides()[other] == sides[other]);
      }
      const unsigned touching = positive ? 0 : side_of(*neighbour, axis_of(direction)) - 1;
      if (!beyond[d].layer[axis][touching]) continue;
      faces[d].set(positive ? side - 1 : 0);
      if (axis == slow_at) {
        slow.set(positive ? side - 1 : 0);
      } else {
        slow |= beyond[d].layer[slow_at];
      }
    }
  }

  /// The layers with faces to mesh again, by Direction.
  std::array<LayerSet, kDirectionCount> faces;
  /// The layers of the slowest axis in which such a face lies or at which one looks.
  LayerSet slow;
};

/// Meshes some layers of a chunk again.
class Remesher {
 public:
  Remesher(const RunChunk& chunk, const MeshNeighbours& neighbours,
           const VisibilityTable& visibility, RdmScratch::State& scratch, ChunkMesh& mesh)
      : chunk_(chunk),
        neighbours_(neighbours),
        visibility_(visibility),
        scratch_(scratch),
        mesh_(mesh),
        e_(ordered(chunk.extent, chunk.order)) {}

  /// Calls visit(begin, end) for the parts of the slowest axis to sweep, ascending. Parts that are
  /// close to each other are one.
  template <class F>
  static void for_each_part(const LayerSet& slow, F&& visit) {
    constexpr std::uint32_t kGap = 3;  // layers that are read twice if the parts are apart
    for (std::uint32_t begin = next_member(slow, 0); begin < kSideMax;) {
      std::uint32_t end = begin + 1, next = next_member(slow, end);
      for (; next < kSideMax && next - end < kGap; next = next_member(slow, end)) end = next + 1;
      visit(begin, end);
      begin = next;
    }
  }

  /// Returns true if sweeps over the touched parts cost less than a sweep over the whole chunk. Both
  /// costs are estimated from counts, in units of a run or a quad of a whole mesh, about 6 ns where
  /// they were fitted. A machine that is slower by a factor is slower in all of the terms.
  bool pays(const TouchedLayers& touched) const {
    constexpr std::uint64_t kOfPart = 200;  // to begin a sweep
    constexpr std::uint64_t kOfLayer = 5;   // the seams of a layer
    constexpr std::uint64_t kBorderRuns =
        8;  // runs of a neighbour that are read at the cost of one
    if (chunk_.is_uniform() && visibility_[chunk_.runs.material(0)] == Visibility::empty)
      return false;
    std::uint64_t around = 0, around_read = 0, layers = 0;
    const auto sides = chunk_.extent.sides();
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const LayerSet& faces = touched.faces[d];
      layers += faces.count();
      if (neighbours_[d] == nullptr) continue;
      const std::size_t runs = neighbours_[d]->runs.size();
      around += runs;
      if (faces[is_positive(direction) ? sides[d / 2] - 1u : 0u]) around_read += runs;
    }
    const std::uint64_t runs = chunk_.runs.size(), work = runs + mesh_.quad_count();
    std::uint64_t cost = around_read / kBorderRuns;
    for_each_part(touched.slow, [&](std::uint32_t begin, std::uint32_t end) {
      const std::uint64_t read =
          runs_of(begin == 0 ? 0 : begin - 1, std::min(end + 1, e_.s)).count();
      cost += work * read / runs + kOfPart + kOfLayer * layers;
    });
    return cost < work + around / kBorderRuns;
  }

  void run(const TouchedLayers& touched) {
    rdm::with_rows(chunk_.extent, scratch_, [&]<class Row>(rdm::RowScratch<Row>& rows) {
      rdm::SweepPart<Row> part;
      const auto axes = rdm::side_axes(chunk_.order);
      for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const Direction d = rdm::direction_of(axes[side / 2].layer, side % 2 != 0);
        part.traced[side] = row_of<Row>(touched.faces[static_cast<std::size_t>(d)]);
      }
      for_each_part(touched.slow, [&](std::uint32_t begin, std::uint32_t end) {
        part.begin = begin;
        part.end = end;
        mesh_part(part, rows);
      });
    });
  }

 private:
  /// Returns the runs that lie in layers [first, end) of the slowest axis.
  rdm::RunRange runs_of(std::uint32_t first, std::uint32_t end) const {
    return chunk_.runs.visit([&](const auto& runs) -> rdm::RunRange {
      RunCursor cursor(runs);
      cursor.jump(first * e_.layer());
      const std::size_t begin = cursor.run();
      cursor.seek(end * e_.layer() - 1);
      return {begin, cursor.run() + 1};
    });
  }

  template <class Row>
  void mesh_part(const rdm::SweepPart<Row>& part, rdm::RowScratch<Row>& rows) {
    const rdm::IndexedRuns runs = rdm::index_runs(
        chunk_, runs_of(part.first_read(), part.read_end(e_)), visibility_, scratch_);
    const rdm::ChunkPalette& palette = scratch_.palette;
    const bool mixed = palette.solid_count() > 1 && palette.has_transparent();
    rdm::PartSeams<Row> opaque(chunk_, part, mesh_.opaque, scratch_.opaque, 0, rows.sweep,
                               scratch_.seams[0]);
    rdm::PartSeams<Row> transparent(chunk_, part, mesh_.transparent, scratch_.transparent,
                                    mixed ? rdm::kTransparentQuad : 0, rows.sweep,
                                    scratch_.seams[1]);
    const bool any_transparent = palette.has_transparent() || !mesh_.transparent.quads.empty();
    opaque.open();
    if (any_transparent) transparent.open();
    if (palette.solid_count() != 0) {
      const rdm::SweepRequest request{chunk_, neighbours_, {}, visibility_, nullptr};
      rdm::sweep_chunk(request, runs, part, scratch_, rows);
    }
    const auto replace = [this](rdm::PartSeams<Row>& seams, QuadLayers& layers) {
      scratch_.splice.clear();
      seams.close(scratch_.splice);
      scratch_.splice.apply(layers);
    };
    replace(opaque, mesh_.opaque);
    if (any_transparent) replace(transparent, mesh_.transparent);
  }

  const RunChunk& chunk_;
  const MeshNeighbours& neighbours_;
  const VisibilityTable& visibility_;
  RdmScratch::State& scratch_;
  ChunkMesh& mesh_;
  const OrderedExtent e_;
};

}  // namespace

bool mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const VisibilityTable& visibility, const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                     ChunkMesh& mesh) {
  const TouchedLayers touched(chunk, neighbours, dirty, beyond);
  Remesher remesher(chunk, neighbours, visibility, scratch.state(), mesh);
  if (!remesher.pays(touched)) {
    mesh_rdm(chunk, neighbours, visibility, scratch, mesh);
    return false;
  }
  remesher.run(touched);
  return true;
}

}  // namespace runstone
