// SqliteBackend: a world in one SQLite file (WAL, synchronous FULL) in a folder of its own.
// docs/edit-log.md, "The database", describes the files.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/os/file_lock.hpp"
#include "common/sql/database.hpp"
#include "server/store/durable_mark.hpp"
#include "server/store/store.hpp"
#include "server/store/world_backend.hpp"

namespace runstone {

struct SqliteOptions {
  std::string vfs;  // name of an SQLite VFS; empty: the default one
  /// False for one test only: it proves that the power-loss test detects a missing fsync.
  bool sync = true;
};

/// Create and open a world in a folder, with options, see create_world() and open_world().
StoreResult<std::unique_ptr<Store>> create_sqlite_world(const std::string& folder,
                                                        const WorldMeta& meta,
                                                        const SqliteOptions& options);
StoreResult<std::unique_ptr<Store>> create_sqlite_world(const std::string& folder,
                                                        const FillWorld& fill,
                                                        const SqliteOptions& options);
StoreResult<std::unique_ptr<Store>> open_sqlite_world(const std::string& folder, StoreAccess access,
                                                      const SqliteOptions& options);

class SqliteBackend final : public WorldBackend {
 public:
  /// Opens the file. Its marks must be checked before. Fails (not_a_world) if the creation of the
  /// world was interrupted.
  static StoreResult<std::unique_ptr<SqliteBackend>> open(const std::string& folder,
                                                          StoreAccess access,
                                                          const SqliteOptions& options,
                                                          FileLock lock);

  sql::Database& database() override { return database_; }
  StoreResult<std::uint32_t> format() override;
  StoreResult<void> set_format(std::uint32_t format) override;
  bool has_mark() const override { return true; }
  StoreResult<std::optional<DurableState>> read_mark(const WorldId& world) override;
  StoreResult<void> write_mark(const DurableState& state) override { return mark_->write(state); }
  StoreResult<void> sync_mark() override { return mark_->sync(); }
  StoreResult<bool> complete_file(bool is_last) override;
  std::string missing_files() const override;
  std::string mixture_advice() const override;
  void keep_on_close(bool keep) override;
  StoreResult<void> check() override;
  StoreResult<void> shrink() override;
  StoreResult<FreeSpace> free_space() override;
  StoreResult<bool> give_back(std::uint32_t pages) override;

 private:
  SqliteBackend(std::string folder, std::string vfs, FileLock lock, sql::Database database)
      : folder_(std::move(folder)),
        vfs_(std::move(vfs)),
        lock_(std::move(lock)),
        database_(std::move(database)) {}

  const std::string folder_, vfs_;
  FileLock lock_;  // is released after mark and database are closed
  sql::Database database_;
  std::unique_ptr<DurableMark> mark_;
};

}  // namespace runstone
