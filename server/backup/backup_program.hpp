// runstone-server backup and restore: a copy of a world that may be in use, and the way back.
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/backup/database_backup.hpp"

namespace runstone {

struct BackupRequest {
  std::string world;      // folder
  std::string to;         // the new folder
  bool progress = false;  // print progress even if standard error is no terminal
};

struct RestoreRequest {
  std::string from;   // folder of a backup or of several ones (BackupFolder), or a pack
  std::string world;  // the new folder
  bool progress = false;
  std::string backup = {};  // of a folder of several backups, by name; empty: the newest one
};

/// Writes a verified copy of the world into the new folder `to`, and prints what it holds. A server
/// may run the world. `now_us` is the time in UTC. The error is one line; no folder `to` is then
/// there.
Result<void, std::string> back_up(const BackupRequest& request, TimeUs now_us, std::ostream& out,
                                  const BackupPace& pace = gentle_pace());

/// Makes a world of a backup, verifies it, and prints what the operator must know about it. Fails
/// if the folder `world` exists and is not empty. The backup stays as it is. `now_us` and the error
/// as for back_up().
Result<void, std::string> restore(const RestoreRequest& request, TimeUs now_us, std::ostream& out);

}  // namespace runstone
