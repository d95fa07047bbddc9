// WriterAnswer: the answer of the log writer to one job, for a thread that waits for it. Share it with
// the writer (std::shared_ptr), which may still be in set() when wait() has returned.
// Threads: set() one, wait() another.
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "server/store/store_error.hpp"

namespace runstone {

template <class T>
class WriterAnswer {
 public:
  /// Call it once.
  void set(StoreResult<T> result) {
    const std::lock_guard guard(mutex_);
    result_ = std::move(result);
    arrived_.notify_one();
  }
  /// Waits for set(), and returns its result. Call it once.
  StoreResult<T> wait() {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [this] { return result_.has_value(); });
    return *std::move(result_);
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::optional<StoreResult<T>> result_;
};

}  // namespace runstone
