#include <algorithm>
#include <bitset>
#include <span>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/runs/layer_walk.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {
namespace {

using rdm::LayerPatch;
using rdm::QuadShape;
using LayerSet = std::bitset<kSideMax>;

std::uint32_t side_of(const RunChunk& chunk, Axis axis) {
  return chunk.extent.sides()[static_cast<std::size_t>(axis)];
}

/// A row of voxels along the third axis: those with `layer` = at and `row_axis` = row.
struct RowPlace {
  Axis layer;
  std::uint32_t at;
  Axis row_axis;
  std::uint32_t row;
};

/// Decodes a row. O(log runs + runs between its first voxel and its last).
template <class Runs>
void decode_row(const Runs& runs, const RunChunk& chunk, const RowPlace& place, std::span<Material> out) {
  const std::array<Axis, 3> axes = axes_of(chunk.order);
  std::uint32_t voxel = 0;
  std::uint32_t step = 0;
  std::uint32_t stride = 1;
  for (const Axis axis : axes) {
    if (axis == place.layer) {
      voxel += place.at * stride;
    } else if (axis == place.row_axis) {
      voxel += place.row * stride;
    } else {
      step = stride;
    }
    stride *= side_of(chunk, axis);
  }
  RunCursor cursor(runs);
  for (auto it = out.begin(); it != out.end();) {
    if (cursor.end() <= voxel) cursor.seek(voxel);
    const Material material = cursor.material();
    const std::uint32_t end = cursor.end();
    do {
      *it++ = material;
      voxel += step;
    } while (it != out.end() && voxel < end);
  }
}

/// The layers of one direction whose faces an edit may touch: those with changed voxels, and those that look
/// at them.
LayerSet faces_touched(const LayerSet& changed, bool positive, bool beyond, unsigned side) {
  LayerSet out = changed | (positive ? changed >> 1 : changed << 1);
  if (beyond) out.set(positive ? side - 1 : 0);
  return out & ~LayerSet() >> (kSideMax - side);
}

/// Puts new strips into row `row` of a layer's quads, in no particular order: quads that cover the row are
/// cut above and below it, and what repeats exactly is joined again. `beside` is scratch. O(quads + strips *
/// quads beside the row).
void replace_row(const QuadShape& shape, std::uint32_t row, std::span<const Quad> strips,
                 std::vector<Quad>& quads, std::vector<Quad>& beside) {
  beside.clear();
  std::size_t kept = 0;
  for (const Quad quad : quads) {
    const std::uint32_t first = shape.row(quad);
    const std::uint32_t end = first + shape.rows(quad);
    if (end < row || row + 1 < first) {
      quads[kept++] = quad;
      continue;
    }
    if (first < row) beside.push_back(shape.with_rows(quad, first, std::min(end, row) - first));
    if (row + 1 < end) {
      const std::uint32_t below = std::max(first, row + 1);
      beside.push_back(shape.with_rows(quad, below, end - below));
    }
  }
  quads.resize(kept);
  for (const Quad strip : strips) {
    const std::uint64_t same = shape.strip(strip);
    std::uint32_t first = row;
    std::uint32_t end = row + 1;
    for (std::size_t i = 0; i < beside.size();) {
      const Quad quad = beside[i];
      if (shape.strip(quad) != same) {
        ++i;
        continue;
      }
      if (shape.row(quad) < row) {
        first = shape.row(quad);
      } else {
        end = shape.row_end(quad);
      }
      beside[i] = beside.back();
      beside.pop_back();
    }
    quads.push_back(shape.with_rows(strip, first, end - first));
  }
  quads.insert(quads.end(), beside.begin(), beside.end());
}

class Remesher {
 public:
  Remesher(const RunChunk& chunk, const MeshNeighbours& neighbours, const VisibilityTable& visibility,
           const DirtyLayers& dirty, const std::array<DirtyLayers, kDirectionCount>& beyond,
           RdmScratch::State& scratch, ChunkMesh& mesh)
      : chunk_(chunk),
        neighbours_(neighbours),
        visibility_(visibility),
        scratch_(scratch),
        passes_{&mesh.opaque, &mesh.transparent} {
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const auto axis = static_cast<std::size_t>(axis_of(direction));
      const unsigned side = chunk.extent.sides()[axis];
      const RunChunk* const neighbour = neighbours[d];
      const bool border =
          neighbour != nullptr &&
          beyond[d].layer[axis][is_positive(direction) ? 0 : side_of(*neighbour, axis_of(direction)) - 1];
      touched_[d] = faces_touched(dirty.layer[axis], is_positive(direction), border, side);
      rows_[d] = dirty;
      if (border) rows_[d] |= beyond[d];
    }
  }

  /// Rows to be meshed again, in all layers.
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
      if (d % 2 == 0) scratch_.row_layers.reset();  // another axis
      const rdm::StripAxes a = axes(d);
      const std::uint32_t depth = side_of(chunk_, a.layer);
      for (std::uint32_t l = 0; l < depth; ++l) {
        if (touched_[d][l]) mesh_layer(static_cast<Direction>(d), l, a);
      }
    }
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) splice(scratch_.patch[pass], *passes_[pass]);
  }

 private:
  rdm::StripAxes axes(std::size_t direction) const {
    const auto all = rdm::strip_axes(chunk_.order);
    return *std::find_if(all.begin(), all.end(), [direction](const rdm::StripAxes& s) {
      return static_cast<std::size_t>(s.layer) == direction / 2;
    });
  }

  void mesh_layer(Direction direction, std::uint32_t layer, const rdm::StripAxes& a) {
    const auto d = static_cast<std::size_t>(direction);
    const QuadShape shape(direction, a.strip, a.row);
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      const auto quads = passes_[pass]->layer(direction, layer);
      scratch_.layer[pass].assign(quads.begin(), quads.end());
    }
    const LayerSet& rows = rows_[d].layer[static_cast<std::size_t>(a.row)];
    for (std::uint32_t row = 0; row < side_of(chunk_, a.row); ++row) {
      if (rows[row]) mesh_row(direction, layer, row, a, shape);
    }
    const std::size_t index = d * kSideMax + layer;
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      std::vector<Quad>& quads = scratch_.layer[pass];
      const auto before = passes_[pass]->layer(direction, layer);
      if (quads.empty() && before.empty()) continue;
      // The order in which a sweep closes them: it goes up the rows, or along the strips.
      const bool along = rank_of(a.layer, chunk_.order) == 0;
      std::sort(quads.begin(), quads.end(), [&shape, along](Quad x, Quad y) {
        const std::uint32_t x_rows = along ? shape.row(x) : shape.row_end(x);
        const std::uint32_t y_rows = along ? shape.row(y) : shape.row_end(y);
        const std::uint32_t x_last = shape.last(x);
        const std::uint32_t y_last = shape.last(y);
        if (along) return x_last != y_last ? x_last < y_last : x_rows < y_rows;
        return x_rows != y_rows ? x_rows < y_rows : x_last < y_last;
      });
      if (std::equal(quads.begin(), quads.end(), before.begin(), before.end())) continue;
      LayerPatch& patch = scratch_.patch[pass];
      patch.quads.insert(patch.quads.end(), quads.begin(), quads.end());
      patch.layers.push_back({index, static_cast<std::uint32_t>(patch.quads.size())});
    }
  }

  void mesh_row(Direction direction, std::uint32_t layer, std::uint32_t row, const rdm::StripAxes& a,
                const QuadShape& shape) {
    const std::uint32_t bits = side_of(chunk_, a.strip);
    const Material* const own = own_row(layer, row, a).data();
    const Material* beyond = nullptr;
    std::array<Material, kSideMax> outside;
    if (layer != (is_positive(direction) ? side_of(chunk_, a.layer) - 1 : 0)) {
      beyond = own_row(is_positive(direction) ? layer + 1 : layer - 1, row, a).data();
    } else {
      const RunChunk* const neighbour = neighbours_[static_cast<std::size_t>(direction)];
      const std::uint32_t other =
          is_positive(direction) || neighbour == nullptr ? 0 : side_of(*neighbour, a.layer) - 1;
      decode(neighbour, {a.layer, other, a.row, row}, std::span(outside).first(bits));
      beyond = outside.data();
    }
    auto& strips = scratch_.strips;
    std::array<std::size_t, 2> count{};
    for (std::uint32_t bit = 0; bit < bits;) {
      const Material material = own[bit];
      if (material == beyond[bit] || !visibility_.face_drawn(material, beyond[bit])) {
        ++bit;
        continue;
      }
      const std::uint32_t begin = bit;
      while (++bit < bits && own[bit] == material && visibility_.face_drawn(material, beyond[bit])) {
      }
      const std::size_t pass = visibility_[material] == Visibility::transparent ? 1 : 0;
      strips[pass][count[pass]++] =
          shape.close(shape.open({layer, begin, bit - begin, row}, material), row + 1);
    }
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      if (count[pass] == 0 && scratch_.layer[pass].empty()) continue;
      replace_row(shape, row, std::span(strips[pass]).first(count[pass]), scratch_.layer[pass],
                  scratch_.beside);
    }
  }

  /// A row of the chunk; those of one row number are kept until another is asked for.
  const std::array<Material, kSideMax>& own_row(std::uint32_t layer, std::uint32_t row,
                                                const rdm::StripAxes& a) {
    if (row != scratch_.row_number) {
      scratch_.row_number = row;
      scratch_.row_layers.reset();
    }
    auto& voxels = scratch_.row_voxels[layer];
    if (!scratch_.row_layers[layer]) {
      scratch_.row_layers.set(layer);
      decode(&chunk_, {a.layer, layer, a.row, row}, std::span(voxels).first(side_of(chunk_, a.strip)));
    }
    return voxels;
  }

  static void decode(const RunChunk* chunk, const RowPlace& place, std::span<Material> out) {
    if (chunk == nullptr) {
      std::fill(out.begin(), out.end(), kEmpty);
    } else {
      chunk->runs.visit([&](const auto& runs) { decode_row(runs, *chunk, place, out); });
    }
  }

  static void move(std::size_t begin, std::size_t end, std::uint32_t shift, QuadLayers& out) {
    if (shift == 0) return;
    std::uint32_t* const first = out.first.data();
    for (std::size_t i = begin; i < end; ++i) first[i] += shift;
  }

  /// Puts the layers of a patch in the place of those in `out`. O(quads + layers).
  static void splice(LayerPatch& patch, QuadLayers& out) {
    if (patch.layers.empty()) return;
    std::vector<Quad>& merged = patch.merged;
    merged.clear();
    std::size_t kept = 0;     // old quads before this are in `merged`, or replaced
    std::size_t next = 0;     // first[] before this counts in `merged`
    std::uint32_t begin = 0;  // of the layer's quads in the patch
    std::uint32_t shift = 0;  // what to add to first[], modulo 2^32
    const auto at = [](const std::vector<Quad>& quads, std::size_t i) {
      return quads.begin() + static_cast<std::ptrdiff_t>(i);
    };
    for (const LayerPatch::Layer& layer : patch.layers) {
      const std::uint32_t old_begin = out.first[layer.index];
      const std::uint32_t old_end = out.first[layer.index + 1];
      merged.insert(merged.end(), at(out.quads, kept), at(out.quads, old_begin));
      merged.insert(merged.end(), at(patch.quads, begin), at(patch.quads, layer.quads_end));
      kept = old_end;
      move(next, layer.index + 1, shift, out);
      next = layer.index + 1;
      shift += (layer.quads_end - begin) - (old_end - old_begin);
      begin = layer.quads_end;
    }
    merged.insert(merged.end(), at(out.quads, kept), out.quads.cend());
    move(next, out.first.size(), shift, out);
    std::swap(merged, out.quads);
  }

  const RunChunk& chunk_;
  const MeshNeighbours& neighbours_;
  const VisibilityTable& visibility_;
  RdmScratch::State& scratch_;
  const std::array<QuadLayers*, 2> passes_;
  std::array<LayerSet, kDirectionCount> touched_;  // layers to be meshed again
  std::array<DirtyLayers, kDirectionCount> rows_;  // where in them
};

}  // namespace

void mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const VisibilityTable& visibility, const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                     ChunkMesh& mesh) {
  Remesher remesher(chunk, neighbours, visibility, dirty, beyond, scratch.state(), mesh);
  // A row on its own costs some times its share of a sweep, which has a row per line in each direction.
  constexpr std::size_t kSweepRows = 8;
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  if (remesher.row_count() * kSweepRows > std::size_t{kDirectionCount} * e.m * e.s) {
    return mesh_rdm(chunk, neighbours, visibility, scratch, mesh);
  }
  remesher.run();
}

}  // namespace runstone
