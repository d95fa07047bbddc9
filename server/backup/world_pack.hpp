// A pack: one file that holds all of a world. It is a tar file, so other programs can read it:
//   - the files of a copy of the world (world_backup.hpp), in the order of their names, which is
//     verified before it is packed;
//   - at its end `runstone-pack`: the manifest (backup_manifest.hpp), whose hashes cover all bytes
//     of the files.
// So a pack that is cut off or damaged is found before a world is made of it.
// Threads: one thread at a time. All calls block on the disk.
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/backup/backup_manifest.hpp"
#include "server/backup/world_backup.hpp"

namespace runstone {

struct PackRequest {
  std::string world;      // folder
  std::string file;       // the new file
  bool progress = false;  // print progress even if standard error is no terminal
};

/// Packs a world into a new file, mode 0600, and prints what it holds. A server may run the world.
/// The disk of the file needs room for the world twice, because the copy is verified before it is
/// packed. `now_us` is the time in UTC. The error is one line; there is then no new file. Fails if
/// the file exists, or lies in the world's folder.
Result<void, std::string> pack_world(const PackRequest& request, TimeUs now_us, std::ostream& out,
                                     const BackupPace& pace = gentle_pace());

/// Writes the files of a pack to the empty folder `to`, compares them with its hashes, begins a new
/// branch there, and verifies the world as back_up_world() does. The error is one line; `to` is
/// then to be thrown away.
Result<WorldBackup, std::string> unpack_world(const std::string& file, const std::string& to,
                                              TimeUs now_us);

}  // namespace runstone
