// PostgresBackend: a world in one schema of a PostgreSQL database. docs/edit-log.md, "A world in
// PostgreSQL", describes it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/sql/database.hpp"
#include "server/store/store.hpp"
#include "server/store/world_backend.hpp"

namespace runstone {

/// Do the same as create_world() and open_world() for an address of a PostgreSQL database. The
/// database and the schema must exist.
StoreResult<std::unique_ptr<Store>> create_postgres_world(const std::string& url,
                                                          const WorldMeta& meta);
StoreResult<std::unique_ptr<Store>> create_postgres_world(const std::string& url,
                                                          const FillWorld& fill);
StoreResult<std::unique_ptr<Store>> open_postgres_world(const std::string& url, StoreAccess access);
/// Returns true if the schema holds a world. Fails if the database does not answer.
StoreResult<bool> has_postgres_world(const std::string& url);

class PostgresBackend final : public WorldBackend {
 public:
  explicit PostgresBackend(sql::Database database) : database_(std::move(database)) {}
  /// Gives the writer's lock back at once. PostgreSQL itself does so a little after the connection ends.
  ~PostgresBackend() override;

  sql::Database& database() override { return database_; }
  StoreResult<std::uint32_t> format() override;
  StoreResult<void> set_format() override;
  bool has_mark() const override { return false; }
  StoreResult<std::optional<DurableState>> read_mark(const WorldId&) override {
    return std::optional<DurableState>();
  }
  StoreResult<void> write_mark(const DurableState&) override { return {}; }
  StoreResult<void> sync_mark() override { return {}; }
  std::string mixture_advice() const override;
  void keep_on_close(bool) override {}
  StoreResult<void> check() override { return {}; }  // it has no check that a world could run
  StoreResult<void> shrink() override;

 private:
  sql::Database database_;
};

}  // namespace runstone
