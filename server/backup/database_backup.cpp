#include "server/backup/database_backup.hpp"

#include <filesystem>
#include <thread>
#include <utility>

#include "common/os/free_space.hpp"
#include "common/sqlite/online_copy.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "server/backup/uncached_file.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

using Clock = std::chrono::steady_clock;

Unexpected<StoreError> target_failure(StoreError::Kind kind, const std::string& what) {
  return {{kind, "", "", what}};
}

/// Reads the numbers of the moment. The first read of a transaction decides what it sees.
StoreResult<BackupMoment> begin_moment(sql::Database& from) {
  if (auto begun = from.run("BEGIN"); !begun) return failed(begun.error());
  auto meta = MetaTable::open(from);
  if (!meta) return failed(meta.error());
  const auto epoch = meta->counter("epoch");
  if (!epoch) return failed(epoch.error());
  const auto seq = meta->counter("log_last");
  if (!seq) return failed(seq.error());
  const auto pages = from.integer("PRAGMA page_count");
  if (!pages) return failed(pages.error());
  const auto page_bytes = from.integer("PRAGMA page_size");
  if (!page_bytes) return failed(page_bytes.error());
  return BackupMoment{static_cast<Epoch>(*epoch), *seq,
                      static_cast<std::uint64_t>(*pages * *page_bytes)};
}

/// Opens the new file. No journal and no sync of SQLite is needed: a copy that is cut off is thrown
/// away, and UncachedFile syncs it.
StoreResult<sql::Database> open_target(const std::string& to) {
  auto database = sql::open_sqlite(to, sql::SqliteMode::write);
  if (!database) return failed(database.error());
  const auto set = database->run(
      "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF");
  if (!set) return failed(set.error());
  return *std::move(database);
}

StoreResult<void> copy_pages(sql::Database& source, const std::string& to, UncachedFile& file,
                             const BackupPace& pace, const BackupProgress& progress) {
  auto target = open_target(to);
  if (!target) return failed(target.error());
  auto copy = sql::OnlineCopy::begin(source, *target);
  if (!copy) return failed(copy.error());
  for (int part = 1;; ++part) {
    const auto begun = Clock::now();
    const auto more = copy->step(pace.part_pages);
    if (!more) return failed(more.error());
    if (!*more) return {};
    if (part % pace.flush_parts == 0) {
      if (auto flushed = file.flush(); !flushed)
        return target_failure(StoreError::Kind::io, flushed.error());
    }
    if (progress) progress(copy->page_count() - copy->pages_left(), copy->page_count());
    if (pace.rest) pace.rest(Clock::now() - begun);
  }
}

}  // namespace

Result<void, std::string> check_room(const std::string& name, const std::string& folder,
                                     std::uint64_t bytes, std::uint64_t spare) {
  const auto free = free_bytes(folder);
  if (!free || (*free >= bytes && *free - bytes >= spare)) return {};
  constexpr std::uint64_t kMib = 1ULL << 20;
  const std::string needs =
      bytes == 0 ? "" : "needs " + std::to_string(bytes / kMib + 1) + " MiB, and ";
  return failure(name + ": " + needs + std::to_string(spare / kMib) +
                 " MiB must stay free, but the disk has " + std::to_string(*free / kMib) + " MiB");
}

BackupPace gentle_pace() {
  BackupPace pace;
  pace.rest = [](std::chrono::nanoseconds worked) { std::this_thread::sleep_for(worked); };
  return pace;
}

StoreResult<BackupMoment> copy_database(const std::string& from, SourceUse use,
                                        const std::string& to, const BackupPace& pace,
                                        const BackupProgress& progress) {
  const auto mode = use == SourceUse::live ? sql::SqliteMode::read : sql::SqliteMode::header;
  auto source = sql::open_sqlite(from, mode);
  if (!source) return failed(source.error());
  const auto moment = begin_moment(*source);
  if (!moment) return moment;
  const std::string folder = std::filesystem::path(to).parent_path().string();
  if (auto room = check_room(to, folder, moment->bytes, pace.spare_bytes); !room)
    return target_failure(StoreError::Kind::full, room.error());
  auto file = UncachedFile::make(to);
  if (!file) return target_failure(StoreError::Kind::exists, file.error());
  if (auto reserved = file->reserve(moment->bytes); !reserved)
    return target_failure(StoreError::Kind::full, reserved.error());
  if (auto copied = copy_pages(*source, to, *file, pace, progress); !copied)
    return failed(copied.error());
  if (auto flushed = file->flush(); !flushed)
    return target_failure(StoreError::Kind::io, flushed.error());
  return moment;
}

}  // namespace runstone
