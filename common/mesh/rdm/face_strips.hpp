// Three ways in which exposed faces become quads, one per axis of the chunk's order. Each takes the faces of
// one direction in ascending index order and holds its strips in a StripTable:
//   LayerStrips   faces across the slowest axis, and of any border layer: rows of a layer come one after
//   another LineStrips    faces across the middle axis: the rows of all its layers come interleaved, one set
//   per slow layer CrossStrips   faces across the fastest axis: single faces, joined first over lines, then
//   over slow layers
// Faces that touch in index order and agree in material arrive as one strip even where the material they look
// at changes, so a strip is as long as it can be.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/divider.hpp"
#include "common/mesh/rdm/quad_bins.hpp"
#include "common/mesh/rdm/strip_table.hpp"

namespace runstone::rdm {

/// Where finished strips go: bins for the quads, and the pass each material is drawn in.
struct QuadSink {
  QuadBins& bins;
  const VisibilityTable& visibility;
  void put(const QuadShape& shape, std::uint32_t layer, std::uint32_t begin, const Strip& strip) const {
    bins.put(shape.quad(layer, begin, strip), visibility[strip.material]);
  }
};

constexpr std::uint8_t as_u8(std::uint32_t v) { return static_cast<std::uint8_t>(v); }

/// Joins stretches of faces that touch and agree in material; `Self::split(begin, end, material)` gets the
/// rest.
template <class Self>
class JoinedFaces {
 public:
  /// Faces of voxels [begin, end). Requires begin not before the last end.
  void add(std::uint32_t begin, std::uint32_t end, Material material) {
    if (begin == end_ && material == material_) {
      end_ = end;
      return;
    }
    hand_on();
    begin_ = begin;
    end_ = end;
    material_ = material;
  }

 protected:
  void hand_on() {
    if (begin_ < end_) static_cast<Self*>(this)->split(begin_, end_, material_);
    begin_ = end_ = 0;
  }

 private:
  std::uint32_t begin_ = 0;
  std::uint32_t end_ = 0;
  Material material_ = kEmpty;
};

/// Layers of `rows` rows of `row_length` voxels, flattened one after another; index 0 is in layer
/// `first_layer`.
class LayerStrips : public JoinedFaces<LayerStrips> {
 public:
  LayerStrips(const QuadShape& shape, std::uint32_t row_length, std::uint32_t rows, std::uint32_t first_layer,
              StripTable& table, QuadSink sink)
      : shape_(shape),
        row_length_(row_length),
        rows_(rows),
        layer_(first_layer),
        first_layer_(first_layer),
        row_of_(row_length),
        layer_of_(rows),
        table_(table),
        sink_(sink) {
    table_.require(row_length);
  }
  void finish() {
    hand_on();
    flush_layer();
  }

 private:
  friend JoinedFaces<LayerStrips>;
  void split(std::uint32_t begin, std::uint32_t end, Material material) {
    std::uint32_t line = row_of_(begin);
    std::uint32_t from = begin - line * row_length_;
    while (begin < end) {
      const std::uint32_t slice = layer_of_(line);
      if (first_layer_ + slice != layer_) {
        flush_layer();
        layer_ = first_layer_ + slice;
      }
      const std::uint32_t row = line - slice * rows_;
      // Whole rows go as one block, so that a full layer costs one step.
      const bool whole = from == 0 && end - begin >= row_length_;
      const std::uint32_t count = whole ? std::min((end - begin) / row_length_, rows_ - row) : 1;
      const std::uint32_t length = std::min(row_length_ - from, end - begin);
      table_.add(
          from, {as_u8(from + length), as_u8(row), as_u8(row + count), material},
          [this](std::uint32_t place, const Strip& strip) { sink_.put(shape_, layer_, place, strip); });
      begin += length + (count - 1) * row_length_;
      line += count;
      from = 0;
    }
  }
  void flush_layer() {
    table_.flush_all(
        [this](std::uint32_t place, const Strip& strip) { sink_.put(shape_, layer_, place, strip); });
  }

  QuadShape shape_;
  std::uint32_t row_length_, rows_, layer_, first_layer_;
  Divider row_of_, layer_of_;
  StripTable& table_;
  QuadSink sink_;
};

/// Voxels of a chunk with lines of `line_length` and `lines` lines a slow layer. Faces of line `skip` of each
/// slow layer are dropped: they lie at the border, where the sweep has paired them with a line of another
/// layer.
class LineStrips : public JoinedFaces<LineStrips> {
 public:
  LineStrips(const QuadShape& shape, std::uint32_t line_length, std::uint32_t lines, std::uint32_t skip,
             StripTable& table, QuadSink sink)
      : shape_(shape),
        line_length_(line_length),
        lines_(lines),
        skip_(skip),
        line_of_(line_length),
        slice_of_(lines),
        table_(table),
        sink_(sink) {
    table_.require(std::size_t{line_length} * lines);
  }
  void finish() {
    hand_on();
    table_.flush_all([this](std::uint32_t place, const Strip& strip) { put(place, strip); });
  }

 private:
  friend JoinedFaces<LineStrips>;
  void split(std::uint32_t begin, std::uint32_t end, Material material) {
    std::uint32_t line = line_of_(begin);
    std::uint32_t from = begin - line * line_length_;
    for (; begin < end; ++line, from = 0) {
      const std::uint32_t length = std::min(line_length_ - from, end - begin);
      const std::uint32_t slice = slice_of_(line);
      const std::uint32_t layer = line - slice * lines_;
      begin += length;
      if (layer == skip_) continue;
      table_.add(layer * line_length_ + from,
                 {as_u8(from + length), as_u8(slice), as_u8(slice + 1), material},
                 [this](std::uint32_t place, const Strip& strip) { put(place, strip); });
    }
  }
  void put(std::uint32_t place, const Strip& strip) const {
    const std::uint32_t layer = line_of_(place);
    sink_.put(shape_, layer, place - layer * line_length_, strip);
  }

  QuadShape shape_;
  std::uint32_t line_length_, lines_, skip_;
  Divider line_of_, slice_of_;
  StripTable& table_;
  QuadSink sink_;
};

/// Single faces on lines of `line_length` voxels, `lines` lines a slow layer. Strips run along the middle
/// axis.
class CrossStrips {
 public:
  CrossStrips(const QuadShape& shape, std::uint32_t line_length, std::uint32_t lines, StripTable& table,
              QuadSink sink)
      : shape_(shape),
        line_length_(line_length),
        lines_(lines),
        slice_of_(lines + 1),
        table_(table),
        sink_(sink) {
    table_.require(std::size_t{line_length} * lines);
  }

  /// The face of voxel `f` of line `line`, the `middle`-th of slow layer `slice`. Requires ascending lines.
  void add(std::uint32_t f, std::uint32_t middle, std::uint32_t slice, Material material) {
    RUNSTONE_DASSERT(f < line_length_);
    // Slow layers are one number apart here, so that a strip cannot go on from one into the next.
    const std::uint32_t line = slice * (lines_ + 1) + middle;
    Column& column = columns_[f];
    if (column.line_end == line && column.material == material) {
      ++column.line_end;
      return;
    }
    if (column.line_end != 0) hand_on(f, column);
    column = {static_cast<std::uint16_t>(line), static_cast<std::uint16_t>(line + 1), material};
  }
  void finish() {
    for (std::uint32_t f = 0; f < line_length_; ++f) {
      if (columns_[f].line_end != 0) hand_on(f, columns_[f]);
    }
    table_.flush_all([this](std::uint32_t place, const Strip& strip) { put(place, strip); });
  }

 private:
  /// Equal faces at one place of consecutive lines.
  struct Column {
    std::uint16_t line_first = 0;  // lines are counted with the gap described above: up to 128 * 129 + 127
    std::uint16_t line_end = 0;    // 0: none
    Material material = kEmpty;
  };
  void hand_on(std::uint32_t f, const Column& column) {
    const std::uint32_t slice = slice_of_(column.line_first);
    const std::uint32_t begin = column.line_first - slice * (lines_ + 1);
    const std::uint32_t end = column.line_end - slice * (lines_ + 1);
    table_.add(f * lines_ + begin, {as_u8(end), as_u8(slice), as_u8(slice + 1), column.material},
               [this](std::uint32_t place, const Strip& strip) { put(place, strip); });
  }
  void put(std::uint32_t place, const Strip& strip) const {
    const std::uint32_t layer = place / lines_;
    sink_.put(shape_, layer, place - layer * lines_, strip);
  }

  QuadShape shape_;
  std::uint32_t line_length_, lines_;
  Divider slice_of_;
  std::array<Column, kSideMax> columns_{};
  StripTable& table_;
  QuadSink sink_;
};

}  // namespace runstone::rdm
