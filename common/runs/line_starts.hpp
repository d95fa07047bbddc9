// LineStarts: the segments of each line of a chunk along any axis order, read from its runs. It
// uses no dense grid. A line along another axis gets a start where a voxel differs from its
// predecessor along that axis. Two cursors over the runs, one a line or a layer behind the other,
// find each such place and skip equal stretches.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// A segment of a line: it reaches from `at` to the next start or the end of the line.
struct LineStart {
  std::uint16_t at = 0;
  Material material = kEmpty;
};

class LineStarts {
 public:
  /// Reads a chunk in the axis order `order`, and replaces what was read before. Requires a valid
  /// chunk. Cost: O(runs + lines + starts). Memory: 12 bytes a start and 4 bytes a line, which
  /// later calls reuse.
  void read(const RunChunk& chunk, AxisOrder order);

  /// Returns the starts of one line, in ascending order. The first one is 0, and neighbours differ
  /// in material. Lines are numbered m + s * e.m along the middle and slowest axis of the order.
  std::span<const LineStart> line(std::size_t line) const { return lines(line, 1); }
  /// Returns the starts of lines [first, first + count) one after another.
  std::span<const LineStart> lines(std::size_t first, std::size_t count) const {
    const std::size_t begin = first == 0 ? 0 : ends_[first - 1];
    return all().subspan(begin, ends_[first + count - 1] - begin);
  }
  std::span<const LineStart> all() const { return starts_; }

 private:
  struct Unsorted {
    std::uint32_t line;
    LineStart start;
  };
  std::vector<std::uint32_t> ends_;  // of the lines, in starts_
  std::vector<LineStart> starts_;
  std::vector<Unsorted> unsorted_;  // scratch; its size is its capacity
};

}  // namespace runstone
