// SharedPool: as SlotPool, but equal records are kept once. A hash table, whose chains run through
// the records, finds them. References are counted, and a record without references is freed. It is
// the pool of a DAG. Source: hash-consing as in Careil, Billeter, Eisemann, "Interactively
// Modifying Compressed Sparse Voxel Representations" (2020).
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "bench/storage/heap_bytes.hpp"
#include "common/core/hash.hpp"

namespace runstone::bench::storage {

/// Record must be plain bytes without padding. Its size must be a multiple of eight.
template <class Record>
class SharedPool {
 public:
  static constexpr bool kShares = true;

  SharedPool() : chains_(kChainsMin, kNone) {}

  const Record& operator[](std::uint32_t slot) const { return slots_[slot].record; }
  /// Adds a reference to a record. Returns its slot, and whether the record is new.
  std::pair<std::uint32_t, bool> add(const Record& record) {
    std::uint32_t chain = chain_of(record);
    for (std::uint32_t at = chains_[chain]; at != kNone; at = slots_[at].next) {
      if (slots_[at].record != record) continue;
      ++slots_[at].references;
      return {at, false};
    }
    if (count_ == chains_.size()) {
      rehash(2 * chains_.size());
      chain = chain_of(record);
    }
    std::uint32_t slot = free_;
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(slots_.size());
      slots_.emplace_back();
    } else {
      free_ = slots_[slot].next;
    }
    slots_[slot] = {record, 1, chains_[chain]};
    chains_[chain] = slot;
    ++count_;
    return {slot, true};
  }
  /// Adds a reference.
  void share(std::uint32_t slot) { ++slots_[slot].references; }
  /// Removes a reference. Returns true if it was the last one and the record is freed.
  bool release(std::uint32_t slot) {
    if (--slots_[slot].references > 0) return false;
    std::uint32_t* link = &chains_[chain_of(slots_[slot].record)];
    while (*link != slot) link = &slots_[*link].next;
    *link = slots_[slot].next;
    slots_[slot].next = free_;
    free_ = slot;
    --count_;
    return true;
  }
  void shrink_to_fit() {
    slots_.shrink_to_fit();
    const std::size_t wanted = std::max(std::bit_ceil(count_), kChainsMin);
    if (wanted < chains_.size()) rehash(wanted);
  }
  std::size_t count() const { return count_; }
  std::size_t heap_size() const {
    return heap_bytes(slots_.capacity() * sizeof(Slot)) +
           heap_bytes(chains_.capacity() * sizeof(std::uint32_t));
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  static constexpr std::size_t kChainsMin = 4;
  struct Slot {
    Record record{};
    std::uint32_t references = 0;
    std::uint32_t next = kNone;  // in its chain, or in the list of free slots
  };

  std::uint32_t chain_of(const Record& record) const {
    static_assert(sizeof(Record) % 8 == 0);
    std::uint64_t words[sizeof(Record) / 8];
    std::memcpy(words, &record, sizeof words);
    std::uint64_t hash = 0;
    for (const std::uint64_t word : words) hash = mix64(hash ^ word);
    return static_cast<std::uint32_t>(hash & (chains_.size() - 1));
  }

  void rehash(std::size_t chains) {
    const std::vector<std::uint32_t> old = std::exchange(chains_, std::vector(chains, kNone));
    for (std::uint32_t at : old) {
      while (at != kNone) {
        std::uint32_t& chain = chains_[chain_of(slots_[at].record)];
        const std::uint32_t next = std::exchange(slots_[at].next, chain);
        chain = at;
        at = next;
      }
    }
  }

  std::vector<Slot> slots_;
  std::vector<std::uint32_t> chains_;  // by hash: the first slot of each; a power of two
  std::uint32_t free_ = kNone;
  std::size_t count_ = 0;
};

}  // namespace runstone::bench::storage
