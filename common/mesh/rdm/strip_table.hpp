// StripTable: joins strips of one direction that repeat row after row into rectangles.
// A strip waits in the slot of its place until the next strip at that place shows whether it goes on (same
// end, same material, next row): then it grows, otherwise it is flushed and replaced. Nothing is flushed
// early, so no row has to be compared with the row before it as a whole. A table is one chunk layer of slots
// at most; between uses every slot is closed.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone::rdm {

struct Strip {
  std::uint8_t end = 0;        // one past its last voxel along the strip; 0: the slot is closed
  std::uint8_t row_first = 0;  // rows [row_first, row_end)
  std::uint8_t row_end = 0;
  Material material = kEmpty;
};

class StripTable {
 public:
  /// Makes room for places 0 .. places - 1.
  void require(std::size_t places) {
    if (slots_.size() < places) slots_.resize(places);
  }

  /// Adds a strip (or a block of equal ones) at `place`. Rows at one place must not descend.
  /// Calls flush(place, strip) for a strip that ends here. O(1).
  template <class Flush>
  void add(std::uint32_t place, const Strip& strip, Flush&& flush) {
    Strip& slot = slots_[place];
    if (slot.row_end == strip.row_first && slot.end == strip.end && slot.material == strip.material) {
      slot.row_end = strip.row_end;
      return;
    }
    if (slot.end == 0) {
      open_.push_back(place);
    } else {
      flush(place, slot);
    }
    slot = strip;
  }

  /// Flushes every open strip, by the order in which the places were opened, and closes them. O(open places).
  template <class Flush>
  void flush_all(Flush&& flush) {
    for (const std::uint32_t place : open_) {
      flush(place, slots_[place]);
      slots_[place] = Strip{};
    }
    open_.clear();
  }

 private:
  std::vector<Strip> slots_;
  std::vector<std::uint32_t> open_;
};

}  // namespace runstone::rdm
