// ChunkHashMap: a hash table by chunk key that grows in small steps. A single table of 200,000
// chunks takes 20 to 60 ms to grow, in which the world strand would do nothing else. So the keys
// are spread over 256 tables, each of which grows by itself in a fraction of a millisecond.
// Values keep their address until they are erased. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "server/interest/chunk_key_hash.hpp"

namespace runstone {

template <class Value>
class ChunkHashMap {
 public:
  /// Returns null if the key has no value.
  Value* find(const ChunkKey& key) {
    auto& part = part_of(key);
    const auto found = part.find(key);
    return found == part.end() ? nullptr : &found->second;
  }
  const Value* find(const ChunkKey& key) const {
    return const_cast<ChunkHashMap*>(this)->find(key);
  }
  bool contains(const ChunkKey& key) const { return find(key) != nullptr; }
  /// Returns the value of the key, which is made first if there is none.
  Value& operator[](const ChunkKey& key) { return part_of(key)[key]; }
  void erase(const ChunkKey& key) { part_of(key).erase(key); }

  /// Calls visit(key, value) for each key, in no particular order. Cost: O(keys).
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const auto& part : parts_) {
      for (const auto& [key, value] : part) visit(key, value);
    }
  }
  std::size_t size() const {
    std::size_t size = 0;
    for (const auto& part : parts_) size += part.size();
    return size;
  }

 private:
  using Part = std::unordered_map<ChunkKey, Value, ChunkKeyHash>;
  static constexpr std::size_t kParts = 256;
  // The tables use the low bits of the hash, so the part comes from the high ones.
  Part& part_of(const ChunkKey& key) {
    return parts_[static_cast<std::uint64_t>(ChunkKeyHash{}(key)) >> 56U];
  }

  std::array<Part, kParts> parts_;
};

}  // namespace runstone
