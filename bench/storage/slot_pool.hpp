// SlotPool: records in one vector, named by their slot; free slots are used again. It is the pool
// of a plain octree.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "bench/storage/heap_bytes.hpp"

namespace runstone::bench::storage {

template <class Record>
class SlotPool {
 public:
  static constexpr bool kShares = false;

  const Record& operator[](std::uint32_t slot) const { return records_[slot]; }
  /// Adds a record. Returns its slot, and true because the record is new.
  std::pair<std::uint32_t, bool> add(const Record& record) {
    if (free_.empty()) {
      records_.push_back(record);
      return {static_cast<std::uint32_t>(records_.size() - 1), true};
    }
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    records_[slot] = record;
    return {slot, true};
  }
  /// Frees a record. Always returns true.
  bool release(std::uint32_t slot) {
    free_.push_back(slot);
    return true;
  }
  void shrink_to_fit() { records_.shrink_to_fit(); }
  std::size_t count() const { return records_.size() - free_.size(); }
  std::size_t heap_size() const {
    return heap_bytes(records_.capacity() * sizeof(Record)) +
           heap_bytes(free_.capacity() * sizeof(std::uint32_t));
  }

 private:
  std::vector<Record> records_;
  std::vector<std::uint32_t> free_;
};

}  // namespace runstone::bench::storage
