// EnclosedLayers: the enclosed voxels of a chunk, layer by layer along its slowest axis, as rows of
// bits. A voxel is enclosed if it and its six neighbours are opaque. Internal to veil.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/assert.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/run_cursor.hpp"
#include "common/veil/veil_borders.hpp"

namespace runstone {

/// The opaque voxels of three layers, and the enclosed voxels of one layer. A row is a line.
template <class Row>
struct EnclosedScratch {
  std::array<std::vector<Row>, 3> opaque;  // layer s lies in opaque[s % 3]
  std::vector<Row> enclosed;
};

template <class Row, class Runs>
class EnclosedLayers {
 public:
  /// Begins at layer `first` of the slowest axis. Requires the borders of the chunk, and a scratch
  /// that nobody else uses as long as this object exists.
  EnclosedLayers(Runs runs, const OrderedExtent& extent, const VeilBorders& borders,
                 const VisibilityTable& covers, EnclosedScratch<Row>& scratch, std::uint32_t first)
      : cursor_(runs),
        e_(extent),
        borders_(borders),
        covers_(covers),
        scratch_(scratch),
        layer_(first) {
    scratch_.enclosed.resize(e_.m);
    if (first == 0) {
      read_border(false, layer_rows(2));
    } else {
      cursor_.seek((first - 1) * e_.layer());
      read(first - 1);
    }
    read(first);
  }

  /// Returns the enclosed voxels of the next layer, a row for each line, until the next call.
  /// Requires a layer that is left.
  std::span<const Row> next() {
    RUNSTONE_DASSERT(layer_ < e_.s);
    if (layer_ + 1 < e_.s) {
      read(layer_ + 1);
    } else {
      read_border(true, layer_rows(layer_ + 1));
    }
    const Row* const rows = layer_rows(layer_).data();
    const Row* const before = layer_rows(layer_ + 2).data();
    const Row* const after = layer_rows(layer_ + 1).data();
    // The bits of these two rows lie along the middle axis, which may be longer than a Row.
    const auto first_beyond = borders_.row<Row128>(0, false, layer_);
    const auto last_beyond = borders_.row<Row128>(0, true, layer_);
    Row below = borders_.row<Row>(1, false, layer_);
    for (std::uint32_t m = 0; m < e_.m; ++m) {
      const Row row = rows[m];
      const Row above = m + 1 < e_.m ? rows[m + 1] : borders_.row<Row>(1, true, layer_);
      const Row from_left = row << 1 | static_cast<Row>(first_beyond >> m & 1);
      const Row from_right = row >> 1 | static_cast<Row>(last_beyond >> m & 1) << (e_.f - 1);
      scratch_.enclosed[m] = row & from_left & from_right & below & above & before[m] & after[m];
      below = row;
    }
    ++layer_;
    return scratch_.enclosed;
  }

 private:
  std::vector<Row>& layer_rows(std::uint32_t layer) { return scratch_.opaque[layer % 3]; }

  void read_border(bool positive, std::vector<Row>& rows) {
    rows.resize(e_.m);
    for (std::uint32_t m = 0; m < e_.m; ++m) rows[m] = borders_.row<Row>(2, positive, m);
  }

  /// Reads a layer. The cursor's run reaches its first voxel.
  void read(std::uint32_t layer) {
    std::vector<Row>& rows = layer_rows(layer);
    rows.assign(e_.m, 0);
    const std::uint32_t first = layer * e_.layer(), end = first + e_.layer();
    for (std::uint32_t at = first; at < end;) {
      if (cursor_.end() == at) cursor_.next();
      const std::uint32_t last = std::min(cursor_.end(), end);
      if (covers_[cursor_.material()] == Visibility::opaque) mark(rows, at - first, last - first);
      at = last;
    }
  }

  void mark(std::vector<Row>& rows, std::uint32_t at, std::uint32_t last) {
    const std::uint32_t line = at / e_.f, last_line = last / e_.f;
    const unsigned from = at - line * e_.f, to = last - last_line * e_.f;
    if (line == last_line) {
      rows[line] |= bits_below<Row>(to) & ~bits_below<Row>(from);
      return;
    }
    rows[line] |= bits_below<Row>(e_.f) & ~bits_below<Row>(from);
    std::fill(rows.begin() + line + 1, rows.begin() + last_line, bits_below<Row>(e_.f));
    if (to != 0) rows[last_line] |= bits_below<Row>(to);
  }

  RunCursor<Runs> cursor_;
  const OrderedExtent e_;
  const VeilBorders& borders_;
  const VisibilityTable& covers_;
  EnclosedScratch<Row>& scratch_;
  std::uint32_t layer_;
};

}  // namespace runstone
