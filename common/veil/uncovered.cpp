#include "common/veil/uncovered.hpp"

#include <algorithm>
#include <bitset>
#include <span>

#include "common/core/assert.hpp"
#include "common/runs/layer_diff.hpp"
#include "common/runs/layer_walk.hpp"
#include "common/runs/run_cursor.hpp"
#include "common/veil/veil_scratch.hpp"

namespace runstone {
namespace {

void widen(SlowLayers& layers, std::uint32_t first, std::uint32_t end) {
  if (layers.empty()) {
    layers = {first, end};
  } else {
    layers = {std::min(layers.first, first), std::max(layers.end, end)};
  }
}

/// Returns the layers from the lowest to the highest set bit.
SlowLayers range_of(const std::bitset<kSideMax>& layer) {
  if (layer.none()) return {};
  SlowLayers out{0, kSideMax};
  while (!layer.test(out.first)) ++out.first;
  while (!layer.test(out.end - 1)) --out.end;
  return out;
}

class PatchWriter {
 public:
  explicit PatchWriter(std::vector<VeilSpan>& spans) : spans_(spans) {}
  void add(std::uint32_t first, std::uint32_t end, Material material) {
    if (!spans_.empty() && spans_.back().material == material &&
        spans_.back().first + spans_.back().count == first) {
      spans_.back().count += end - first;
    } else {
      spans_.push_back({first, end - first, material});
    }
  }

 private:
  std::vector<VeilSpan>& spans_;
};

/// Calls piece(from, to, is_enclosed) for the parts of voxels [from, to) of a layer, in order.
template <class Row, class F>
void for_each_part(std::span<const Row> enclosed, std::uint32_t f, std::uint32_t from,
                   std::uint32_t to, F&& piece) {
  while (from < to) {
    const std::uint32_t line = from / f, bit = from - line * f;
    const std::uint32_t stop = std::min(to - line * f, f);
    const bool is_enclosed = (enclosed[line] >> bit & 1) != 0;
    const Row others = (is_enclosed ? ~enclosed[line] : enclosed[line]) & ~bits_below<Row>(bit);
    const std::uint32_t end = line * f + std::min(stop, std::uint32_t{lowest_bit(others)});
    piece(from, end, is_enclosed);
    from = end;
  }
}

template <class Row, class Truth, class Shown>
void find_in_layers(Truth truth, Shown shown, const OrderedExtent& e, const VeilBorders& borders,
                    const VeilMaterials& materials, SlowLayers layers,
                    EnclosedScratch<Row>& scratch, PatchWriter& out) {
  EnclosedLayers<Row, Truth> enclosed(truth, e, borders, materials.covers, scratch, layers.first);
  RunCursor<Truth> lead(truth);
  RunCursor<Shown> told(shown);
  lead.seek(layers.first * e.layer());
  told.seek(layers.first * e.layer());
  for (std::uint32_t s = layers.first; s < layers.end; ++s) {
    const std::span<const Row> rows = enclosed.next();
    const std::uint32_t first = s * e.layer(), end = first + e.layer();
    for (std::uint32_t at = first; at < end;) {
      if (lead.end() == at) lead.next();
      if (told.end() == at) told.next();
      const std::uint32_t stop = std::min({lead.end(), told.end(), end});
      const Material material = lead.material(), seen = told.material();
      if (material != seen) {
        const bool covers = materials.covers[seen] == Visibility::opaque;
        for_each_part(rows, e.f, at - first, stop - first,
                      [&](std::uint32_t from, std::uint32_t to, bool is_enclosed) {
                        if (!is_enclosed) {
                          out.add(first + from, first + to, material);
                        } else if (!covers) {
                          out.add(first + from, first + to, materials.filler);
                        }
                      });
      }
      at = stop;
    }
  }
}

}  // namespace

SlowLayers layers_beside(const RunChunk& chunk, const DirtyLayers& dirty,
                         const std::array<DirtyLayers, kDirectionCount>& beyond) {
  const Axis slow = axes_of(chunk.order)[2];
  const std::uint32_t side = ordered(chunk.extent, chunk.order).s;
  SlowLayers out = range_of(dirty.layer[static_cast<std::size_t>(slow)]);
  if (!out.empty()) out = {out.first == 0 ? 0 : out.first - 1, std::min(out.end + 1, side)};
  for (std::size_t d = 0; d < beyond.size(); ++d) {
    const auto direction = static_cast<Direction>(d);
    const Axis across = axis_of(direction);
    // Only the layer of the neighbour that touches the chunk matters. Chunks of a world are cubes
    // of one edge, so the layers of both chunks have the same numbers.
    const unsigned depth = chunk.extent.sides()[static_cast<std::size_t>(across)];
    if (!beyond[d].any() || !border_dirty(beyond[d], opposite(direction), depth)) continue;
    if (across == slow) {
      const std::uint32_t at = is_positive(direction) ? side - 1 : 0;
      widen(out, at, at + 1);
    } else {
      const SlowLayers range = range_of(beyond[d].layer[static_cast<std::size_t>(slow)]);
      widen(out, range.first, std::min(range.end, side));
    }
  }
  return out;
}

void find_uncovered(const RunChunk& truth, const VeilBorders& borders, const RunChunk& shown,
                    const VeilMaterials& materials, SlowLayers layers, VeilScratch& scratch,
                    VeilPatch& patch) {
  RUNSTONE_ASSERT(truth.extent == shown.extent && truth.order == shown.order);
  RUNSTONE_ASSERT(borders.extent() == truth.extent && borders.order() == truth.order);
  const OrderedExtent e = ordered(truth.extent, truth.order);
  RUNSTONE_ASSERT(layers.end <= e.s);
  patch.extent = truth.extent;
  patch.order = truth.order;
  patch.spans.clear();
  if (layers.empty()) return;
  PatchWriter out(patch.spans);
  truth.runs.visit([&](auto of_truth) {
    shown.runs.visit([&](auto of_shown) {
      if (e.f <= kRowBits<Row64>) {
        find_in_layers(of_truth, of_shown, e, borders, materials, layers, scratch.state().narrow,
                       out);
      } else {
        find_in_layers(of_truth, of_shown, e, borders, materials, layers, scratch.state().wide,
                       out);
      }
    });
  });
}

}  // namespace runstone
