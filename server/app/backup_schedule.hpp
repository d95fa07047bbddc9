// BackupSchedule: makes the backups of a running server by itself. Each one is a program of its own
// (BackupChild): `runstone-server backup add`, which has low priority. A failure is logged and
// counted, and ends nothing: the next attempt follows.
// Threads: state() from any thread, the rest from the one that owns the object.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/os/file_lock.hpp"
#include "server/admin/backup_state.hpp"
#include "server/admin/server_config.hpp"
#include "server/app/backup_child.hpp"
#include "server/backup/backup_policy.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

struct BackupPlan {
  std::string world, folder;
  std::uint64_t every_s = 0;  // above 0
  BackupPolicy policy;
  friend bool operator==(const BackupPlan&, const BackupPlan&) = default;
};

/// Returns the plan that the settings give, or nullopt if `backup_every` is 0. Fails if there is no
/// folder, if it lies in the world's folder or the other way round, or if the world is in a
/// database. The error is one line.
Result<std::optional<BackupPlan>, std::string> backup_plan_of(const ServerConfig& config);

/// Returns when the next backup is due (UTC): `every_us` after the last one, or `now_us` if there
/// is none. A last one that is after `now_us` counts as one of now, because a clock was set back.
TimeUs next_backup_us(std::optional<TimeUs> last_us, TimeUs now_us, TimeUs every_us);

class BackupSchedule {
 public:
  explicit BackupSchedule(BackupPlan plan);
  /// Calls stop().
  ~BackupSchedule() { stop(); }
  BackupSchedule(const BackupSchedule&) = delete;
  BackupSchedule& operator=(const BackupSchedule&) = delete;

  /// Starts the thread. Call it once, when the server runs the world.
  void start();
  /// Begins to end a backup that is under way, and the thread. Does not wait for the disk.
  void ask_to_stop();
  /// Calls ask_to_stop(), and waits for the end of the thread. A backup disk that hangs can hold it
  /// up, so the server stops the world first. It may be called again.
  void stop();
  BackupState state() const;

 private:
  struct Last {
    LastBackup backup;
    TimeUs taken_us = 0;
  };
  struct Outcome {
    std::string text;
    bool is_ok = false;
  };

  void run();
  /// Makes a backup that is due, and notes what came of it. Returns false if the thread must end.
  bool make_and_note();
  /// Keeps other servers from making backups in the folder. Does nothing if it is no folder of
  /// backups yet, because no file may be made in a folder of others. Fails if another server has
  /// it.
  Result<void, std::string> hold_folder();
  /// Reads which world the backups must be of, unless it is known. The next call tries again.
  void read_world();
  /// Reads the newest backup of the folder, if its backups are of this world.
  void read_last();
  /// Waits until the next backup is due. Returns false if the thread must end.
  bool await_due();
  /// Runs the program. Returns nullopt if the thread must end.
  std::optional<Outcome> make_backup();
  void note(const Outcome& outcome);

  const BackupPlan plan_;
  BackupChild child_;
  FileLock folder_lock_;  // of the thread: no other server makes backups in the folder
  WorldId world_{};       // of the thread
  /// The time at which the last backup of this object began. It is kept even if that backup cannot be
  /// read afterwards. Only the thread uses it.
  std::optional<TimeUs> made_us_;
  mutable std::mutex mutex_;  // a leaf: guards the members below
  std::condition_variable changed_;
  std::optional<Last> last_;
  std::optional<Outcome> outcome_;  // of the backup under way
  TimeUs next_us_ = 0;
  bool is_under_way_ = false, stopping_ = false;
  std::uint64_t failures_ = 0;
  std::string failure_;
  std::thread thread_;
};

}  // namespace runstone
