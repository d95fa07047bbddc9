// RangeAllocator: divides a row of elements into ranges, by first fit. Freed ranges join their free
// neighbours. It knows only numbers; the elements lie elsewhere, for example on the GPU.
#pragma once
#include <cstdint>
#include <map>
#include <optional>

#include "common/core/assert.hpp"

namespace runstone {

class RangeAllocator {
 public:
  /// Returns the first element of a free range of `count` elements, or nullopt if there is none.
  /// Requires count > 0. Cost: O(free ranges).
  std::optional<std::uint32_t> take(std::uint32_t count) {
    for (auto range = free_.begin(); range != free_.end(); ++range) {
      const auto [first, size] = *range;
      if (size < count) continue;
      free_.erase(range);
      if (size > count) free_.emplace(first + count, size - count);
      used_ += count;
      return first;
    }
    return std::nullopt;
  }

  /// Gives back a range that take() returned.
  void give_back(std::uint32_t first, std::uint32_t count) {
    RUNSTONE_ASSERT(used_ >= count);
    used_ -= count;
    add(first, count);
  }

  /// Appends free elements. Requires size > capacity().
  void grow(std::uint32_t size) {
    RUNSTONE_ASSERT(size > capacity_);
    add(capacity_, size - capacity_);
    capacity_ = size;
  }

  std::uint32_t capacity() const { return capacity_; }
  std::uint32_t used() const { return used_; }

 private:
  void add(std::uint32_t first, std::uint32_t count) {
    auto next = free_.lower_bound(first);
    if (next != free_.end() && first + count == next->first) {
      count += next->second;
      next = free_.erase(next);
    }
    if (next != free_.begin()) {
      const auto before = std::prev(next);
      if (before->first + before->second == first) {
        before->second += count;
        return;
      }
    }
    free_.emplace(first, count);
  }

  std::map<std::uint32_t, std::uint32_t> free_;  // size by first element; no two of them touch
  std::uint32_t capacity_ = 0, used_ = 0;
};

}  // namespace runstone
