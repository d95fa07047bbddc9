// PartSeams: joins the quads of a swept part of a chunk with the quads before and behind it.
//   before the sweep    quads that reach the part become open strips of the sweep
//   after the sweep     strips that are still open are closed where the old quads end
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
#include "common/mesh/rdm/part_seam.hpp"
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
  /// `mark` is set in the open quads of this pass: kTransparentQuad or 0. `seams` is scratch.
  PartSeams(const RunChunk& chunk, const SweepPart<Row>& part, const QuadLayers& layers,
            QuadBuckets& buckets, std::uint64_t mark, SweepState<Row>& state,
            std::vector<PartSeam>& seams)
      : e_(ordered(chunk.extent, chunk.order)),
        part_(part),
        layers_(layers),
        buckets_(buckets),
        mark_(mark),
        st_(state),
        seams_(seams) {
    const auto axes = strip_axes(chunk.order);
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
      const Direction d = direction_of(axes[side / 2].layer, side % 2 != 0);
      side_[static_cast<std::size_t>(d)] = static_cast<Side>(side);
      shape_[side] = QuadShape(d, axes[side / 2].strip, axes[side / 2].row);
    }
  }

  /// Finds the quads to replace, and opens the strips that reach the part.
  void open() {
    seams_.clear();
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const Side side = side_[d];
      const auto direction = static_cast<Direction>(d);
      if (side == Side::slow_neg) {
        add_slow(direction, part_.begin, part_.read_end(e_));
      } else if (side == Side::slow_pos) {
        add_slow(direction, part_.first_read(), part_.end);
      } else {
        for (Row left = part_.traced[at(side)]; left != 0; left &= left - 1)
          add_crossed(direction, side, lowest_bit(left));
      }
    }
  }

  /// Closes the strips that reach beyond the part, and lists the quads to replace. The quads of the
  /// sweep, and those behind it, are in the buckets then.
  void close(QuadSplice& splice) {
    for (const PartSeam& seam : seams_) {
      QuadBuckets::Bucket& bucket = buckets_.of(seam.direction)[seam.layer];
      const std::size_t index = static_cast<std::size_t>(seam.direction) * kSideMax + seam.layer;
      const std::uint32_t end = layers_.first[index + 1];
      if (bucket.count == 0 && seam.begin == end) continue;
      if (seam.behind != end) {
        const QuadShape& shape = shape_[at(seam.side)];
        const auto behind = std::span(layers_.quads).subspan(seam.behind, end - seam.behind);
        if (is_fast(seam.side)) {
          const auto& start = st_.start_layer[at(seam.side) - at(Side::fast_neg)];
          close_fast(shape, behind, start.data() + seam.layer, bucket);
        } else {
          close_middle(shape, behind, st_.open[at(seam.side)].data() + seam.layer * kBits, bucket);
        }
      }
      splice.add({index, seam.begin, end, bucket.quads.get(), bucket.count});
      bucket.count = 0;
    }
  }

 private:
  static bool is_fast(Side side) { return side == Side::fast_neg || side == Side::fast_pos; }

  /// Adds layers of a slow side: the sweep makes all of their quads.
  void add_slow(Direction d, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t layer = first; layer < end; ++layer) {
      const std::size_t index = static_cast<std::size_t>(d) * kSideMax + layer;
      seams_.push_back({d, side_[static_cast<std::size_t>(d)], static_cast<std::uint8_t>(layer),
                        layers_.first[index], layers_.first[index + 1]});
    }
  }
  /// Adds a layer of another side, which the part crosses, and opens its strips.
  void add_crossed(Direction d, Side side, std::uint32_t layer) {
    const std::span<const Quad> all = layers_.layer(d, layer);
    const QuadShape& shape = shape_[at(side)];
    const auto count_ending = [&](std::span<const Quad> quads, std::uint32_t before) {
      return is_fast(side) ? lower_count(quads, before, [&](Quad q) { return shape.last(q) + 1; })
                           : lower_count(quads, before, [&](Quad q) { return shape.row_end(q); });
    };
    const std::size_t first = count_ending(all, part_.begin);
    const std::span<const Quad> replaced = all.subspan(first);
    const std::size_t behind = first + count_ending(replaced, part_.end + 1);
    const auto base = static_cast<std::uint32_t>(all.data() - layers_.quads.data());
    seams_.push_back({d, side, static_cast<std::uint8_t>(layer),
                      base + static_cast<std::uint32_t>(first),
                      base + static_cast<std::uint32_t>(behind)});
    if (is_fast(side)) {
      auto& start = st_.start_layer[at(side) - at(Side::fast_neg)];
      for (const Quad quad : replaced) open_fast(shape, quad, start.data() + layer);
    } else {
      Quad* const open = st_.open[at(side)].data() + layer * kBits;
      for (const Quad quad : replaced) {
        if (shape.row(quad) >= part_.begin) continue;
        open[shape.last(quad)] = {shape.reopen(quad).bits ^ mark_};
      }
    }
  }

  /// Returns the number of quads with end_of(quad) < `before`. They come first. Most layers have a
  /// few quads, which are counted without an unpredictable branch.
  template <class EndOf>
  static std::size_t lower_count(std::span<const Quad> quads, std::uint32_t before,
                                 EndOf&& end_of) {
    constexpr std::size_t kFew = 16;
    std::size_t low = 0, count = quads.size();
    for (; count > kFew; count -= count / 2)
      low += count / 2 * static_cast<std::size_t>(end_of(quads[low + count / 2 - 1]) < before);
    std::size_t less = 0;
    for (std::size_t i = 0; i < count; ++i)
      less += static_cast<std::size_t>(end_of(quads[low + i]) < before);
    return low + less;
  }

  /// `start`: the layers in which the strips of this layer begin; the one of row r is at r * kBits.
  void open_fast(const QuadShape& shape, Quad quad, std::uint8_t* start) const {
    const std::uint32_t first = shape.first(quad);
    if (first >= part_.begin) return;
    for (std::uint32_t row = shape.row(quad), end = shape.row_end(quad); row < end; ++row)
      start[row * kBits] = static_cast<std::uint8_t>(first);
  }

  /// `open`: the open quads of this layer, by end.
  void close_middle(const QuadShape& shape, std::span<const Quad> quads, const Quad* open,
                    QuadBuckets::Bucket& bucket) const {
    Quad* to = QuadBuckets::reserve(bucket, static_cast<std::uint32_t>(quads.size()));
    for (const Quad quad : quads) {
      const Quad closed = shape.close(open[shape.last(quad)], shape.row_end(quad));
      *to++ = shape.row(quad) <= part_.end ? Quad{closed.bits ^ mark_} : quad;
    }
    bucket.count += static_cast<std::uint32_t>(quads.size());
  }

  /// The strips of a quad may begin in different layers now, and those of two quads in the same
  /// one. So the quads are cut into rows, which join again as a sweep joins them.
  void close_fast(const QuadShape& shape, std::span<const Quad> quads, const std::uint8_t* start,
                  QuadBuckets::Bucket& bucket) const {
    bool joinable = false;  // the last quad of the bucket is one of these, and reaches the part
    for (const Quad quad : quads) {
      if (shape.first(quad) > part_.end) {
        QuadBuckets::put(bucket, quad);
        joinable = false;
        continue;
      }
      for (std::uint32_t row = shape.row(quad), end = shape.row_end(quad); row < end; ++row) {
        const Quad piece = shape.piece(quad, start[row * kBits], row);
        if (joinable && shape.joins(bucket.quads[bucket.count - 1], piece)) {
          Quad& last = bucket.quads[bucket.count - 1];
          last = shape.with_row_more(last);
        } else {
          QuadBuckets::put(bucket, piece);
        }
        joinable = true;
      }
    }
  }

  const OrderedExtent e_;
  const SweepPart<Row>& part_;
  const QuadLayers& layers_;
  QuadBuckets& buckets_;
  const std::uint64_t mark_;
  SweepState<Row>& st_;
  std::array<Side, kDirectionCount> side_{};        // by Direction
  std::array<QuadShape, kDirectionCount> shape_{};  // by Side
  std::vector<PartSeam>& seams_;
};

}  // namespace runstone::rdm
