// BackupChild: makes a backup for a running server as a program of its own. Its
// priority, its memory and the locks that SQLite takes on the world's files are then not those of
// the server.
// Threads: start() and run() from any thread, the rest from the one that owns the object.
#pragma once
#include <sys/types.h>

#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/rollback/command_reply.hpp"

namespace runstone {

class BackupChild {
 public:
  explicit BackupChild(std::string world) : world_(std::move(world)) {}
  /// Calls stop().
  ~BackupChild();
  BackupChild(const BackupChild&) = delete;
  BackupChild& operator=(const BackupChild&) = delete;

  /// Starts `runstone-server backup` to a new folder. The reply gets what the program prints, from
  /// another thread. Refuses if a backup is under way.
  void start(const std::string& folder, CommandReply reply);
  /// Starts `runstone-server` with these arguments, as start() does. Thread: any.
  void run(const std::vector<std::string>& arguments, CommandReply reply);
  /// Ends a backup that is under way, which leaves its partial folder. No reply is called any more
  /// on return, and start() refuses from now on.
  void stop();

 private:
  /// Reads what the program prints, waits for its end, and calls `reply`. Thread: reader_.
  void await_end(int output, pid_t pid, const CommandReply& reply);

  const std::string world_;
  std::mutex mutex_;  // a leaf: guards the members below
  std::thread reader_;
  pid_t pid_ = -1;  // of the backup under way, until it is waited for
  bool is_stopped_ = false;
};

}  // namespace runstone
