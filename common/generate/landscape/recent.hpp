// Recent: values of a pure function that were computed lately. A value depends on its key alone, so
// results do not depend on which values are kept.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/hash.hpp"

namespace runstone {

template <class Key, class Value>
class Recent {
 public:
  /// Keeps at most `places` values. Requires 0 < places.
  explicit Recent(std::size_t places) : slots_(places) {}

  /// Returns the value of the key, which make() computes if it is not kept. Two threads may compute
  /// it at the same time. Thread: any.
  template <class Make>
  std::shared_ptr<const Value> get(const Key& key, Make&& make) {
    Slot& slot = slots_[static_cast<std::size_t>(hash_of(key) % slots_.size())];
    {
      const std::lock_guard lock(mutex_);
      if (slot.value && slot.key == key) return slot.value;
    }
    auto made = std::make_shared<const Value>(make());
    std::shared_ptr<const Value> old = made;  // freed after the mutex is released
    const std::lock_guard lock(mutex_);
    slot.key = key;
    slot.value.swap(old);
    return made;
  }

 private:
  struct Slot {
    Key key{};
    std::shared_ptr<const Value> value;
  };
  std::mutex mutex_;  // guards the slots; a leaf
  std::vector<Slot> slots_;
};

/// A square of the ground, by its number along x and z.
struct SquareKey {
  std::int32_t x = 0, z = 0;
  friend bool operator==(const SquareKey&, const SquareKey&) = default;
};
constexpr std::uint64_t hash_of(const SquareKey& key) { return place_hash(0, key.x, key.z); }

}  // namespace runstone
