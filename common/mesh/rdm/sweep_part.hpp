// SweepPart: the part of a chunk that a layer sweep traces: all of it, or the part that an edit
// touched. Internal to rdm.
#pragma once
#include <array>
#include <cstdint>

#include "common/mesh/rdm/sweep_input.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/bit_row.hpp"

namespace runstone::rdm {

/// The sweep traces the strips that end or begin in layer `begin`, in layer `end`, or between them.
/// It begins with the strips that reach layer `begin`, and leaves those open that reach beyond
/// layer `end`.
template <class Row>
struct SweepPart {
  std::uint32_t begin = 0, end = 0;  // layers of the slowest axis
  /// The layers of the middle and the fast sides to trace, by Side. The slow sides are traced in
  /// all of the layers above.
  std::array<Row, 6> traced{};

  static SweepPart whole(const OrderedExtent& e) {
    const Row middle = bits_below<Row>(e.m), fast = bits_below<Row>(e.f);
    return {0, e.s, {middle, middle, middle, middle, fast, fast}};
  }
  friend bool operator==(const SweepPart&, const SweepPart&) = default;
  /// Returns the first layer that the sweep reads: the one before `begin`, if there is one.
  std::uint32_t first_read() const { return begin == 0 ? 0 : begin - 1; }
  /// Returns the end of the layers that the sweep reads.
  std::uint32_t read_end(const OrderedExtent& e) const { return end == e.s ? e.s : end + 1; }
};

}  // namespace runstone::rdm
