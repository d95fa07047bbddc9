// runstone-server backup add, list, prune and verify: the backups of a backup folder.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/backup/backup_policy.hpp"
#include "server/backup/database_backup.hpp"

namespace runstone {

struct BackupFolderRequest {
  enum class Action : std::uint8_t { add, list, prune, verify };
  Action action = Action::list;
  std::string folder;
  std::string world;             // add: folder of the world
  std::string backup;            // verify: the name of a backup; empty: all
  BackupPolicy policy{0, 0, 0};  // add and prune
  bool is_rehearsal = false;     // prune: print what would be removed
  bool json = false;             // list and verify: print JSON
  bool progress = false;         // add: print progress even if standard error is no terminal
};

/// Carries out the request, and prints what it did. `now_us` is the time in UTC. The error is one
/// line.
///   - add makes a verified backup, and then removes those that the policy does not keep. It fails
///     if the folder lies in the world's folder, or the other way round. If a backup was made and
///     others could not be removed, a line begins with "warning".
///   - list prints all backups, and a warning if one is dated after `now_us`. It needs no lock and
///     writes nothing.
///   - prune removes the backups that the policy does not keep. It fails if the policy keeps all.
///   - verify reads every block of the backups. It fails if one of them is damaged.
Result<void, std::string> run_backup_folder(const BackupFolderRequest& request, TimeUs now_us,
                                            std::ostream& out,
                                            const BackupPace& pace = gentle_pace());

}  // namespace runstone
