// FlatQueue: a queue in one vector. A short queue keeps its memory when it becomes empty, so that
// filling and emptying it again and again allocates nothing. A long one gives it back.
#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace runstone {

template <class T>
class FlatQueue {
 public:
  bool empty() const { return size() == 0; }
  std::size_t size() const { return items_.size() - first_; }
  T& front() { return items_[first_]; }
  const T& front() const { return items_[first_]; }
  auto begin() { return items_.begin() + static_cast<std::ptrdiff_t>(first_); }
  auto end() { return items_.end(); }
  auto begin() const { return items_.begin() + static_cast<std::ptrdiff_t>(first_); }
  auto end() const { return items_.end(); }

  void push_back(T item) { items_.push_back(std::move(item)); }
  /// Cost: O(1) behind a pop_front(), else O(items).
  void push_front(T item) {
    if (first_ == 0) {
      items_.insert(items_.begin(), std::move(item));
    } else {
      items_[--first_] = std::move(item);
    }
  }
  /// Cost: O(1), amortised.
  void pop_front() {
    items_[first_++] = T{};
    if (empty()) {
      clear();
    } else if (first_ >= kKept && first_ >= size()) {
      items_.erase(items_.begin(), begin());
      first_ = 0;
    }
  }
  void clear() {
    items_.clear();
    first_ = 0;
    if (items_.capacity() > kKept) items_ = {};
  }
  template <class Goes>
  void remove_if(Goes&& goes) {
    items_.erase(std::remove_if(begin(), end(), goes), items_.end());
    if (empty()) clear();
  }

 private:
  static constexpr std::size_t kKept = 16;
  std::vector<T> items_;
  std::size_t first_ = 0;  // those before it have been taken
};

}  // namespace runstone
