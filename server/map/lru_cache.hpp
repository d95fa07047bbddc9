// LruCache: values by key, up to a number of bytes. If the cache is full, the values that were used
// least recently are removed.
#pragma once
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace runstone {

template <class Key, class Value>
class LruCache {
 public:
  using Pointer = std::shared_ptr<const Value>;

  explicit LruCache(std::size_t bytes_max) : bytes_max_(bytes_max) {}

  /// Returns the value, which becomes the one that was used last, or null.
  Pointer find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return nullptr;
    used_.splice(used_.begin(), used_, found->second);
    return found->second->value;
  }
  /// Adds a value of so many bytes, or replaces the one of its key. A value that is larger than the
  /// cache is not kept.
  void put(const Key& key, Pointer value, std::size_t bytes) {
    const std::size_t all = bytes + kEntryBytes;
    const std::lock_guard lock(mutex_);
    if (const auto found = by_key_.find(key); found != by_key_.end()) remove(found->second);
    if (all > bytes_max_) return;
    used_.push_front({key, std::move(value), all});
    by_key_[key] = used_.begin();
    bytes_ += all;
    while (bytes_ > bytes_max_) remove(std::prev(used_.end()));
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    used_.clear();
    by_key_.clear();
    bytes_ = 0;
  }
  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }

 private:
  struct Entry {
    Key key;
    Pointer value;
    std::size_t bytes = 0;
  };
  using Entries = std::list<Entry>;
  static constexpr std::size_t kEntryBytes = 2 * sizeof(Key) + 128;  // about

  void remove(typename Entries::iterator entry) {
    bytes_ -= entry->bytes;
    by_key_.erase(entry->key);
    used_.erase(entry);
  }

  const std::size_t bytes_max_;
  mutable std::mutex mutex_;
  Entries used_;  // the one that was used last comes first
  std::map<Key, typename Entries::iterator> by_key_;
  std::size_t bytes_ = 0;
};

}  // namespace runstone
