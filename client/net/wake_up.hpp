// WakeUp: lets other threads wake the main thread. A notify() before wait() is not lost. Thread:
// any for notify(), one for wait().
#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace runstone {

class WakeUp {
 public:
  void notify() {
    {
      const std::lock_guard lock(mutex_);
      pending_ = true;
    }
    condition_.notify_one();
  }
  /// Returns at once if notify() was called since the last wait(), otherwise at the next notify()
  /// or after `longest`.
  void wait(std::chrono::microseconds longest) {
    std::unique_lock lock(mutex_);
    condition_.wait_for(lock, longest, [this] { return pending_; });
    pending_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable condition_;
  bool pending_ = false;  // guarded by mutex_
};

}  // namespace runstone
