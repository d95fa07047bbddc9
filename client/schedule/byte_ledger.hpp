// ByteLedger: how many bytes each of several things takes, and their sum. One thread. Cost: O(log
// entries).
#pragma once
#include <cstddef>
#include <map>

namespace runstone {

template <class Key>
class ByteLedger {
 public:
  /// Replaces the entry of `key`.
  void set(const Key& key, std::size_t bytes) {
    std::size_t& entry = entries_[key];
    total_ = total_ - entry + bytes;
    entry = bytes;
  }
  /// Removes the entry of `key`, if there is one.
  void erase(const Key& key) {
    const auto entry = entries_.find(key);
    if (entry == entries_.end()) return;
    total_ -= entry->second;
    entries_.erase(entry);
  }
  void clear() {
    entries_.clear();
    total_ = 0;
  }
  std::size_t total() const { return total_; }

 private:
  std::map<Key, std::size_t> entries_;
  std::size_t total_ = 0;
};

}  // namespace runstone
