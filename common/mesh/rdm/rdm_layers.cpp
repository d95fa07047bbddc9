#include <algorithm>
#include <bit>
#include <bitset>
#include <span>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/mesh/rdm/side_axes.hpp"
#include "common/runs/layer_walk.hpp"

namespace runstone {
namespace {

using rdm::LayerPatch;
using rdm::QuadShape;
using rdm::RowPlace;
using rdm::RowRuns;
using rdm::side_of;
using LayerSet = std::bitset<kSideMax>;

/// Calls visit(place) for all members of a set, ascending.
template <class F>
void for_each(const LayerSet& set, F&& visit) {
  static const LayerSet kLow(~0ULL);
  static_assert(kSideMax == 128);
  for (const unsigned first : {0u, 64u}) {
    std::uint64_t bits = ((set >> first) & kLow).to_ullong();
    for (; bits != 0; bits &= bits - 1)
      visit(first + static_cast<unsigned>(std::countr_zero(bits)));
  }
}

/// Returns the layers of one direction whose faces an edit may touch: the layers with changed
/// voxels, and the layers whose faces point at them.
LayerSet faces_touched(const LayerSet& changed, bool positive, bool beyond, unsigned side) {
  LayerSet out = changed | (positive ? changed >> 1 : changed << 1);
  if (beyond) out.set(positive ? side - 1 : 0);
  return out & ~LayerSet() >> (kSideMax - side);
}

/// The quads of one layer while rows of it are replaced: first the quads that were there before, in
/// the order of the mesh, then new ones.
struct LayerQuads {
  std::vector<Quad>& quads;
  std::size_t in_order;

  /// Puts new strips into row `row`. Quads that cover the row are cut above and below it, and
  /// strips that repeat exactly are joined again. `adjacent` is scratch. Cost: O(quads + strips *
  /// quads adjacent to the row).
  void replace_row(const QuadShape& shape, std::uint32_t row, std::span<const Quad> strips,
                   std::vector<Quad>& adjacent) {
    adjacent.clear();
    std::size_t kept = 0;
    std::size_t kept_in_order = 0;
    for (std::size_t i = 0; i < quads.size(); ++i) {
      const Quad quad = quads[i];
      const std::uint32_t first = shape.row(quad);
      const std::uint32_t end = first + shape.rows(quad);
      if (end < row || row + 1 < first) {
        quads[kept++] = quad;
        kept_in_order += i < in_order ? 1 : 0;
        continue;
      }
      if (first < row) adjacent.push_back(shape.with_rows(quad, first, std::min(end, row) - first));
      if (row + 1 < end) {
        const std::uint32_t below = std::max(first, row + 1);
        adjacent.push_back(shape.with_rows(quad, below, end - below));
      }
    }
    quads.resize(kept);
    in_order = kept_in_order;
    for (const Quad strip : strips) {
      const std::uint64_t same = shape.strip(strip);
      std::uint32_t first = row;
      std::uint32_t end = row + 1;
      for (std::size_t i = 0; i < adjacent.size();) {
        const Quad quad = adjacent[i];
        if (shape.strip(quad) != same) {
          ++i;
          continue;
        }
        if (shape.row(quad) < row) {
          first = shape.row(quad);
        } else {
          end = shape.row_end(quad);
        }
        adjacent[i] = adjacent.back();
        adjacent.pop_back();
      }
      quads.push_back(shape.with_rows(strip, first, end - first));
    }
    quads.insert(quads.end(), adjacent.begin(), adjacent.end());
  }

  /// Sorts all quads by `place(quad)`. The new quads are few: each is inserted.
  template <class Place>
  void sort(Place&& place) {
    for (std::size_t i = in_order; i < quads.size(); ++i) {
      const Quad quad = quads[i];
      const std::uint32_t at = place(quad);
      std::size_t to = i;
      for (; to != 0 && at < place(quads[to - 1]); --to) quads[to] = quads[to - 1];
      quads[to] = quad;
    }
    in_order = quads.size();
  }
};

class Remesher {
 public:
  Remesher(const RunChunk& chunk, const MeshNeighbours& neighbours,
           const VisibilityTable& visibility, const DirtyLayers& dirty,
           const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch::State& scratch,
           ChunkMesh& mesh)
      : chunk_(chunk),
        neighbours_(neighbours),
        visibility_(visibility),
        scratch_(scratch),
        passes_{&mesh.opaque, &mesh.transparent} {
    const auto sides = chunk.extent.sides();
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const auto axis = static_cast<std::size_t>(axis_of(direction));
      const unsigned side = sides[axis];
      const RunChunk* const neighbour = neighbours[d];
      for (std::size_t other = 0; neighbour != nullptr && other < 3; ++other) {
        RUNSTONE_ASSERT(other == axis || neighbour->extent.sides()[other] == sides[other]);
      }
      const bool border =
          neighbour != nullptr &&
          beyond[d].layer[axis]
                         [is_positive(direction) ? 0 : side_of(*neighbour, axis_of(direction)) - 1];
      touched_[d] = faces_touched(dirty.layer[axis], is_positive(direction), border, side);
      rows_[d] = dirty;
      if (border) rows_[d] |= beyond[d];
    }
  }

  /// Returns the number of rows to mesh again, in all layers.
  std::size_t row_count() const {
    std::size_t count = 0;
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      count += touched_[d].count() * rows_[d].layer[static_cast<std::size_t>(axes(d).row)].count();
    }
    return count;
  }

  void run() {
    for (LayerPatch& patch : scratch_.patch) {
      patch.layers.clear();
      patch.quads.clear();
    }
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (d % 2 == 0) scratch_.row_known.reset();  // another axis
      const rdm::StripAxes a = axes(d);
      for_each(touched_[d],
               [&](unsigned layer) { mesh_layer(static_cast<Direction>(d), layer, a); });
    }
    for (std::size_t pass = 0; pass < passes_.size(); ++pass)
      splice(scratch_.patch[pass], *passes_[pass]);
  }

 private:
  rdm::StripAxes axes(std::size_t direction) const {
    return rdm::strip_axes(chunk_.order, axis_of(static_cast<Direction>(direction)));
  }

  void mesh_layer(Direction direction, std::uint32_t layer, const rdm::StripAxes& a) {
    const auto d = static_cast<std::size_t>(direction);
    const QuadShape shape(direction, a.strip, a.row);
    std::array<std::size_t, 2> in_order{};
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      const auto quads = passes_[pass]->layer(direction, layer);
      scratch_.layer[pass].assign(quads.begin(), quads.end());
      in_order[pass] = quads.size();
    }
    std::array<LayerQuads, 2> quads = {
        {{scratch_.layer[0], in_order[0]}, {scratch_.layer[1], in_order[1]}}};
    const LayerSet& rows = rows_[d].layer[static_cast<std::size_t>(a.row)];
    for_each(rows, [&](unsigned row) { mesh_row(direction, layer, row, a, shape, quads); });
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      const auto before = passes_[pass]->layer(direction, layer);
      const std::vector<Quad>& now = scratch_.layer[pass];
      if (now.empty() && before.empty()) continue;
      // The order is that in which a sweep closes the quads: by row, or along the strips.
      if (rank_of(a.layer, chunk_.order) == 0) {
        quads[pass].sort([&shape](Quad q) { return shape.last(q) << 8 | shape.row(q); });
      } else {
        quads[pass].sort([&shape](Quad q) { return shape.row_end(q) << 8 | shape.last(q); });
      }
      if (std::equal(now.begin(), now.end(), before.begin(), before.end())) continue;
      LayerPatch& patch = scratch_.patch[pass];
      patch.quads.insert(patch.quads.end(), now.begin(), now.end());
      patch.layers.push_back(
          {d * kSideMax + layer, static_cast<std::uint32_t>(patch.quads.size())});
    }
  }

  void mesh_row(Direction direction, std::uint32_t layer, std::uint32_t row,
                const rdm::StripAxes& a, const QuadShape& shape, std::array<LayerQuads, 2>& quads) {
    const RowRuns& inside = chunk_row(layer, row, a);
    const RowRuns* beyond = &scratch_.row_beyond;
    if (layer != (is_positive(direction) ? side_of(chunk_, a.layer) - 1 : 0)) {
      beyond = &chunk_row(is_positive(direction) ? layer + 1 : layer - 1, row, a);
    } else if (const RunChunk* const neighbour = neighbours_[static_cast<std::size_t>(direction)]) {
      const std::uint32_t other = is_positive(direction) ? 0 : side_of(*neighbour, a.layer) - 1;
      read(*neighbour, {a.layer, other, a.row, row}, 1, &scratch_.row_beyond);
    } else {
      scratch_.row_beyond.clear();
      scratch_.row_beyond.append(side_of(chunk_, a.strip), kEmpty);
    }
    auto& strips = scratch_.strips;
    std::array<std::size_t, 2> count{};
    std::uint32_t begin = 0;
    for (std::uint32_t i = 0, j = 0; i < inside.count; ++i) {
      const Material material = inside.stretch[i].material;
      const std::uint32_t end = inside.stretch[i].end;
      const std::size_t pass = visibility_[material] == Visibility::transparent ? 1 : 0;
      // The visible part of the stretch's faces is cut where the voxels beyond hide faces.
      for (std::uint32_t at = begin; at < end;) {
        while (beyond->stretch[j].end <= at) ++j;
        const std::uint32_t first = at;
        while (at < end && visibility_.face_drawn(material, beyond->stretch[j].material)) {
          at = std::min<std::uint32_t>(beyond->stretch[j].end, end);
          if (at < end) ++j;
        }
        if (at == first) {
          at = std::min<std::uint32_t>(beyond->stretch[j].end, end);
          continue;
        }
        strips[pass][count[pass]++] =
            shape.close(shape.open({layer, first, at - first, row}, material), row + 1);
      }
      begin = end;
    }
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      if (count[pass] == 0 && scratch_.layer[pass].empty()) continue;
      quads[pass].replace_row(shape, row, std::span(strips[pass]).first(count[pass]),
                              scratch_.adjacent);
    }
  }

  /// Returns a row of the chunk. Rows of one row number are kept until another number is requested.
  /// The adjacent layers are read too, because they are requested next.
  const RowRuns& chunk_row(std::uint32_t layer, std::uint32_t row, const rdm::StripAxes& a) {
    if (row != scratch_.row_number) {
      scratch_.row_number = row;
      scratch_.row_known.reset();
    }
    if (!scratch_.row_known[layer]) {
      const std::uint32_t first = layer == 0 ? 0 : layer - 1;
      const std::uint32_t end = std::min<std::uint32_t>(layer + 2, side_of(chunk_, a.layer));
      read(chunk_, {a.layer, first, a.row, row}, end - first, &scratch_.row_runs[first]);
      for (std::uint32_t l = first; l < end; ++l) scratch_.row_known.set(l);
    }
    return scratch_.row_runs[layer];
  }

  static void read(const RunChunk& chunk, const RowPlace& place, unsigned count, RowRuns* out) {
    chunk.runs.visit([&](const auto& runs) { rdm::read_rows(runs, chunk, place, count, out); });
  }

  static void move(std::size_t begin, std::size_t end, std::uint32_t shift, QuadLayers& out) {
    if (shift == 0) return;
    std::uint32_t* const first = out.first.data();
    for (std::size_t i = begin; i < end; ++i) first[i] += shift;
  }

  /// Replaces the layers of a patch in `out`. Cost: O(quads + layers).
  static void splice(LayerPatch& patch, QuadLayers& out) {
    if (patch.layers.empty()) return;
    std::vector<Quad>& merged = patch.merged;
    merged.resize(out.quads.size() + patch.quads.size());
    Quad* to = merged.data();
    const auto append = [&to](const std::vector<Quad>& from, std::uint32_t begin,
                              std::uint32_t end) {
      to = std::copy(from.data() + begin, from.data() + end, to);
    };
    std::uint32_t kept = 0;   // old quads before this are in `merged`, or replaced
    std::size_t next = 0;     // first[] before this counts in `merged`
    std::uint32_t begin = 0;  // of the layer's quads in the patch
    std::uint32_t shift = 0;  // added to first[], modulo 2^32
    for (const LayerPatch::Layer& layer : patch.layers) {
      const std::uint32_t old_begin = out.first[layer.index];
      const std::uint32_t old_end = out.first[layer.index + 1];
      append(out.quads, kept, old_begin);
      append(patch.quads, begin, layer.quads_end);
      kept = old_end;
      move(next, layer.index + 1, shift, out);
      next = layer.index + 1;
      shift += (layer.quads_end - begin) - (old_end - old_begin);
      begin = layer.quads_end;
    }
    append(out.quads, kept, static_cast<std::uint32_t>(out.quads.size()));
    merged.resize(static_cast<std::size_t>(to - merged.data()));
    move(next, out.first.size(), shift, out);
    std::swap(merged, out.quads);
  }

  const RunChunk& chunk_;
  const MeshNeighbours& neighbours_;
  const VisibilityTable& visibility_;
  RdmScratch::State& scratch_;
  const std::array<QuadLayers*, 2> passes_;
  std::array<LayerSet, kDirectionCount> touched_;  // layers to mesh again
  std::array<DirtyLayers, kDirectionCount> rows_;  // changed rows, per direction
};

}  // namespace

bool mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const VisibilityTable& visibility, const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                     ChunkMesh& mesh) {
  Remesher remesher(chunk, neighbours, visibility, dirty, beyond, scratch.state(), mesh);
  // Meshing a single row costs several times as much as a row of a sweep. A sweep has one row per
  // line in each direction.
  constexpr std::size_t kSweepRows = 8;
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  if (remesher.row_count() * kSweepRows > std::size_t{kDirectionCount} * e.m * e.s) {
    mesh_rdm(chunk, neighbours, visibility, scratch, mesh);
    return false;
  }
  remesher.run();
  return true;
}

}  // namespace runstone
