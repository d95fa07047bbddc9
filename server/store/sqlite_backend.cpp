#include "server/store/sqlite_backend.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "common/sql/transaction.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "server/store/new_world.hpp"
#include "server/store/place_rule.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

std::string file_in(const std::string& folder) { return folder + "/world.sqlite"; }

Unexpected<StoreError> store_failure(StoreError::Kind kind, const std::string& file,
                                     std::string what) {
  return {{kind, file, "", std::move(what)}};
}

/// The place is no folder. Its name is left out, because a mistyped address may hold a password.
Unexpected<StoreError> no_folder(const std::string& why) {
  return store_failure(StoreError::Kind::bad_request, "the place of the world", why);
}

/// Takes FOLDER/world.lock, so that at most one process writes the world. `file` names the world in
/// the error.
StoreResult<FileLock> take_lock(const std::string& folder, const std::string& file) {
  const std::string path = folder + "/world.lock";
  auto lock = FileLock::take(path);
  if (lock) return *std::move(lock);
  if (lock.error().is_held)
    return store_failure(StoreError::Kind::locked, file,
                         "another program is writing this world (it holds world.lock)");
  return store_failure(StoreError::Kind::io, path, "cannot be written: " + lock.error().what);
}

/// Only the owner may read the file, because it holds the world's secret key. SQLite gives WAL and
/// shared memory the mode of the file.
constexpr mode_t kFileMode = 0600;
constexpr mode_t kFolderMode = 0700;

/// Makes an empty file for its owner only. SQLite would make one that everybody can read.
StoreResult<void> make_file(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kFileMode);
  if (descriptor < 0) {
    return store_failure(StoreError::Kind::io, file,
                         "cannot be made: " + std::generic_category().message(errno));
  }
  ::close(descriptor);
  return {};
}

/// Makes the folder for its owner only, unless it exists. Its name in the parent folder is on disk
/// on return, before any file in it is reported as durable.
StoreResult<void> make_folder(const std::string& folder, const std::string& file) {
  std::error_code error;
  auto whole = std::filesystem::absolute(folder, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // "valley/"
  std::filesystem::create_directories(whole.parent_path(), error);
  if (!error && ::mkdir(whole.c_str(), kFolderMode) != 0 &&
      !(errno == EEXIST && std::filesystem::is_directory(whole))) {
    error = std::error_code(errno, std::generic_category());
  }
  if (error)
    return store_failure(StoreError::Kind::io, file,
                         "the folder cannot be made: " + error.message());
  const auto parent = whole / "..";
  const int descriptor = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::fsync(descriptor);  // best effort: some file systems cannot sync a folder
    ::close(descriptor);
  }
  return {};
}

// A commit of some edits writes a few pages, each of which it changes in some bytes: one of the log,
// one of the author index for each player, some of the index by place. With pages of 4 KiB it writes
// a quarter more. With pages of 1 KiB it writes little less, and chunks need more overflow pages.
constexpr int kPageBytes = 2'048;
// Pages of the WAL that start a checkpoint: 4 MiB of a world that was made with these pages.
constexpr int kCheckpointPages = 2'048;

// Free pages go back to the disk when give_back() asks for it, and not in the commits of edits. The
// file has a page of back references for some hundred others.
constexpr const char* kGiveSpaceBack = "PRAGMA auto_vacuum = INCREMENTAL";
constexpr std::int64_t kIncremental = 2;  // PRAGMA auto_vacuum

/// For WAL, EXTRA is the same as FULL. During creation it also syncs the folder after the rollback
/// journal is deleted. The journal then cannot reappear after a crash and undo a world that is
/// already in use.
const char* sync_pragma(bool sync) {
  return sync ? "PRAGMA synchronous = EXTRA" : "PRAGMA synchronous = OFF";
}

StoreResult<void> set_pragmas(sql::Database& database, StoreAccess access, bool sync) {
  if (access == StoreAccess::read_only)
    return store_result(database.run("PRAGMA query_only = ON; PRAGMA trusted_schema = OFF;"));
  if (auto set = database.run(sync_pragma(sync)); !set) return failed(set.error());
  const auto mode = database.text("PRAGMA journal_mode = WAL");
  if (!mode) return failed(mode.error());
  if (*mode != "wal")
    return store_failure(StoreError::Kind::io, database.file(),
                         "the file system has no shared memory for WAL");
  // Freed pages need not be overwritten with zeros, because the rows of the log hold no secret.
  const std::string set =
      "PRAGMA secure_delete = OFF; PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; "
      "PRAGMA wal_autocheckpoint = " +
      std::to_string(kCheckpointPages);
  return store_result(database.run(set.c_str()));
}

StoreResult<void> set_file_format(sql::Database& database, std::uint32_t format) {
  const std::string mark = "PRAGMA user_version=" + std::to_string(format);
  return store_result(database.run(mark.c_str()));
}

StoreResult<void> write_new_world(sql::Database& database, const FillWorld& fill, bool sync) {
  // The schema is committed in rollback mode, and WAL is switched on afterwards. Marks and tables
  // are then in the main file itself, where check_marks() reads them. A crash before the commit
  // leaves a file without them.
  const std::string pages = "PRAGMA page_size = " + std::to_string(kPageBytes);
  for (const char* set : {pages.c_str(), kGiveSpaceBack, "PRAGMA journal_mode = DELETE"}) {
    if (auto done = database.run(set); !done) return failed(done.error());
  }
  if (auto set = database.run(sync_pragma(sync)); !set) return failed(set.error());
  auto transaction = sql::Transaction::begin(database);
  if (!transaction) return failed(transaction.error());
  if (auto filled = fill(database); !filled) return filled;
  const std::string mark = "PRAGMA application_id=" + std::to_string(kApplicationId);
  if (auto marked = database.run(mark.c_str()); !marked) return failed(marked.error());
  if (auto marked = set_file_format(database, kWorldFormat); !marked) return marked;
  return store_result(transaction->commit());
}

}  // namespace

StoreResult<std::unique_ptr<SqliteBackend>> SqliteBackend::open(const std::string& folder,
                                                                StoreAccess access,
                                                                const SqliteOptions& options,
                                                                FileLock lock) {
  const std::string file = file_in(folder);
  const auto mode =
      access == StoreAccess::read_only ? sql::SqliteMode::read : sql::SqliteMode::write;
  auto opened = sql::open_sqlite(file, mode, options.vfs);
  if (!opened) return failed(opened.error());
  std::unique_ptr<SqliteBackend> backend(
      new SqliteBackend(folder, options.vfs, std::move(lock), *std::move(opened)));
  sql::Database& database = backend->database();
  // A world with a loss is left as it is: closing the database would delete what is left of the WAL.
  backend->keep_on_close(true);
  if (const auto set = set_pragmas(database, access, options.sync); !set)
    return failed(set.error());
  // check_marks() may have read the marks of an interrupted creation, which opening the database
  // has rolled back.
  const auto id = database.integer("PRAGMA application_id");
  if (!id) return failed(id.error());
  if (*id != std::int64_t{kApplicationId}) {
    return store_failure(StoreError::Kind::not_a_world, file,
                         "its creation was interrupted; delete it and create the world again");
  }
  return backend;
}

StoreResult<std::uint32_t> SqliteBackend::format() {
  const auto version = database_.integer("PRAGMA user_version");
  if (!version) return failed(version.error());
  return static_cast<std::uint32_t>(*version);
}

StoreResult<void> SqliteBackend::set_format(std::uint32_t format) {
  return set_file_format(database_, format);
}

StoreResult<std::optional<DurableState>> SqliteBackend::read_mark(const WorldId& world) {
  mark_ = std::make_unique<DurableMark>(folder_, world, vfs_);
  return mark_->read();
}

StoreResult<bool> SqliteBackend::complete_file(bool is_last) {
  // The first column says whether a reader was in the way. SQLite waits for readers as for a lock.
  const auto is_busy = database_.integer(is_last ? "PRAGMA wal_checkpoint(TRUNCATE)"
                                                 : "PRAGMA wal_checkpoint(FULL)");
  if (is_busy) return *is_busy == 0;
  if (is_busy.error().kind == sql::Error::Kind::locked) return false;  // this connection reads
  return failed(is_busy.error());
}

std::string SqliteBackend::missing_files() const {
  // An empty WAL, as SQLite makes it when it opens the file, counts as none.
  const auto has_wal = sql::file_exists(file_in(folder_) + "-wal", vfs_);
  return has_wal && *has_wal ? "world.durable" : "world.sqlite-wal and world.durable";
}

std::string SqliteBackend::mixture_advice() const {
  return "world.sqlite-wal is damaged and hides newer pages of world.sqlite, or another program "
         "changed the log. Put the world's folder back from a backup";
}

void SqliteBackend::keep_on_close(bool keep) { sql::keep_wal_on_close(database_, keep); }

StoreResult<void> SqliteBackend::check() {
  const auto verdict = sql::check_structure(database_);
  if (!verdict) return failed(verdict.error());
  if (*verdict == "ok") return {};
  return failure(StoreError{StoreError::Kind::corrupt, database_.file(), "database", *verdict});
}

StoreResult<void> SqliteBackend::shrink() {
  // A world of an older program can give space back in parts from now on.
  if (auto set = database_.run(kGiveSpaceBack); !set) return failed(set.error());
  if (auto done = database_.run("VACUUM"); !done) return failed(done.error());
  return store_result(database_.run("PRAGMA wal_checkpoint(TRUNCATE)"));
}

StoreResult<FreeSpace> SqliteBackend::free_space() {
  const auto pages = database_.integer("PRAGMA freelist_count");
  if (!pages) return failed(pages.error());
  const auto page_bytes = database_.integer("PRAGMA page_size");
  if (!page_bytes) return failed(page_bytes.error());
  const auto mode = database_.integer("PRAGMA auto_vacuum");
  if (!mode) return failed(mode.error());
  return FreeSpace{static_cast<std::uint64_t>(*pages * *page_bytes), *mode == kIncremental, true};
}

StoreResult<bool> SqliteBackend::give_back(std::uint32_t pages) {
  const auto free = free_space();
  if (!free) return failed(free.error());
  if (!free->can_be_given_back || free->bytes == 0) return false;
  const std::string text = "PRAGMA incremental_vacuum(" + std::to_string(pages) + ")";
  if (auto done = database_.run(text.c_str()); !done) return failed(done.error());
  const auto left = database_.integer("PRAGMA freelist_count");
  if (!left) return failed(left.error());
  return *left > 0;
}

StoreResult<std::unique_ptr<Store>> create_sqlite_world(const std::string& folder,
                                                        const WorldMeta& meta,
                                                        const SqliteOptions& options) {
  if (auto fits = check_new_meta(meta, file_in(folder)); !fits) return failed(fits.error());
  return create_sqlite_world(
      folder, [&](sql::Database& database) { return fill_new_world(database, meta); }, options);
}

StoreResult<std::unique_ptr<Store>> create_sqlite_world(const std::string& folder,
                                                        const FillWorld& fill,
                                                        const SqliteOptions& options) {
  if (const auto checked = check_folder(folder); !checked) return no_folder(checked.error());
  const std::string file = file_in(folder);
  if (const auto made = make_folder(folder, file); !made) return failed(made.error());
  auto lock = take_lock(folder, file);
  if (!lock) return failed(lock.error());
  const auto there = sql::file_exists(file, options.vfs);
  if (!there) return failed(there.error());
  if (*there) return store_failure(StoreError::Kind::exists, file, "is there already");
  const auto wal = sql::file_exists(file + "-wal", options.vfs);
  if (!wal) return failed(wal.error());
  if (*wal) {
    return store_failure(StoreError::Kind::exists, file,
                         "is missing, but its edits in world.sqlite-wal are there: put it back "
                         "beside them, or move them away to begin anew");
  }
  if (options.vfs.empty()) {  // the files of another VFS need not be on the disk
    if (const auto made = make_file(file); !made) return failed(made.error());
  }
  {
    auto database = sql::open_sqlite(file, sql::SqliteMode::create, options.vfs);
    if (!database) return failed(database.error());
    if (const auto written = write_new_world(*database, fill, options.sync); !written) {
      return failed(written.error());
    }
  }
  auto backend = SqliteBackend::open(folder, StoreAccess::read_write, options, *std::move(lock));
  if (!backend) return failed(backend.error());
  auto store = SqlStore::open(*std::move(backend), StoreAccess::read_write);
  if (!store) return failed(store.error());
  return std::unique_ptr<Store>(*std::move(store));
}

StoreResult<std::unique_ptr<Store>> open_sqlite_world(const std::string& folder, StoreAccess access,
                                                      const SqliteOptions& options) {
  if (const auto checked = check_folder(folder); !checked) return no_folder(checked.error());
  const std::string file = file_in(folder);
  const auto there = sql::file_exists(file, options.vfs);
  if (!there) return failed(there.error());
  if (!*there) return store_failure(StoreError::Kind::not_a_world, file, "is not there");
  if (const auto marked = check_marks(file, options.vfs); !marked) return failed(marked.error());
  FileLock lock;
  if (access != StoreAccess::read_only) {
    auto taken = take_lock(folder, file);
    if (!taken) return failed(taken.error());
    lock = *std::move(taken);
  }
  auto backend = SqliteBackend::open(folder, access, options, std::move(lock));
  if (!backend) return failed(backend.error());
  auto store = SqlStore::open(*std::move(backend), access);
  if (!store) return failed(store.error());
  return std::unique_ptr<Store>(*std::move(store));
}

}  // namespace runstone
