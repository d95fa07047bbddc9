// PartSeams: joins the quads of a swept part of a chunk with the quads before and behind it.
//   before the sweep    quads that reach the part become open strips of the sweep
//   after the sweep     strips that are still open are closed where the old quads behind the part end
// The quads of a layer stand in the order in which a sweep closes them. So in each layer the quads
// that end before the part stay, and all from the first one on that ends in the part or behind it
// are replaced. Internal to rdm.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/rdm/quad_buckets.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/mesh/rdm/quad_splice.hpp"
#include "common/mesh/rdm/side_axes.hpp"
#include "common/mesh/rdm/sweep_input.hpp"
#include "common/mesh/rdm/sweep_part.hpp"
#include "common/mesh/rdm/sweep_state.hpp"
#include "common/runs/bit_row.hpp"

namespace runstone::rdm {

/// The seams of one pass. Row: that of the sweep.
template <class Row>
class PartSeams {
  static constexpr std::size_t kBits = kRowBits<Row>;

 public:
  /// `mark` is set in the open quads of this pass: kTransparentQuad or 0.
  PartSeams(const RunChunk& chunk, const SweepPart<Row>& part, const QuadLayers& layers,
            QuadBuckets& buckets, std::uint64_t mark, SweepState<Row>& state)
      : e_(ordered(chunk.extent, chunk.order)),
        part_(part),
        layers_(layers),
        buckets_(buckets),
        mark_(mark),
        st_(state) {
    const auto axes = strip_axes(chunk.order);
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
      const Direction d = direction_of(axes[side / 2].layer, side % 2 != 0);
      side_[static_cast<std::size_t>(d)] = static_cast<Side>(side);
      shape_[side] = QuadShape(d, axes[side / 2].strip, axes[side / 2].row);
    }
  }

  /// Opens the strips that reach the part.
  void open() {
    if (part_.begin == 0) return;
    for_each_layer([this](Direction d, Side side, std::uint32_t layer) {
      const QuadShape& shape = shape_[at(side)];
      for (const Quad quad : replaced(d, side, layer)) {
        if (is_fast(side)) {
          open_fast(shape, quad, layer, st_.start_layer[at(side) - at(Side::fast_neg)]);
        } else if (is_middle(side) && shape.row(quad) < part_.begin) {
          Quad opened = shape.reopen(quad);
          opened.bits ^= mark_;
          st_.open[at(side)][layer * kBits + shape.last(quad)] = opened;
        }
      }
    });
  }

  /// Closes the strips that reach beyond the part, and lists the quads to replace. The quads of the
  /// sweep, and those behind it, are in the buckets then.
  void close(QuadSplice& splice) {
    for_each_layer([&](Direction d, Side side, std::uint32_t layer) {
      const QuadShape& shape = shape_[at(side)];
      QuadBuckets::Bucket& bucket = buckets_.of(d)[layer];
      const std::span<const Quad> old = replaced(d, side, layer);
      const std::span<const Quad> behind = behind_part(shape, side, old);
      if (is_middle(side)) {
        const Quad* const open = st_.open[at(side)].data() + layer * kBits;
        for (const Quad quad : behind) close_middle(shape, quad, open, bucket);
      } else if (!behind.empty()) {
        close_fast(shape, behind, layer, st_.start_layer[at(side) - at(Side::fast_neg)], bucket);
      }
      const std::size_t index = static_cast<std::size_t>(d) * kSideMax + layer;
      const auto begin = static_cast<std::uint32_t>(old.data() - layers_.quads.data());
      splice.add({index, begin, layers_.first[index + 1], bucket.quads.get(), bucket.count});
      bucket.count = 0;
    });
  }

 private:
  static bool is_middle(Side side) { return side == Side::mid_neg || side == Side::mid_pos; }
  static bool is_fast(Side side) { return side == Side::fast_neg || side == Side::fast_pos; }

  /// Calls f(direction, side, layer) for all layers with quads to replace, in the order of
  /// QuadLayers.
  template <class F>
  void for_each_layer(F&& f) const {
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const Side side = side_[d];
      const auto direction = static_cast<Direction>(d);
      if (side == Side::slow_neg) {
        for (std::uint32_t s = part_.begin; s < part_.read_end(e_); ++s) f(direction, side, s);
      } else if (side == Side::slow_pos) {
        for (std::uint32_t s = part_.first_read(); s < part_.end; ++s) f(direction, side, s);
      } else {
        for (Row left = part_.traced[at(side)]; left != 0; left &= left - 1)
          f(direction, side, lowest_bit(left));
      }
    }
  }

  /// Returns the layer behind the last one that a quad reaches along the slowest axis.
  static std::uint32_t end_of(const QuadShape& shape, Side side, Quad quad) {
    return is_fast(side) ? shape.last(quad) + 1 : shape.row_end(quad);
  }
  /// Returns the quads of a layer that the sweep replaces.
  std::span<const Quad> replaced(Direction d, Side side, std::uint32_t layer) const {
    const std::span<const Quad> all = layers_.layer(d, layer);
    if (!is_middle(side) && !is_fast(side)) return all;
    const QuadShape& shape = shape_[at(side)];
    const auto first = std::partition_point(
        all.begin(), all.end(), [&](Quad quad) { return end_of(shape, side, quad) < part_.begin; });
    return all.subspan(static_cast<std::size_t>(first - all.begin()));
  }
  /// Returns those quads that end behind the part. They keep their ends.
  std::span<const Quad> behind_part(const QuadShape& shape, Side side,
                                    std::span<const Quad> replaced) const {
    if (!is_middle(side) && !is_fast(side)) return {};
    const auto first = std::partition_point(replaced.begin(), replaced.end(), [&](Quad quad) {
      return end_of(shape, side, quad) <= part_.end;
    });
    return replaced.subspan(static_cast<std::size_t>(first - replaced.begin()));
  }

  template <class Places>
  void open_fast(const QuadShape& shape, Quad quad, std::uint32_t layer, Places& start) const {
    const std::uint32_t first = shape.first(quad);
    if (first >= part_.begin) return;
    for (std::uint32_t row = shape.row(quad), end = shape.row_end(quad); row < end; ++row)
      start[row * kBits + layer] = static_cast<std::uint8_t>(first);
  }

  void close_middle(const QuadShape& shape, Quad quad, const Quad* open,
                    QuadBuckets::Bucket& bucket) const {
    if (shape.row(quad) <= part_.end) {
      quad = shape.close(open[shape.last(quad)], shape.row_end(quad));
      quad.bits ^= mark_;
    }
    QuadBuckets::put(bucket, quad);
  }

  /// The strips of a quad may begin in different layers now, and those of two quads in the same
  /// one. So the quads are cut into rows, which join again as a sweep joins them.
  template <class Places>
  void close_fast(const QuadShape& shape, std::span<const Quad> quads, std::uint32_t layer,
                  const Places& start, QuadBuckets::Bucket& bucket) const {
    Quad joined{};  // has no strip in common with a quad of the layer until it is set
    bool is_set = false;
    for (const Quad quad : quads) {
      if (shape.first(quad) > part_.end) {
        if (is_set) QuadBuckets::put(bucket, joined);
        is_set = false;
        QuadBuckets::put(bucket, quad);
        continue;
      }
      for (std::uint32_t row = shape.row(quad), end = shape.row_end(quad); row < end; ++row) {
        const Quad piece = shape.piece(quad, start[row * kBits + layer], row);
        if (is_set && shape.joins(joined, piece)) {
          joined = shape.with_row_more(joined);
          continue;
        }
        if (is_set) QuadBuckets::put(bucket, joined);
        joined = piece;
        is_set = true;
      }
    }
    if (is_set) QuadBuckets::put(bucket, joined);
  }

  const OrderedExtent e_;
  const SweepPart<Row>& part_;
  const QuadLayers& layers_;
  QuadBuckets& buckets_;
  const std::uint64_t mark_;
  SweepState<Row>& st_;
  std::array<Side, kDirectionCount> side_{};        // by Direction
  std::array<QuadShape, kDirectionCount> shape_{};  // by Side
};

}  // namespace runstone::rdm
