#include "server/backup/world_backup.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/os/folder_entries.hpp"
#include "common/os/private_file.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sqlite_backend.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kDatabase = "world.sqlite", kMark = "world.durable";
/// Files that a running server or reader makes. They mean nothing in a copy.
constexpr std::array<std::string_view, 6> kMadeAnew = {"world.sqlite-wal", "world.sqlite-shm",
                                                       "chat.sqlite-wal",  "chat.sqlite-shm",
                                                       "world.lock",       "control.sock"};
constexpr std::uintmax_t kConfigurationBytesMax = kSmallFileBytesMax;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Copies a small file and makes the copy readable for its owner only. It is on disk on return. Fails
/// with the reason and leaves no part of it.
Result<void, std::string> copy_small(const fs::path& from, const fs::path& to) {
  const auto bytes = read_file(from.string(), kSmallFileBytesMax);
  if (!bytes) return failure(bytes.error());
  return write_private_file(to.string(), *bytes);
}

bool is_configuration(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(fs::symlink_status(file, error)) && file.extension() == ".toml" &&
         fs::file_size(file, error) <= kConfigurationBytesMax;
}

/// Moves the write-ahead log of a closed database into it. Closing it does the same, and says nothing
/// if it could not.
StoreResult<void> move_log(const std::string& file) {
  auto database = sql::open_sqlite(file, sql::SqliteMode::write);
  if (!database) return failed(database.error());
  const auto is_busy = database->integer("PRAGMA wal_checkpoint(TRUNCATE)");
  if (!is_busy) return failed(is_busy.error());
  if (*is_busy == 0) return {};
  return failure(StoreError{StoreError::Kind::locked, file, "", "another program has it open"});
}

/// Verifies the copy in `folder` and begins its branch. Completes `backup`.
StoreResult<void> verify(const std::string& folder, TimeUs now_us, WorldBackup& backup) {
  // This fails if the copied mark is ahead of the copied log: then the source has lost edits.
  auto store = open_world(folder, StoreAccess::read_write);
  if (!store) return failure(store.error());
  const auto range = (*store)->log_range();
  if (!range) return failure(range.error());
  if (range->last.version.seq != backup.moment.seq) {
    return failure(
        StoreError{StoreError::Kind::corrupt, (*store)->file(), "edit_log",
                   "ends at seq=" + std::to_string(range->last.version.seq) +
                       ", and the copied moment is seq=" + std::to_string(backup.moment.seq)});
  }
  const auto epoch = (*store)->begin_branch(now_us);
  if (!epoch) return failure(epoch.error());
  if (auto sound = (*store)->check(); !sound) return sound;
  backup.world = (*store)->meta().world_id;
  backup.new_epoch = *epoch;
  backup.edits = range->last.version.seq + 1 - range->first;
  return {};
}

}  // namespace

Result<WorldBackup, std::string> back_up_world(const std::string& from, SourceUse use,
                                               const std::string& to, TimeUs now_us,
                                               const BackupPace& pace,
                                               const BackupProgress& progress) {
  const fs::path source(from), target(to);
  const std::string database = (source / kDatabase).string();
  std::error_code error;
  if (!fs::exists(database, error)) return failure(from + ": holds no world");
  if (const auto marked = check_marks(database, ""); !marked)
    return failure(marked.error().message());
  WorldBackup backup;
  const auto begun = Clock::now();
  // The mark is read first: a running server raises the database before the mark, so the mark is
  // not ahead of the moment.
  if (fs::exists(source / kMark, error)) {
    if (auto copied = copy_small(source / kMark, target / kMark); !copied)
      return failure(copied.error());
  }
  const auto moment = copy_database(database, use, (target / kDatabase).string(), pace, progress);
  if (!moment) return failure(moment.error().message());
  backup.moment = *moment;
  auto left_out = copy_configuration(from, to);
  if (!left_out) return failure(left_out.error());
  backup.left_out = *std::move(left_out);
  backup.copy_s = seconds_since(begun);
  if (auto complete = complete_copy(to, now_us, backup); !complete)
    return failure(complete.error());
  return backup;
}

Result<void, std::string> complete_copy(const std::string& to, TimeUs now_us, WorldBackup& backup) {
  const fs::path target(to);
  const auto checked = Clock::now();
  if (auto verified = verify(to, now_us, backup); !verified) {
    const std::string verdict = verified.error().may_pass() ? "cannot be verified" : "is not sound";
    return failure("the copy " + verdict + ", and is removed: " + verified.error().message());
  }
  backup.check_s = seconds_since(checked);
  std::error_code error;
  const fs::path wal = target / "world.sqlite-wal";
  if (fs::exists(wal, error) && fs::file_size(wal, error) != 0) {
    if (const auto moved = move_log((target / kDatabase).string()); !moved)
      return failure("world.sqlite-wal cannot be moved into the copy, which is removed: " +
                     moved.error().message());
  }
  for (const std::string_view name : kMadeAnew) fs::remove(target / name, error);
  return {};
}

Result<std::vector<std::string>, std::string> copy_configuration(const std::string& from,
                                                                 const std::string& to) {
  std::vector<std::string> left_out;
  const auto entries = folder_entries(from);
  if (!entries) return failure(entries.error());
  for (const fs::path& path : *entries) {
    const std::string name = path.filename().string();
    if (name == kDatabase || name == kMark ||
        std::find(kMadeAnew.begin(), kMadeAnew.end(), name) != kMadeAnew.end())
      continue;
    if (!is_configuration(path)) {
      left_out.push_back(name);
    } else if (auto copied = copy_small(path, fs::path(to) / name); !copied) {
      return failure(copied.error());
    }
  }
  return left_out;
}

bool is_inside(const std::string& inner, const std::string& outer) {
  std::error_code error;
  const auto in = fs::weakly_canonical(fs::absolute(inner, error), error) / "";
  const auto out = fs::weakly_canonical(fs::absolute(outer, error), error) / "";
  const auto difference = in.lexically_normal().lexically_relative(out.lexically_normal());
  return !difference.empty() && *difference.begin() != "..";
}

}  // namespace runstone
