// Standby: a server of a world that another server owns. It follows the owner and serves players,
// and takes the world over when the owner has ended or does not answer.
#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/core/result.hpp"
#include "server/app/server.hpp"
#include "server/store/postgres_lease.hpp"

namespace runstone {

using StartServer = std::function<Result<std::unique_ptr<Server>, std::string>()>;

/// Starts the server by `start` if nobody has owned the world for a second, and by `follow` if
/// another server owns it. Waits while the owner cannot be followed yet, and while the database
/// does not answer. `stops_within` waits, and returns true if the program has to stop meanwhile.
/// Returns null then. Fails if `start` fails again and again for some seconds although nobody owns
/// the world. Requires start_logging(), and that `place` is a database.
Result<std::unique_ptr<Server>, std::string> start_as_standby(
    const std::string& place, const std::function<bool(std::chrono::milliseconds)>& stops_within,
    const StartServer& start, const StartServer& follow);

/// Watches the lease of the world for a server that follows: tells it where the owner is, and lets
/// it take the world over when nobody has the lease. Has a thread of its own, which ends when the
/// server owns the world.
/// An owner that hands the world over releases the lease for one server, which it has chosen. So
/// the others leave a free lease alone for a second at most: those that still hear the owner, and
/// the owner itself. So does a server that has not followed the last owner, because others may have
/// edits that it lacks.
class TakeoverWatch {
 public:
  /// `server` must outlive the object. `on_failure` is called at most once, from the thread, if
  /// has_failed(server.ownership()). `handed_over` is empty unless the server has just handed the
  /// world over: it gets one answer, from any thread, when the world has an owner again.
  TakeoverWatch(const std::string& place, Server& server, std::function<void()> on_failure,
                CommandReply handed_over = {});
  /// Ends the thread. Waits for a takeover that is under way.
  ~TakeoverWatch();
  TakeoverWatch(const TakeoverWatch&) = delete;
  TakeoverWatch& operator=(const TakeoverWatch&) = delete;

 private:
  void run();
  /// Looks once. Returns false if there is nothing more to watch.
  bool look();
  /// Returns true if another server may be about to take the world, which nobody owns.
  bool leaves_lease();
  void answer(const std::string& outcome, bool is_ok);
  void fail(const std::string& why);
  void warn(const std::string& why);

  LeaseWatch lease_;
  Server& server_;
  const std::function<void()> on_failure_;
  CommandReply handed_over_;  // emptied by answer(). Used on the thread, and when it has ended
  // Used on the thread.
  std::chrono::steady_clock::time_point not_before_;  // it takes no lease before
  std::optional<std::chrono::steady_clock::time_point>
      ownerless_since_;        // nullopt: there is an owner
  std::int64_t term_ = 0;      // of the lease of the last owner
  bool has_followed_ = false;  // this server was live with that owner
  int ownerless_looks_left_ = 0;
  std::string told_;  // the reason that warn() has logged last; empty if all is well
  std::mutex mutex_;
  std::condition_variable wake_;
  bool is_stopping_ = false;  // guarded by mutex_
  std::thread thread_;
};

/// Lets another server take the world over (Server::hand_over()), and makes the watch of the
/// server, which follows from now on. `watch` is the earlier one, if any. `place` and `on_failure`
/// are as for the watch. `reply` gets the outcome. Returns false if the server must be stopped
/// because its log could not be written. Blocks on the database. Requires start_logging().
bool hand_over_and_watch(const std::string& place, Server& server,
                         std::optional<TakeoverWatch>& watch,
                         const std::function<void()>& on_failure,
                         std::optional<SessionId> successor, const CommandReply& reply);

}  // namespace runstone
