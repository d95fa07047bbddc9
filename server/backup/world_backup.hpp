// The copy of a world's folder, and its verification. Backup and restore are both such a copy. It
// holds
//   - the database, which has the world, the players and the server's secret key;
//   - the durable mark;
//   - configuration: the files *.toml that lie in the folder.
// Locks, sockets, pictures of previews and files that Runstone does not know are not copied, and
// neither is the log of the chat: a copy would keep what players wrote beyond its retention.
#pragma once
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "server/backup/database_backup.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

struct WorldBackup {
  WorldId world{};
  BackupMoment moment;                // of the source
  Epoch new_epoch = 0;                // of the copy: the first one of a new branch
  std::uint64_t edits = 0;            // in the log of the copy
  std::vector<std::string> left_out;  // names in the source's folder that are not copied
  double copy_s = 0, check_s = 0;
};

/// Copies the world in the folder `from` to the empty folder `to`, begins a new branch in the copy,
/// and verifies all of the copy: the database's own check, every row, and the log without gaps up
/// to the moment. All bytes are on disk on return. `now_us` is the time in UTC. The error is one
/// line; `to` is then to be thrown away.
Result<WorldBackup, std::string> back_up_world(const std::string& from, SourceUse use,
                                               const std::string& to, TimeUs now_us,
                                               const BackupPace& pace,
                                               const BackupProgress& progress);

/// Begins a new branch in the copied world in the folder `to`, and verifies it as back_up_world()
/// does. Requires `backup.moment`, and completes the rest of `backup` but `left_out` and `copy_s`.
/// The error is one line; `to` is then to be thrown away.
Result<void, std::string> complete_copy(const std::string& to, TimeUs now_us, WorldBackup& backup);

/// Copies the configuration, the files *.toml, from a world's folder to another one. Returns the
/// names of what is left out: neither configuration nor files of a world. The error is one line.
Result<std::vector<std::string>, std::string> copy_configuration(const std::string& from,
                                                                 const std::string& to);

/// Returns true if the folder `inner` is `outer` or lies in it. Symbolic links are resolved.
bool is_inside(const std::string& inner, const std::string& outer);

}  // namespace runstone
