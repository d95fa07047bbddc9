// RangeAllocator: divides a row of elements into ranges, by best fit. Freed ranges join their free
// neighbours. It knows only numbers; the elements lie elsewhere, for example on the GPU. Cost:
// O(log free ranges) per call.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {

class RangeAllocator {
 public:
  /// Returns the first element of the smallest free range that holds `count` elements, or nullopt
  /// if there is none. Requires count > 0.
  std::optional<std::uint32_t> take(std::uint32_t count) {
    const auto fit = by_size_.lower_bound({count, 0});
    if (fit == by_size_.end()) return std::nullopt;
    const auto [size, first] = *fit;
    by_size_.erase(fit);
    free_.erase(first);
    if (size > count) insert(first + count, size - count);
    used_ += count;
    return first;
  }

  /// Gives back a range that take() returned, or a part of it.
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
  void insert(std::uint32_t first, std::uint32_t count) {
    free_.emplace(first, count);
    by_size_.emplace(count, first);
  }
  void add(std::uint32_t first, std::uint32_t count) {
    auto next = free_.lower_bound(first);
    if (next != free_.end() && first + count == next->first) {
      count += next->second;
      by_size_.erase({next->second, next->first});
      next = free_.erase(next);
    }
    if (next != free_.begin()) {
      const auto before = std::prev(next);
      if (before->first + before->second == first) {
        first = before->first;
        count += before->second;
        by_size_.erase({before->second, before->first});
        free_.erase(before);
      }
    }
    insert(first, count);
  }

  std::map<std::uint32_t, std::uint32_t> free_;  // size by first element; no two of them touch
  std::set<std::pair<std::uint32_t, std::uint32_t>> by_size_;  // size and first element of the same
  std::uint32_t capacity_ = 0, used_ = 0;
};

}  // namespace runstone
