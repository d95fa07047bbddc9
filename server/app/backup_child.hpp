// BackupChild: makes a backup for a running server as a program of its own. Its
// priority, its memory and the locks that SQLite takes on the world's files are then not those of
// the server.
// Threads: start() and run() from any thread, the rest from the one that owns the object.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/rollback/command_reply.hpp"

namespace runstone {

class BackupChild {
 public:
  /// How long a program that must end has for it. Tests change it.
  struct Patience {
    std::chrono::milliseconds terminate{5'000};  // from SIGTERM to SIGKILL
    std::chrono::milliseconds kill{5'000};       // from SIGKILL until it is left behind
  };
  explicit BackupChild(std::string world) : BackupChild(std::move(world), Patience{}) {}
  BackupChild(std::string world, Patience patience)
      : world_(std::move(world)), patience_(patience) {}
  /// Calls stop().
  ~BackupChild();
  BackupChild(const BackupChild&) = delete;
  BackupChild& operator=(const BackupChild&) = delete;

  /// Starts `runstone-server backup` to a new folder. The reply gets what the program prints, from
  /// another thread. Refuses if a backup is under way.
  void start(const std::string& folder, CommandReply reply);
  /// Starts `runstone-server` with these arguments, as start() does. Thread: any.
  void run(const std::vector<std::string>& arguments, CommandReply reply);
  /// Begins to end a backup that is under way, which leaves its partial folder. Does not wait for
  /// its end. start() refuses from now on. Thread: any.
  void ask_to_stop();
  /// Calls ask_to_stop(), and waits for the end of the program, for the time of Patience at most: a
  /// disk that hangs can keep a program from ending even after SIGKILL. No reply is called any more
  /// on return.
  void stop();

 private:
  /// Reads what the program prints, waits for its end, and calls `reply`. Thread: reader_.
  void await_end(int output, pid_t pid, const CommandReply& reply);
  /// Kills the program if it had to end and did not. Returns true if it is time to leave it behind.
  bool is_given_up(pid_t pid);

  const std::string world_;
  const Patience patience_;
  std::mutex mutex_;  // a leaf: guards the members below
  std::thread reader_;
  pid_t pid_ = -1;  // of the backup under way, until it is waited for
  bool is_stopped_ = false, is_killed_ = false;
  std::chrono::steady_clock::time_point stopped_at_;  // if is_stopped_
};

}  // namespace runstone
