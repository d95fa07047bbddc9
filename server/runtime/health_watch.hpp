// HealthWatch: keeps what ServerHealth shows up to date: it measures the disk on a worker every few
// seconds, and notes when edits reach the disk. Thread: the world strand.
#pragma once
#include <asio/thread_pool.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "server/admin/server_health.hpp"
#include "server/runtime/disk_usage.hpp"
#include "server/runtime/durable_lag.hpp"
#include "server/runtime/periodic_task.hpp"
#include "server/runtime/world_strand.hpp"

namespace runstone {

class HealthWatch {
 public:
  /// `strand` and `workers` must outlive the object; the workers must have ended when it is
  /// destroyed. `place`: of the world.
  HealthWatch(WorldStrand& strand, asio::thread_pool& workers, std::string place);

  /// Measures the disk now and then. Thread: any.
  void start();
  void stop() { task_.stop(); }
  /// Notes how far the log and the disk have come. Call it after each task of the strand.
  void observe(Sequence head, Sequence durable, TimeUs now_us) {
    lag_.observe(head, durable, now_us);
  }
  /// `log_bytes`: of the log of edits, if they are known.
  ServerHealth health(std::optional<std::uint64_t> log_bytes) const;
  const WaitHistogram& durable_waits() const { return lag_.waits(); }

 private:
  /// Measures the disk on a worker, unless that is under way.
  void measure();

  WorldStrand& strand_;
  asio::thread_pool& workers_;
  const std::string place_;
  const TimeUs started_us_;  // of the steady clock
  bool is_measuring_ = false;
  DiskUsage usage_;  // as it was measured last
  DurableLag lag_;
  PeriodicTask task_;
};

}  // namespace runstone
