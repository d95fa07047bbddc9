// LayerMesher: meshes again the layers that an edit touched, by a sweep over the part of the chunk
// around them. rdm_layers.cpp and the benchmark of edits use it. Internal to rdm.
#pragma once
#include <algorithm>
#include <array>
#include <bitset>
#include <cstdint>

#include "common/mesh/rdm/chunk_sweep.hpp"
#include "common/mesh/rdm/part_seams.hpp"
#include "common/mesh/rdm/quad_splice.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/mesh/rdm/side_axes.hpp"
#include "common/mesh/rdm/touched_layers.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone::rdm {

/// The steps of meshing layers again.
enum class LayerStep : std::uint8_t {
  open,   // old quads that reach the part become open strips
  sweep,  // the runs of the part, its borders, and its quads
  close,  // strips that reach beyond the part get their old ends
  splice  // new quads replace old ones
};

/// Returns a set of layers as a row of bits. Requires no member beyond the bits of Row.
template <class Row>
Row row_of(const LayerSet& set) {
  constexpr LayerSet kLow(~0ULL);
  auto row = static_cast<Row>((set & kLow).to_ullong());
  if constexpr (sizeof(Row) > 8) row |= static_cast<Row>((set >> 64).to_ullong()) << 64;
  return row;
}

/// Returns the first member of a set from `from` on, or kSideMax if there is none.
inline std::uint32_t next_member(const LayerSet& set, std::uint32_t from) {
  static_assert(kRowBits<Row128> == kSideMax);
  return lowest_bit(row_of<Row128>(set) & ~bits_below<Row128>(from));
}

/// Meshes the touched layers of a chunk again. The observer is called with each step that begins,
/// so that a benchmark can time the steps: this code reads no clock.
template <class Observer>
class LayerMesher {
 public:
  LayerMesher(const RunChunk& chunk, const MeshNeighbours& neighbours, const MeshBorders& borders,
              const VisibilityTable& visibility, RdmScratch::State& scratch, ChunkMesh& mesh,
              Observer& observer)
      : chunk_(chunk),
        neighbours_(neighbours),
        borders_(borders),
        visibility_(visibility),
        scratch_(scratch),
        mesh_(mesh),
        observer_(observer),
        e_(ordered(chunk.extent, chunk.order)) {}

  /// Calls visit(begin, end) for the parts of the slowest axis to sweep, ascending. Changed layers
  /// with fewer than kGap other layers between them are in one part.
  template <class F>
  static void for_each_part(const LayerSet& slow, F&& visit) {
    // Each of two parts reads one layer between them. So if one or two layers lie between them, two
    // parts read as much as one part does.
    constexpr std::uint32_t kGap = 3;
    for (std::uint32_t begin = next_member(slow, 0); begin < kSideMax;) {
      std::uint32_t end = begin + 1, next = next_member(slow, end);
      for (; next < kSideMax && next - end < kGap; next = next_member(slow, end)) end = next + 1;
      visit(begin, end);
      begin = next;
    }
  }

  /// Returns true if sweeps over the touched parts cost less than a sweep over the whole chunk.
  /// Both costs are estimated from counts. The unit is the cost of a run or a quad in a whole mesh:
  /// about 4 ns on the machine where the constants were fitted, to medians of edits by brush. On a
  /// slower machine all terms grow alike. Kept borders make both cheaper, and count as borders that
  /// are read.
  bool pays(const TouchedLayers& touched) const {
    constexpr std::uint64_t kOfSweep = 100;  // to begin and end a sweep
    constexpr std::uint64_t kOfLayer = 3;    // the seams of a layer
    // So many runs of a neighbour are read in one unit.
    constexpr std::uint64_t kBorderRuns = 8;
    if (chunk_.is_uniform() && visibility_[chunk_.runs.material(0)] == Visibility::empty)
      return false;
    std::uint64_t around = 0, around_read = 0, layers = 0, layers_of_chunk = 0;
    const auto sides = chunk_.extent.sides();
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const LayerSet& faces = touched.faces[d];
      layers += faces.count();
      layers_of_chunk += sides[d / 2];
      if (neighbours_[d] == nullptr) continue;
      const std::size_t runs = neighbours_[d]->runs.size();
      around += runs;
      if (faces[is_positive(direction) ? sides[d / 2] - 1u : 0u]) around_read += runs;
    }
    const std::uint64_t runs = chunk_.runs.size(), quads = mesh_.quad_count();
    std::uint64_t cost = around_read / kBorderRuns;
    for_each_part(touched.slow, [&](std::uint32_t begin, std::uint32_t end) {
      const std::uint64_t read =
          runs_of(begin == 0 ? 0 : begin - 1, std::min(end + 1, e_.s)).count();
      // A part has all quads of its layers on the slow sides, a third of the sides. On the others
      // it has those of the touched layers.
      const std::uint64_t quads_read = quads * read / runs;
      cost += kOfSweep + kOfLayer * layers + read + quads_read / 3 +
              quads_read * 2 * layers / (3 * layers_of_chunk);
    });
    return cost < kOfSweep + runs + quads + around / kBorderRuns;
  }

  /// Replaces the quads of the touched layers in the mesh. Requires the mesh of the chunk before
  /// the edit.
  void run(const TouchedLayers& touched) {
    with_rows(chunk_.extent, scratch_, [&]<class Row>(RowScratch<Row>& rows) {
      SweepPart<Row> part;
      const auto axes = side_axes(chunk_.order);
      for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const Direction d = direction_of(axes[side / 2].layer, side % 2 != 0);
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
  RunRange runs_of(std::uint32_t first, std::uint32_t end) const {
    return chunk_.runs.visit([&](const auto& runs) -> RunRange {
      RunCursor cursor(runs);
      cursor.jump(first * e_.layer());
      const std::size_t begin = cursor.run();
      cursor.seek(end * e_.layer() - 1);
      return {begin, cursor.run() + 1};
    });
  }

  template <class Row>
  void mesh_part(const SweepPart<Row>& part, RowScratch<Row>& rows) {
    observer_(LayerStep::sweep);
    const IndexedRuns runs =
        index_runs(chunk_, runs_of(part.first_read(), part.read_end(e_)), visibility_, scratch_);
    const ChunkPalette& palette = scratch_.palette;
    const bool mixed = palette.solid_count() > 1 && palette.has_transparent();
    PartSeams<Row> opaque(chunk_, part, mesh_.opaque, scratch_.opaque, 0, rows.sweep,
                          scratch_.seams[0]);
    PartSeams<Row> transparent(chunk_, part, mesh_.transparent, scratch_.transparent,
                               mixed ? kTransparentQuad : 0, rows.sweep, scratch_.seams[1]);
    const bool any_transparent = palette.has_transparent() || !mesh_.transparent.quads.empty();
    observer_(LayerStep::open);
    opaque.open();
    if (any_transparent) transparent.open();
    observer_(LayerStep::sweep);
    if (palette.solid_count() != 0) {
      const SweepRequest request{chunk_, neighbours_, borders_, visibility_, nullptr};
      sweep_chunk(request, runs, part, scratch_, rows);
    }
    const auto replace = [this](PartSeams<Row>& seams, QuadLayers& layers) {
      scratch_.splice.clear();
      observer_(LayerStep::close);
      seams.close(scratch_.splice);
      observer_(LayerStep::splice);
      scratch_.splice.apply(layers);
    };
    replace(opaque, mesh_.opaque);
    if (any_transparent) replace(transparent, mesh_.transparent);
  }

  const RunChunk& chunk_;
  const MeshNeighbours& neighbours_;
  const MeshBorders& borders_;
  const VisibilityTable& visibility_;
  RdmScratch::State& scratch_;
  ChunkMesh& mesh_;
  Observer& observer_;
  const OrderedExtent e_;
};

}  // namespace runstone::rdm
