// PostgresBackend: a world in one schema of a PostgreSQL database. docs/edit-log.md, "A world in
// PostgreSQL", describes it.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/sql/database.hpp"
#include "server/store/lease_terms.hpp"
#include "server/store/postgres_lease.hpp"
#include "server/store/store.hpp"
#include "server/store/world_backend.hpp"

namespace runstone {

/// Create and open a world at the address of a PostgreSQL database, see create_world() and
/// open_world(). The database and the schema must exist.
StoreResult<std::unique_ptr<Store>> create_postgres_world(const std::string& url,
                                                          const WorldMeta& meta,
                                                          const LeaseTerms& lease);
StoreResult<std::unique_ptr<Store>> create_postgres_world(const std::string& url,
                                                          const FillWorld& fill,
                                                          const LeaseTerms& lease);
StoreResult<std::unique_ptr<Store>> open_postgres_world(const std::string& url, StoreAccess access,
                                                        const LeaseTerms& lease);
/// Returns true if the schema holds a world. Fails if the database does not answer.
StoreResult<bool> has_postgres_world(const std::string& url);

class PostgresBackend final : public WorldBackend {
 public:
  /// `lease` is null if the world is open for reading only.
  PostgresBackend(sql::Database database, std::unique_ptr<PostgresLease> lease)
      : database_(std::move(database)), lease_(std::move(lease)) {}
  /// Gives the lease and the writer's lock back at once. PostgreSQL itself frees the lock a little
  /// after the connection ends.
  ~PostgresBackend() override;

  sql::Database& database() override { return database_; }
  bool is_owned() const override { return lease_ && lease_->is_valid(); }
  void watch_ownership(std::function<void(const StoreError&)> on_lost) override;
  /// Requires a world that is open for writing.
  StoreResult<void> publish_address(const std::string& address) override;
  void give_up() override;
  StoreResult<void> confirm_ownership() override;
  StoreResult<std::uint32_t> format() override;
  StoreResult<void> set_format(std::uint32_t format) override;
  bool has_mark() const override { return false; }
  StoreResult<std::optional<DurableState>> read_mark(const WorldId&) override {
    return std::optional<DurableState>();
  }
  StoreResult<void> write_mark(const DurableState&) override { return {}; }
  StoreResult<void> sync_mark() override { return {}; }
  StoreResult<bool> complete_file(bool) override { return true; }
  std::string missing_files() const override { return {}; }
  std::string mixture_advice() const override;
  void keep_on_close(bool) override {}
  StoreResult<void> check() override { return {}; }  // it has no check that a world could run
  StoreResult<void> shrink() override;

 private:
  sql::Database database_;
  std::unique_ptr<PostgresLease> lease_;
};

}  // namespace runstone
