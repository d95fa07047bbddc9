// Recent: values of a pure function that were computed lately. A value depends on its key alone, so
// results do not depend on which values are kept. A key has the function hash_of(key), which returns
// 64 bits. Thread: any.
#pragma once
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace runstone {

template <class Key, class Value>
class Recent {
 public:
  /// Keeps at most `places` values. Requires 0 < places.
  explicit Recent(std::size_t places) : slots_(places) {}

  /// Returns the value of the key, which make() computes if it is not kept. Two threads may compute
  /// it at the same time. Cost: O(1), and that of make() if the value is not kept.
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

}  // namespace runstone
