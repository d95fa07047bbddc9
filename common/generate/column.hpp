// Column: the materials of one vertical line of the world, painted interval by interval. A later
// interval replaces earlier ones. A column holds a few spans, never a voxel buffer.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {

class Column {
 public:
  struct Span {
    std::int32_t end;  // one past; the span begins where the previous one ends
    Material material;
  };

  /// Empties the column and sets its bounds. Requires y_min < y_max.
  void reset(std::int32_t y_min, std::int32_t y_max) {
    y_min_ = y_min;
    spans_.assign(1, {y_max, kEmpty});
  }

  /// Sets [from, to), clipped to the bounds, to `material`. Cost: O(spans).
  void paint(std::int32_t from, std::int32_t to, Material material) {
    from = std::max(from, y_min_);
    to = std::min(to, spans_.back().end);
    if (from >= to) return;
    if (from == y_min_) return paint_bottom(to, material);
    next_.clear();
    std::int32_t begin = y_min_;
    bool painted = false;
    for (const Span& span : spans_) {
      if (begin < from) push(std::min(span.end, from), span.material);
      if (!painted && span.end >= to) {
        push(to, material);
        painted = true;
      }
      if (span.end > to) push(span.end, span.material);
      begin = span.end;
    }
    spans_.swap(next_);
  }

  /// Sets the empty voxels of [y_min, to) to `material`.
  void flood(std::int32_t to, Material material) {
    // Most columns of a landscape have no empty voxel below the sea.
    std::int32_t begin = y_min_;
    bool dry = true;
    for (std::size_t i = 0; dry && i < spans_.size() && begin < to; begin = spans_[i++].end) {
      dry = spans_[i].material != kEmpty;
    }
    if (dry) return;
    begin = y_min_;
    next_.clear();
    for (const Span& span : spans_) {
      if (span.material == kEmpty && begin < to) {
        push(std::min(span.end, to), material);
      }
      if (span.material != kEmpty || span.end > to) push(span.end, span.material);
      begin = span.end;
    }
    spans_.swap(next_);
  }

  /// Returns the highest non-empty voxel + 1, or y_min if there is none.
  std::int32_t top() const {
    for (std::size_t i = spans_.size(); i-- > 0;) {
      if (spans_[i].material != kEmpty) return spans_[i].end;
    }
    return y_min_;
  }

  /// Returns the material at height y, or kEmpty out of bounds. Cost: O(spans).
  Material at(std::int32_t y) const {
    if (y < y_min_) return kEmpty;
    for (const Span& span : spans_) {
      if (y < span.end) return span.material;
    }
    return kEmpty;
  }

  /// Appends the `count` voxels from y = `from` upwards. Voxels out of bounds are empty.
  void emit(std::int32_t from, std::uint32_t count, RunBuilder& out) const {
    const std::int32_t to = from + static_cast<std::int32_t>(count);
    std::int32_t at = from;
    const auto until = [&](std::int32_t end, Material material) {
      end = std::min(end, to);
      if (end <= at) return;
      out.append(static_cast<std::uint32_t>(end - at), material);
      at = end;
    };
    until(y_min_, kEmpty);
    for (const Span& span : spans_) until(span.end, span.material);
    until(to, kEmpty);
  }

  /// Appends `count` rows from y = `from` upwards, each 2^level voxels high. A row has the material
  /// of its highest non-empty voxel, so a surface keeps its material. A row with voxels of `liquid`
  /// above others has the material of the others: the ground below shallow water has more faces
  /// that are drawn.
  void emit_coarse(std::int32_t from, std::uint32_t count, std::uint8_t level, Material liquid,
                   RunBuilder& out) const {
    std::int32_t row = 0;  // the first that is not appended
    const auto until = [&](std::int32_t end, Material material) {
      end = std::min(end, static_cast<std::int32_t>(count));
      if (end <= row) return;
      out.append(static_cast<std::uint32_t>(end - row), material);
      row = end;
    };
    Span below{0, kEmpty};  // the span before, in rows
    std::int32_t begin = y_min_;
    for (const Span& span : spans_) {
      if (span.material != kEmpty) {
        const std::int32_t first = (begin - from) >> level;
        const bool covers = span.material != liquid;
        until(covers ? std::min(below.end, first) : below.end, below.material);
        until(first, kEmpty);
        below = {((span.end - from - 1) >> level) + 1, span.material};
      }
      begin = span.end;
    }
    until(below.end, below.material);
    until(static_cast<std::int32_t>(count), kEmpty);
  }

 private:
  /// Paints as paint() an interval that begins at the lowest voxel, as nearly every
  /// layer of terrain does. It removes the covered spans in place.
  void paint_bottom(std::int32_t to, Material material) {
    std::size_t covered = 0;  // spans that end at or below `to`
    while (covered < spans_.size() && spans_[covered].end <= to) ++covered;
    if (covered < spans_.size() && spans_[covered].material == material) {
      spans_.erase(spans_.begin(), spans_.begin() + static_cast<std::ptrdiff_t>(covered));
    } else if (covered == 0) {
      spans_.insert(spans_.begin(), {to, material});
    } else {
      spans_.erase(spans_.begin(), spans_.begin() + static_cast<std::ptrdiff_t>(covered - 1));
      spans_.front() = {to, material};
    }
  }

  /// Appends to the new list. Empty spans vanish and equal neighbours merge.
  void push(std::int32_t end, Material material) {
    if (!next_.empty() && end <= next_.back().end) return;
    if (next_.empty() && end <= y_min_) return;
    if (!next_.empty() && next_.back().material == material) {
      next_.back().end = end;
    } else {
      next_.push_back({end, material});
    }
  }

  std::int32_t y_min_ = 0;
  std::vector<Span> spans_, next_;
};

}  // namespace runstone
