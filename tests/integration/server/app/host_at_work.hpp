// HostAtWork: a host works at a running server in three threads until it dies: changes of rights,
// materials and names, rollbacks, and backups are under way at the same time.
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "tests/integration/server/app/griefer_rollbacks.hpp"
#include "tests/integration/server/app/host_changes.hpp"
#include "tests/integration/server/app/live_backups.hpp"

namespace runstone::test {

class HostAtWork {
 public:
  /// Starts the threads. `backups` may be null. All must outlive the object.
  HostAtWork(std::uint16_t port, HostChanges& changes, GrieferRollbacks& rollbacks,
             LiveBackups* backups) {
    threads_.emplace_back([=, this, &changes] { changes.work(port, is_over_); });
    threads_.emplace_back([=, this, &rollbacks] { rollbacks.work(port, is_over_); });
    if (backups != nullptr) threads_.emplace_back([=, this] { backups->work(is_over_); });
  }
  /// Waits until what is under way has its answer, or the server's end.
  ~HostAtWork() {
    is_over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  HostAtWork(const HostAtWork&) = delete;
  HostAtWork& operator=(const HostAtWork&) = delete;

 private:
  std::atomic<bool> is_over_{false};
  std::vector<std::thread> threads_;
};

}  // namespace runstone::test
