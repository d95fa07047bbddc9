#include "tests/bench/fused_edit.hpp"

#include <algorithm>
#include <span>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone::bench {
namespace {

using rdm::LayerPatch;
using rdm::QuadShape;

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

/// What the walk finds: the edit index, and the run that stood there.
struct EditIndex {
  std::size_t run = 0;
  std::uint32_t begin = 0;
  Run old;
};

/// One pass over the runs from the line before the edit's layer to the line behind it.
template <class Runs>
EditIndex walk(const Runs& runs, const OrderedExtent& e, const OrderedPos& at, Material material,
               TouchedRows& rows) {
  RunCursor cursor(runs);
  // Lines and voxels are asked for in ascending order.
  const auto line = [&](std::uint32_t m, std::uint32_t s, TouchedRows::Row& out) {
    const std::uint32_t first = (s * e.m + m) * e.f;
    cursor.seek(first);
    for (std::uint32_t f = 0; f < e.f;) {
      while (cursor.end() <= first + f) cursor.next();
      const std::uint32_t end = std::min(cursor.end() - first, e.f);
      std::fill(out.begin() + f, out.begin() + end, cursor.material());
      f = end;
    }
  };
  if (at.s > 0) line(at.m, at.s - 1, rows.slow[0]);
  const std::uint32_t before = at.f == 0 ? 0 : at.f - 1;
  const std::uint32_t behind = std::min(at.f + 1, e.f - 1);
  EditIndex found;
  cursor.seek(at.s * e.m * e.f);
  for (std::uint32_t m = 0; m < e.m; ++m) {
    const std::uint32_t first = (at.s * e.m + m) * e.f;
    if (m + 1 >= at.m && m <= at.m + 1) {  // the lines beside the edit's
      while (cursor.end() <= first) cursor.next();
      TouchedRows::Row& row = rows.mid[m + 1 - at.m];
      for (std::uint32_t f = 0; f < e.f;) {
        while (cursor.end() <= first + f) cursor.next();
        const std::uint32_t end = std::min(cursor.end() - first, e.f);
        if (m == at.m && f <= at.f && at.f < end) {
          found.run = cursor.run();
          found.old = {cursor.end(), cursor.material()};
        }
        std::fill(row.begin() + f, row.begin() + end, cursor.material());
        f = end;
      }
      for (std::uint32_t f = before; f <= behind; ++f) rows.fast[f + 1 - at.f][m] = row[f];
    } else {
      for (std::uint32_t f = before; f <= behind; ++f) {
        while (cursor.end() <= first + f) cursor.next();
        rows.fast[f + 1 - at.f][m] = cursor.material();
      }
    }
  }
  found.begin = found.run == 0 ? 0 : runs.end(found.run - 1);
  rows.mid[1][at.f] = material;
  rows.fast[1][at.m] = material;
  rows.slow[1] = rows.mid[1];
  if (at.s + 1u < e.s) line(at.m, at.s + 1, rows.slow[2]);
  return found;
}

/// Splits and merges the runs at the edit index.
void splice_in(const EditIndex& at, std::uint32_t voxel, Material material, RunList& runs) {
  std::array<Run, 3> with;
  std::size_t count = 0;
  std::size_t first = at.run;
  std::size_t replaced = 1;
  if (at.begin < voxel) {
    with[count++] = {voxel, at.old.material};
  } else if (first > 0 && runs.material(first - 1) == material) {
    --first;
    ++replaced;
  }
  with[count++] = {voxel + 1, material};
  if (voxel + 1 < at.old.end) {
    with[count++] = at.old;
  } else if (at.run + 1 < runs.size() && runs.material(at.run + 1) == material) {
    with[count - 1].end = runs.end(at.run + 1);
    ++replaced;
  }
  runs.splice(first, replaced, std::span(with).first(count));
}

/// As Remesher of rdm_layers.cpp, for one voxel, from rows that are there.
class RowMesher {
 public:
  RowMesher(const RunChunk& chunk, const std::array<std::uint32_t, 3>& at, const MeshNeighbours& neighbours,
            const VisibilityTable& visibility, const TouchedRows& rows, RdmScratch::State& scratch,
            ChunkMesh& mesh)
      : chunk_(chunk),
        at_(at),
        neighbours_(neighbours),
        visibility_(visibility),
        rows_(rows),
        scratch_(scratch),
        passes_{&mesh.opaque, &mesh.transparent} {}

  void run() {
    for (LayerPatch& patch : scratch_.patch) {
      patch.layers.clear();
      patch.quads.clear();
    }
    const auto all = rdm::side_axes(chunk_.order);
    const std::array<const std::array<TouchedRows::Row, 3>*, 3> rows = {&rows_.slow, &rows_.mid, &rows_.fast};
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto rank = static_cast<std::size_t>(
          std::find_if(all.begin(), all.end(),
                       [d](const rdm::SideAxes& s) { return static_cast<std::size_t>(s.layer) == d / 2; }) -
          all.begin());
      const std::uint32_t layer = at_[d / 2];
      const bool positive = d % 2 == 1;
      // Its own faces, and those that look at it.
      if (positive && layer > 0) mesh_layer(static_cast<Direction>(d), layer - 1, all[rank], *rows[rank]);
      mesh_layer(static_cast<Direction>(d), layer, all[rank], *rows[rank]);
      if (!positive && layer + 1 < side_of(chunk_, all[rank].layer)) {
        mesh_layer(static_cast<Direction>(d), layer + 1, all[rank], *rows[rank]);
      }
    }
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) splice(scratch_.patch[pass], *passes_[pass]);
  }

 private:
  void mesh_layer(Direction direction, std::uint32_t layer, const rdm::SideAxes& a,
                  const std::array<TouchedRows::Row, 3>& rows) {
    const auto d = static_cast<std::size_t>(direction);
    const QuadShape shape(direction, a.bit, a.row);
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      const auto quads = passes_[pass]->layer(direction, layer);
      scratch_.layer[pass].assign(quads.begin(), quads.end());
    }
    mesh_row(direction, layer, a, shape, rows);
    const std::size_t index = d * kSideMax + layer;
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      std::vector<Quad>& quads = scratch_.layer[pass];
      const auto before = passes_[pass]->layer(direction, layer);
      if (quads.empty() && before.empty()) continue;
      // The order in which a sweep closes them.
      std::sort(quads.begin(), quads.end(), [&shape](Quad x, Quad y) {
        const std::uint32_t x_end = shape.row_end(x);
        const std::uint32_t y_end = shape.row_end(y);
        return x_end != y_end ? x_end < y_end : shape.last(x) < shape.last(y);
      });
      if (std::equal(quads.begin(), quads.end(), before.begin(), before.end())) continue;
      LayerPatch& patch = scratch_.patch[pass];
      patch.quads.insert(patch.quads.end(), quads.begin(), quads.end());
      patch.layers.push_back({index, static_cast<std::uint32_t>(patch.quads.size())});
    }
  }

  void mesh_row(Direction direction, std::uint32_t layer, const rdm::SideAxes& a, const QuadShape& shape,
                const std::array<TouchedRows::Row, 3>& rows) {
    const std::uint32_t bits = side_of(chunk_, a.bit);
    const std::uint32_t row = at_[static_cast<std::size_t>(a.row)];
    const std::size_t place = layer + 1 - at_[static_cast<std::size_t>(a.layer)];  // in `rows`
    const Material* const own = rows[place].data();
    const Material* beyond = nullptr;
    std::array<Material, kSideMax> outside;
    if (layer != (is_positive(direction) ? side_of(chunk_, a.layer) - 1 : 0)) {
      beyond = rows[is_positive(direction) ? place + 1 : place - 1].data();
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
  const std::array<std::uint32_t, 3> at_;
  const MeshNeighbours& neighbours_;
  const VisibilityTable& visibility_;
  const TouchedRows& rows_;
  RdmScratch::State& scratch_;
  const std::array<QuadLayers*, 2> passes_;
};

}  // namespace

void edit_fused(RunChunk& chunk, Digest& digest, LocalPos at, Material material,
                const MeshNeighbours& neighbours, const VisibilityTable& visibility, TouchedRows& rows,
                RdmScratch& scratch, ChunkMesh& mesh) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const VoxelIndex voxel = index_of(at, chunk.extent, chunk.order);
  const OrderedPos place = to_ordered(at, chunk.order);
  const EditIndex found =
      chunk.runs.visit([&](const auto& runs) { return walk(runs, e, place, material, rows); });
  if (found.old.material == material) return;
  splice_in(found, voxel, material, chunk.runs);
  digest = digest - digest_of_span(chunk, voxel, voxel + 1, found.old.material) +
           digest_of_span(chunk, voxel, voxel + 1, material);
  RowMesher(chunk, {at.x, at.y, at.z}, neighbours, visibility, rows, scratch.state(), mesh).run();
}

void remesh_walked(const RunChunk& chunk, LocalPos at, const MeshNeighbours& neighbours,
                   const VisibilityTable& visibility, TouchedRows& rows, RdmScratch& scratch,
                   ChunkMesh& mesh) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const OrderedPos place = to_ordered(at, chunk.order);
  const Material material = material_at(chunk, at);
  chunk.runs.visit([&](const auto& runs) { walk(runs, e, place, material, rows); });
  RowMesher(chunk, {at.x, at.y, at.z}, neighbours, visibility, rows, scratch.state(), mesh).run();
}

}  // namespace runstone::bench
