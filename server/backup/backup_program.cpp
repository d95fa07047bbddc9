#include "server/backup/backup_program.hpp"

#include <filesystem>
#include <ostream>
#include <system_error>

#include "common/os/low_priority.hpp"
#include "common/os/new_folder.hpp"
#include "common/os/progress_line.hpp"
#include "server/backup/backup_folder.hpp"
#include "server/backup/copy_text.hpp"
#include "server/backup/folder_backup.hpp"
#include "server/backup/world_backup.hpp"
#include "server/backup/world_pack.hpp"

namespace runstone {
namespace {

/// Copies `from` to the new folder `to`.
Result<WorldBackup, std::string> copy_folder(const std::string& from, SourceUse use,
                                             const std::string& to, bool always_progress,
                                             TimeUs now_us, const BackupPace& pace,
                                             std::ostream& out) {
  // A target in the world's folder would be lost together with it, and fill the same disk.
  if (is_inside(to, from)) return failure(to + ": lies in " + from);
  auto folder = NewFolder::make(to, out);
  if (!folder) return failure(folder.error());
  auto backup = [&] {
    ProgressLine line("pages copied", always_progress);
    return back_up_world(from, use, folder->path(), now_us, pace,
                         [&](std::uint64_t done, std::uint64_t all) { line.show(done, all); });
  }();
  if (!backup) return backup;
  if (auto finished = folder->finish("world.sqlite"); !finished) return failure(finished.error());
  return backup;
}

/// Makes the new folder `request.world` of a backup of a backup folder.
Result<WorldBackup, std::string> copy_of_backup(const RestoreRequest& request, TimeUs now_us,
                                                std::ostream& out) {
  if (is_inside(request.world, request.from))
    return failure(request.world + ": lies in " + request.from);
  auto backups = BackupFolder::open(request.from);
  if (!backups) return failure(backups.error());
  const auto unlocked = backups->lock_for_reading();
  if (!unlocked) return failure(unlocked.error());
  if (!unlocked->empty()) out << "warning     " << *unlocked << '\n';
  const auto found = backups->find(request.backup, now_us);
  if (!found) return failure(found.error());
  auto folder = NewFolder::make(request.world, out);
  if (!folder) return failure(folder.error());
  auto backup = write_backup(found->manifest, backups->blocks(), folder->path(), now_us);
  if (!backup) return backup;
  if (auto finished = folder->finish("world.sqlite"); !finished) return failure(finished.error());
  out << "backup      " << found->name << '\n';
  return backup;
}

/// Makes the new folder `request.world` of a pack.
Result<WorldBackup, std::string> copy_of_pack(const RestoreRequest& request, TimeUs now_us,
                                              std::ostream& out) {
  if (!request.backup.empty())
    return failure(request.from + ": is a pack of one world, so no backup of it can be chosen");
  auto folder = NewFolder::make(request.world, out);
  if (!folder) return failure(folder.error());
  auto backup = unpack_world(request.from, folder->path(), now_us);
  if (!backup) return backup;
  if (auto finished = folder->finish("world.sqlite"); !finished) return failure(finished.error());
  return backup;
}

/// Makes the new folder `request.world` of a folder that is a copy of a world.
Result<WorldBackup, std::string> copy_of_folder(const RestoreRequest& request, TimeUs now_us,
                                                std::ostream& out) {
  if (!request.backup.empty())
    return failure(request.from + ": is no folder of several backups, so none can be chosen");
  // A backup that somebody has open, such as runstone-replay, has a WAL beside it.
  std::error_code ignored;
  const bool is_open =
      std::filesystem::exists(std::filesystem::path(request.from) / "world.sqlite-wal", ignored);
  return copy_folder(request.from, is_open ? SourceUse::live : SourceUse::still, request.world,
                     request.progress, now_us, BackupPace{}, out);
}

}  // namespace

Result<void, std::string> back_up(const BackupRequest& request, TimeUs now_us, std::ostream& out,
                                  const BackupPace& pace) {
  lower_priority();
  lower_disk_priority();
  const auto backup =
      copy_folder(request.world, SourceUse::live, request.to, request.progress, now_us, pace, out);
  if (!backup) return failure(backup.error());
  out << "backed up   " << request.world << " to " << request.to << '\n';
  print_copy(*backup, out);
  return {};
}

Result<void, std::string> restore(const RestoreRequest& request, TimeUs now_us, std::ostream& out) {
  std::error_code ignored;
  const auto backup = std::filesystem::is_regular_file(request.from, ignored)
                          ? copy_of_pack(request, now_us, out)
                      : BackupFolder::is_one(request.from) ? copy_of_backup(request, now_us, out)
                                                           : copy_of_folder(request, now_us, out);
  if (!backup) return failure(backup.error());
  out << "restored    " << request.from << " to " << request.world << '\n';
  print_copy(*backup, out);
  out << "branch      epoch=" << backup->new_epoch
      << ": the log goes on from here with other edits than before. Clients that saw later\n"
         "            edits drop the chunks that they kept, and load them again\n";
  return {};
}

}  // namespace runstone
