#include "server/backup/backup_program.hpp"

#include <filesystem>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <system_error>

#include "common/core/hex.hpp"
#include "common/os/low_priority.hpp"
#include "common/os/new_folder.hpp"
#include "common/os/progress_line.hpp"
#include "server/backup/world_backup.hpp"

namespace runstone {
namespace {

std::string seconds_text(double seconds) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << seconds << " s";
  return text.str();
}

void print(const WorldBackup& backup, std::ostream& out) {
  out << "world       " << to_hex(backup.world) << '\n'
      << "moment      epoch=" << backup.moment.epoch << " seq=" << backup.moment.seq << '\n'
      << "copied      " << backup.moment.bytes << " bytes in " << seconds_text(backup.copy_s)
      << '\n'
      << "verified    the database, every row, and " << backup.edits
      << " edits up to seq=" << backup.moment.seq << ", in " << seconds_text(backup.check_s)
      << '\n';
  if (backup.left_out.empty()) return;
  out << "left out   ";
  for (const std::string& name : backup.left_out) out << ' ' << name;
  out << '\n';
}

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

}  // namespace

Result<void, std::string> back_up(const BackupRequest& request, TimeUs now_us, std::ostream& out,
                                  const BackupPace& pace) {
  lower_priority();
  lower_disk_priority();
  const auto backup =
      copy_folder(request.world, SourceUse::live, request.to, request.progress, now_us, pace, out);
  if (!backup) return failure(backup.error());
  out << "backed up   " << request.world << " to " << request.to << '\n';
  print(*backup, out);
  return {};
}

Result<void, std::string> restore(const RestoreRequest& request, TimeUs now_us, std::ostream& out) {
  // A backup that somebody has open, such as runstone-replay, has a WAL beside it.
  std::error_code ignored;
  const bool is_open =
      std::filesystem::exists(std::filesystem::path(request.from) / "world.sqlite-wal", ignored);
  const auto backup = copy_folder(request.from, is_open ? SourceUse::live : SourceUse::still,
                                  request.world, request.progress, now_us, BackupPace{}, out);
  if (!backup) return failure(backup.error());
  out << "restored    " << request.from << " to " << request.world << '\n';
  print(*backup, out);
  out << "branch      epoch=" << backup->new_epoch
      << ": the log goes on from here with other edits than before. Clients that saw later\n"
         "            edits drop the chunks that they kept, and load them again\n";
  return {};
}

}  // namespace runstone
