// Backups in a backup folder (BackupFolder): how one is made of a world that may be in use, and how
// a world is made of one.
// A backup is first a whole copy (world_backup.hpp), which is verified. Then its blocks are stored
// and the copy is removed. So the bytes of a further backup are those that have changed, and the
// time is that of a whole copy: SQLite does not say which pages have changed.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <set>
#include <string>

#include "common/core/result.hpp"
#include "server/backup/backup_folder.hpp"
#include "server/backup/world_backup.hpp"

namespace runstone {

struct AddedBackup {
  BackupManifest manifest;
  WorldBackup copy;
  double store_s = 0;
  bool found_interrupted = false;  // a backup before this one was killed, and may have left blocks
};

/// Makes a backup of the world in the folder `from`. A server may run the world. Requires that
/// `into` is locked. Reports to `out` what an interrupted backup left and this one has removed.
/// While it stores blocks, `pace.spare_bytes` of the disk stay free. The error is one line; the
/// folder then has no new backup, and the blocks that this one has stored are removed.
Result<AddedBackup, std::string> add_backup(const std::string& from, BackupFolder& into,
                                            TimeUs now_us, const BackupPace& pace,
                                            const BackupProgress& progress, std::ostream& out);

/// Writes the files of a backup to the empty folder `to`, compares each block with its hash, begins
/// a new branch there, and verifies the world as back_up_world() does. All bytes are on disk on
/// return. The error is one line; `to` is then to be thrown away.
Result<WorldBackup, std::string> write_backup(const BackupManifest& manifest,
                                              const BlockFolder& blocks, const std::string& to,
                                              TimeUs now_us);

/// Reads the blocks of a backup and compares them with their hashes. Fails with the first one that
/// is missing or damaged. Blocks in `sound` are not read; those that are sound are added to it.
Result<void, std::string> check_blocks(const BackupManifest& manifest, const BlockFolder& blocks,
                                       std::set<BlockHash>& sound);

}  // namespace runstone
