// Border rows: the layer of a neighbour that touches the chunk, as rows of bits in the chunk's
// orientation. They are read from the neighbour's runs in any axis order. Internal to common/mesh.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/mesh/rdm/divider.hpp"
#include "common/mesh/rdm/row_range.hpp"
#include "common/mesh/rdm/side_axes.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/layer_walk.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone::rdm {

/// A layer of a chunk, and the one of its two axes that runs along the bits of a row.
struct LayerPlace {
  Axis axis, bit_axis;
  std::uint32_t at;
  constexpr Axis row_axis() const {
    return static_cast<Axis>(3 - static_cast<int>(axis) - static_cast<int>(bit_axis));
  }
  /// Returns the place in the chunk of bit `bit` of row `row`.
  constexpr LocalPos voxel(std::uint32_t bit, std::uint32_t row) const {
    std::array<std::uint8_t, 3> out{};
    out[static_cast<std::size_t>(axis)] = static_cast<std::uint8_t>(at);
    out[static_cast<std::size_t>(bit_axis)] = static_cast<std::uint8_t>(bit);
    out[static_cast<std::size_t>(row_axis())] = static_cast<std::uint8_t>(row);
    return {out[0], out[1], out[2]};
  }
};

/// One layer as rows of bits: one plane per bit of the indices that `to_index(material)` returns.
/// In row b of plane k, bit i is bit k of the index of the voxel at (i, b).
template <unsigned kPlanes, class Row, class ToIndex>
class LayerReader {
 public:
  using Rows = std::array<Row, kRowBits<Row>>;

  /// Replaces all planes. Requires indices below 2^kPlanes and sides up to kRowBits<Row>.
  LayerReader(const RunChunk& chunk, LayerPlace place, std::array<Rows, kPlanes>& planes,
              ToIndex to_index)
      : e_(ordered(chunk.extent, chunk.order)), planes_(planes), to_index_(to_index) {
    for (Rows& rows : planes_) rows.fill(0);
    const int rank = rank_of(place.axis, chunk.order);
    chunk.runs.visit([&](const auto& runs) {
      if (rank == 2) {
        read_slow(runs, place.at);
      } else if (rank == 1) {
        read_middle(runs, place.at);
      } else {
        read_fast(runs, place.at);
      }
    });
    if (rank_of(place.bit_axis, chunk.order) == (rank == 0 ? 1 : 0)) return;
    for (Rows& rows : planes_) transpose(rows);
  }

 private:
  void mark(std::uint32_t row, unsigned bit, PaletteIndex change) {
    for (unsigned k = 0; k < kPlanes; ++k) planes_[k][row] ^= Row{change >> k & 1} << bit;
  }
  /// Turns marks of change into bits along each row. The state at the end of a row carries into the
  /// next one.
  void fill(std::uint32_t rows, std::uint32_t bits) {
    const Row valid = bits_below<Row>(bits);
    for (unsigned k = 0; k < kPlanes; ++k) {
      Row carry = 0;
      for (std::uint32_t r = 0; r < rows; ++r) {
        const Row row = prefix_xor(planes_[k][r]) ^ carry;
        carry = Row{0} - (row >> (kRowBits<Row> - 1));
        planes_[k][r] = row & valid;
      }
    }
  }

  template <class Runs>
  void read_slow(const Runs& runs, std::uint32_t at) {
    const Divider line_of(e_.f);
    const std::uint32_t begin = at * e_.layer();
    RunCursor cursor(runs);
    cursor.seek(begin);
    PaletteIndex index = to_index_(cursor.material());
    mark(0, 0, index);
    for (; cursor.end() < begin + e_.layer();) {
      const std::uint32_t voxel = cursor.end() - begin;
      cursor.next();
      const PaletteIndex next = to_index_(cursor.material());
      const std::uint32_t row = line_of(voxel);
      mark(row, voxel - row * e_.f, index ^ next);
      index = next;
    }
    fill(e_.m, e_.f);
  }

  template <class Runs>
  void read_middle(const Runs& runs, std::uint32_t at) {
    // A layer has some dozens of runs: too few for a search to pay.
    constexpr std::size_t kBlock = 8;
    const std::size_t size = runs.size();
    std::size_t i = 0;
    PaletteIndex carried = 0;  // of the last voxel of the previous row
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      const std::uint32_t begin = s * e_.layer() + at * e_.f;
      while (i + kBlock < size && runs.end(i + kBlock - 1) <= begin) i += kBlock;
      while (runs.end(i) <= begin) ++i;
      PaletteIndex index = to_index_(runs.material(i));
      if (index != carried) mark(s, 0, index ^ carried);
      for (; runs.end(i) < begin + e_.f; ++i) {
        const PaletteIndex next = to_index_(runs.material(i + 1));
        mark(s, runs.end(i) - begin, index ^ next);
        index = next;
      }
      carried = index;
    }
    fill(e_.s, e_.f);
  }

  template <class Runs>
  void read_fast(const Runs& runs, std::uint32_t at) {
    // Each line has a voxel in the layer. With more runs than this in a line, a search for the
    // voxel costs less than reading the runs.
    constexpr std::size_t kRunsPerLine = 8;
    if (runs.size() > kRunsPerLine * e_.m * e_.s) return search_fast(runs, at);
    // One bit per line. A line is marked if it is the first whose voxel `at` lies behind the end of
    // a run with another index.
    using Marks = std::array<Row64, kSideMax * kSideMax / 64 + 2>;
    std::array<Marks, kPlanes> marks;
    for (unsigned k = 0; k < kPlanes; ++k)
      std::fill_n(marks[k].begin(), e_.m * e_.s / 64 + 2, Row64{0});
    const Divider line_of(e_.f);
    const std::uint32_t ahead = e_.f - 1 - at;
    const ToIndex to_index = to_index_;
    const std::size_t last = runs.size() - 1;
    PaletteIndex index = to_index(runs.material(0));
    // The word of the present lines is in registers: a change in memory would wait for the one
    // before it.
    std::array<Row64, kPlanes> word;
    std::uint32_t word_at = 0;
    for (unsigned k = 0; k < kPlanes; ++k) word[k] = index >> k & 1;
    for (std::size_t i = 0; i < last; ++i) {
      const PaletteIndex next = to_index(runs.material(i + 1));
      if (next == index) continue;  // most neighbouring runs have the same index
      const std::uint32_t line = line_of(runs.end(i) + ahead);
      const PaletteIndex change = index ^ next;
      index = next;
      if (line / 64 != word_at) {
        for (unsigned k = 0; k < kPlanes; ++k) marks[k][word_at] = word[k];
        word.fill(0);
        word_at = line / 64;
      }
      for (unsigned k = 0; k < kPlanes; ++k) word[k] ^= Row64{change >> k & 1} << (line % 64);
    }
    for (unsigned k = 0; k < kPlanes; ++k) {
      marks[k][word_at] = word[k];
      cut_rows(marks[k].data(), planes_[k]);
    }
  }
  /// Does what read_fast() does by a search for the run of each voxel of the layer. In one layer of
  /// the slowest axis, each search begins at the run of the voxel before. The searches in different
  /// layers do not wait for each other.
  template <class Runs>
  void search_fast(const Runs& runs, std::uint32_t at) {
    std::array<std::uint32_t, kSideMax> run;  // by layer: that of the voxel of the present line
    RunCursor cursor(runs);
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      cursor.jump(s * e_.layer() + at);
      run[s] = static_cast<std::uint32_t>(cursor.run());
    }
    const ToIndex to_index = to_index_;
    for (std::uint32_t m = 0; m < e_.m; ++m) {
      for (std::uint32_t s = 0; s < e_.s; ++s) {
        run[s] = run_ahead(runs, run[s], s * e_.layer() + m * e_.f + at);
        const PaletteIndex index = to_index(runs.material(run[s]));
        for (unsigned k = 0; k < kPlanes; ++k) planes_[k][s] |= Row{index >> k & 1} << m;
      }
    }
  }
  /// Returns the run that covers `voxel`. Requires that it is none of the runs before `run`, and at
  /// most e_.f runs behind it. It searches without an unpredictable branch.
  template <class Runs>
  std::uint32_t run_ahead(const Runs& runs, std::uint32_t run, std::uint32_t voxel) const {
    const auto ends = [&](std::uint32_t i) -> std::uint32_t { return runs.end(i) <= voxel; };
    // A search of up to 32 runs reads runs up to run + 31.
    constexpr std::uint32_t kStep = 32;
    while (run + kStep < runs.size()) {
      if (ends(run + kStep - 1) != 0) {
        run += kStep;
        continue;
      }
      run += 8 * (ends(run + 7) + ends(run + 15) + ends(run + 23));
      run += 2 * (ends(run + 1) + ends(run + 3) + ends(run + 5));
      return run + ends(run);
    }
    while (ends(run) != 0) ++run;
    return run;
  }
  /// Turns marks of change, one bit per line, into rows of e_.m bits.
  void cut_rows(Row64* marks, Rows& rows) const {
    Row64 carry = 0;
    for (std::uint32_t w = 0; w <= e_.m * e_.s / 64; ++w) {
      marks[w] = prefix_xor(marks[w]) ^ carry;
      carry = Row64{0} - (marks[w] >> 63);
    }
    const Row valid = bits_below<Row>(e_.m);
    for (std::uint32_t s = 0, first = 0; s < e_.s; ++s, first += e_.m) {
      Row row = 0;
      for (unsigned bit = 0; bit < e_.m; bit += 64) {
        const std::uint32_t at = first + bit;
        const Row64 low = marks[at / 64] >> (at % 64);
        const Row64 high = at % 64 == 0 ? 0 : marks[at / 64 + 1] << (64 - at % 64);
        row |= static_cast<Row>(low | high) << bit;
      }
      rows[s] = row & valid;
    }
  }

  const OrderedExtent e_;
  std::array<Rows, kPlanes>& planes_;
  ToIndex to_index_;
};

/// Reads the rows `wanted` of a layer into the planes of LayerReader, and clears the others. It is
/// for a few rows. Cost: O(rows * (length + log runs)), and less where the lines of the chunk lie
/// along the rows.
template <std::size_t kPlanes, class Runs, class Row, std::size_t kRows, class ToIndex>
void read_few_rows(const Runs& runs, const RunChunk& chunk, const LayerPlace& place,
                   RowRange wanted, std::array<std::array<Row, kRows>, kPlanes>& planes,
                   ToIndex to_index) {
  for (auto& plane : planes) plane.fill(0);
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const int bit_rank = rank_of(place.bit_axis, chunk.order);
  const int row_rank = rank_of(place.row_axis(), chunk.order);
  std::array<RowRange, 3> box;  // by rank
  box[static_cast<std::size_t>(rank_of(place.axis, chunk.order))] = {place.at, place.at + 1};
  box[static_cast<std::size_t>(bit_rank)] = {0, side_of(chunk, place.bit_axis)};
  box[static_cast<std::size_t>(row_rank)] = wanted;
  RunCursor cursor(runs);
  cursor.jump(box[2].first * e.layer() + box[1].first * e.f + box[0].first);
  std::array<std::uint32_t, 3> at{};  // by rank
  for (at[2] = box[2].first; at[2] < box[2].end; ++at[2]) {
    for (at[1] = box[1].first; at[1] < box[1].end; ++at[1]) {
      const std::uint32_t line = at[2] * e.layer() + at[1] * e.f;
      for (at[0] = box[0].first; at[0] < box[0].end;) {
        if (cursor.end() <= line + at[0]) cursor.seek(line + at[0]);
        const std::uint32_t stop = std::min(cursor.end() - line, box[0].end);
        const PaletteIndex index = to_index(cursor.material());
        for (unsigned k = 0; k < kPlanes; ++k) {
          const Row bit{index >> k & 1};
          if (bit_rank == 0) {
            planes[k][at[static_cast<std::size_t>(row_rank)]] |=
                (bits_below<Row>(stop) & ~bits_below<Row>(at[0])) * bit;
            continue;
          }
          for (std::uint32_t i = at[0]; i < stop; ++i) {
            planes[k][row_rank == 0 ? i : at[static_cast<std::size_t>(row_rank)]] |=
                bit << at[static_cast<std::size_t>(bit_rank)];
          }
        }
        at[0] = stop;
      }
    }
  }
}

/// Reads the rows `wanted` of a layer: few rows with read_few_rows(), many with LayerReader. For a
/// chunk of one material it writes the same rows without reading. The other rows are not valid
/// afterwards.
template <std::size_t kPlanes, class Row, std::size_t kRows, class ToIndex>
void read_layer_rows(const RunChunk& chunk, LayerPlace place, RowRange wanted,
                     std::array<std::array<Row, kRows>, kPlanes>& planes, ToIndex to_index) {
  if (!chunk.is_uniform()) {
    // A voxel of a row that is looked up costs several times as much as a run that is read.
    constexpr std::size_t kRunsPerVoxel = 8;
    if (wanted.count() == side_of(chunk, place.row_axis()) ||
        kRunsPerVoxel * wanted.count() * side_of(chunk, place.bit_axis) > chunk.runs.size()) {
      LayerReader<kPlanes, Row, ToIndex>(chunk, place, planes, to_index);
    } else {
      chunk.runs.visit(
          [&](const auto& runs) { read_few_rows(runs, chunk, place, wanted, planes, to_index); });
    }
    return;
  }
  const PaletteIndex index = to_index(chunk.runs.material(0));
  const Row row = bits_below<Row>(side_of(chunk, place.bit_axis));
  for (unsigned k = 0; k < kPlanes; ++k) {
    planes[k].fill(0);
    std::fill_n(planes[k].begin(), side_of(chunk, place.row_axis()),
                (index >> k & 1) != 0 ? row : Row{0});
  }
}

/// Reads all rows of a layer.
template <std::size_t kPlanes, class Row, std::size_t kRows, class ToIndex>
void read_layer_rows(const RunChunk& chunk, LayerPlace place,
                     std::array<std::array<Row, kRows>, kPlanes>& planes, ToIndex to_index) {
  read_layer_rows(chunk, place, {0, side_of(chunk, place.row_axis())}, planes, to_index);
}

}  // namespace runstone::rdm
