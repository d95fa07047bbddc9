// Standby: a server of a world that another server owns. It follows the owner and serves players, and
// takes the world over when the owner has ended or does not answer.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "common/core/result.hpp"
#include "server/app/server.hpp"
#include "server/store/postgres_lease.hpp"

namespace runstone {

using StartServer = std::function<Result<std::unique_ptr<Server>, std::string>()>;

/// Starts the server by `start` if nobody has owned the world for a second, and by `follow` if another
/// server owns it. Waits while the owner cannot be followed yet, and while the database does not
/// answer. `stops_within` waits, and returns true if the program has to stop meanwhile. Returns null
/// then. Fails if `start` fails although nobody owns the world. Requires start_logging(), and that
/// `place` is a database.
Result<std::unique_ptr<Server>, std::string> start_as_standby(
    const std::string& place, const std::function<bool(std::chrono::milliseconds)>& stops_within,
    const StartServer& start, const StartServer& follow);

/// Watches the lease of the world for a server that follows: tells it where the owner is, and lets it
/// take the world over when nobody has the lease. Has a thread of its own, which ends when the server
/// owns the world.
class TakeoverWatch {
 public:
  /// `server` must outlive the object. `on_failure` is called at most once, from the thread, if the
  /// server can neither follow nor own the world any more.
  TakeoverWatch(const std::string& place, Server& server, std::function<void()> on_failure);
  /// Ends the thread. Waits for a takeover that is under way.
  ~TakeoverWatch();
  /// Returns true if `on_failure` was called. Thread: any.
  bool has_failed() const { return has_failed_.load(); }
  TakeoverWatch(const TakeoverWatch&) = delete;
  TakeoverWatch& operator=(const TakeoverWatch&) = delete;

 private:
  void run();
  /// Looks once. Returns false if there is nothing more to watch.
  bool look();
  void fail(const std::string& why);

  LeaseWatch lease_;
  Server& server_;
  const std::function<void()> on_failure_;
  std::atomic<bool> has_failed_{false};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool is_stopping_ = false;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace runstone
