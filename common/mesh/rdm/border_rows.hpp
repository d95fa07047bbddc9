// Border rows: the layer of a neighbour that touches the chunk, as rows of bits in the chunk's orientation,
// read straight from the neighbour's runs whatever its axis order is. Internal to rdm.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/bit_row.hpp"
#include "common/mesh/rdm/divider.hpp"
#include "common/mesh/rdm/material_codes.hpp"
#include "common/runs/layer_walk.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone::rdm {

/// A layer of a chunk, and which of its two axes runs along the bits of a row.
struct LayerPlace {
  Axis axis, bit_axis;
  std::uint32_t at;
};

/// One layer as rows of bits, a plane per bit of the codes that `code_of(material)` gives.
/// Row b of plane k: bit i says whether bit k of the code of the voxel at (i, b) is set.
template <class Row, class CodeOf>
class LayerReader {
 public:
  using Rows = std::array<Row, kRowBits<Row>>;

  /// Planes 0 .. count - 1 are replaced. Requires codes below 2^count and sides up to kRowBits<Row>.
  LayerReader(const RunChunk& chunk, LayerPlace place, Rows* planes, unsigned count, CodeOf code_of)
      : e_(ordered(chunk.extent, chunk.order)), planes_(planes), count_(count), code_of_(code_of) {
    for (unsigned k = 0; k < count_; ++k) planes_[k].fill(0);
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
    for (unsigned k = 0; k < count_; ++k) transpose(planes_[k]);
  }

 private:
  void mark(std::uint32_t row, unsigned bit, Code change) {
    for (unsigned k = 0; k < count_; ++k) planes_[k][row] ^= Row{change >> k & 1} << bit;
  }
  /// Marks of change become bits: along each row, and on into the next if `carried`.
  void fill(std::uint32_t rows, std::uint32_t bits) {
    const Row valid = bits_below<Row>(bits);
    for (unsigned k = 0; k < count_; ++k) {
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
    Code code = code_of_(cursor.material());
    mark(0, 0, code);
    for (; cursor.end() < begin + e_.layer();) {
      const std::uint32_t voxel = cursor.end() - begin;
      cursor.next();
      const Code next = code_of_(cursor.material());
      const std::uint32_t row = line_of(voxel);
      mark(row, voxel - row * e_.f, code ^ next);
      code = next;
    }
    fill(e_.m, e_.f);
  }

  template <class Runs>
  void read_middle(const Runs& runs, std::uint32_t at) {
    RunCursor cursor(runs);
    Code carried = 0;  // of the last voxel of the row before
    for (std::uint32_t s = 0; s < e_.s; ++s) {
      const std::uint32_t begin = s * e_.layer() + at * e_.f;
      cursor.seek(begin);
      Code code = code_of_(cursor.material());
      if (code != carried) mark(s, 0, code ^ carried);
      while (cursor.end() < begin + e_.f) {
        const std::uint32_t voxel = cursor.end() - begin;
        cursor.next();
        const Code next = code_of_(cursor.material());
        mark(s, voxel, code ^ next);
        code = next;
      }
      carried = code;
    }
    fill(e_.s, e_.f);
  }

  template <class Runs>
  void read_fast(const Runs& runs, std::uint32_t at) {
    const Divider line_of(e_.f);
    const Divider row_of(e_.m);
    const std::uint32_t lines = e_.m * e_.s;
    Code code = code_of_(runs.material(0));
    mark(0, 0, code);
    for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
      const Code next = code_of_(runs.material(i + 1));
      const Code change = code ^ next;
      code = next;
      // The first line whose voxel `at` lies behind the end of run i.
      const std::uint32_t line = line_of(runs.end(i) + e_.f - 1 - at);
      if (change == 0 || line >= lines) continue;
      const std::uint32_t row = row_of(line);
      mark(row, line - row * e_.m, change);
    }
    fill(e_.s, e_.m);
  }

  const OrderedExtent e_;
  Rows* const planes_;
  const unsigned count_;
  CodeOf code_of_;
};

}  // namespace runstone::rdm
