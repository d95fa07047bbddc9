#include "server/store/postgres_backend.hpp"

#include <limits>

#include "common/postgres/postgres_database.hpp"
#include "common/sql/transaction.hpp"
#include "server/store/new_world.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

// Its row tells the world's schema from others, as the marks in the header of an SQLite file do.
constexpr const char* kMakeMark =
    "CREATE TABLE runstone_world(application BIGINT NOT NULL, format BIGINT NOT NULL)";

Unexpected<StoreError> fail_as(StoreError::Kind kind, const sql::Database& database,
                               std::string what) {
  return {{kind, database.file(), "", std::move(what)}};
}

StoreResult<bool> has_world_in(sql::Database& database) {
  const auto count = database.integer(
      "SELECT count(*) FROM pg_catalog.pg_class WHERE relname = 'runstone_world' AND "
      "relnamespace = (SELECT oid FROM pg_catalog.pg_namespace WHERE nspname = current_schema())");
  if (!count) return failed(count.error());
  return *count != 0;
}

StoreResult<std::uint32_t> format_in(sql::Database& database) {
  auto row = database.prepare("SELECT application, format FROM runstone_world");
  if (!row) return failed(row.error());
  const auto is_there = row->step();
  if (!is_there) return failed(is_there.error());
  if (!*is_there || row->integer(0) != std::int64_t{kApplicationId}) {
    return fail_as(StoreError::Kind::not_a_world, database,
                   "the table runstone_world does not name a Runstone world");
  }
  // A number that no program writes counts as a newer format.
  constexpr std::uint32_t kMax = std::numeric_limits<std::uint32_t>::max();
  const std::int64_t format = row->integer(1);
  return format < 0 || format > kMax ? kMax : static_cast<std::uint32_t>(format);
}

StoreResult<sql::Database> connect(const std::string& url, StoreAccess access) {
  return store_result(sql::open_postgres(
      url, access == StoreAccess::read_only ? sql::PostgresMode::read : sql::PostgresMode::write));
}

/// Takes the lease of a world for a connection that writes. It is given back when the backend ends.
StoreResult<std::unique_ptr<PostgresBackend>> owned(const std::string& url, sql::Database database,
                                                    const LeaseTerms& terms) {
  auto lease = PostgresLease::take(url, database, terms);
  if (!lease) return failed(lease.error());
  return std::make_unique<PostgresBackend>(std::move(database), *std::move(lease));
}

StoreResult<std::unique_ptr<Store>> open_in(std::unique_ptr<PostgresBackend> backend,
                                            StoreAccess access) {
  auto store = SqlStore::open(std::move(backend), access);
  if (!store) return failed(store.error());
  return std::unique_ptr<Store>(*std::move(store));
}

}  // namespace

PostgresBackend::~PostgresBackend() { give_up(); }

void PostgresBackend::give_up() {
  if (lease_) lease_->release(database_);
  static_cast<void>(database_.run("SELECT pg_advisory_unlock_all()").has_value());
}

void PostgresBackend::watch_ownership(std::function<void(const StoreError&)> on_lost) {
  if (lease_) lease_->watch(std::move(on_lost));
}

StoreResult<void> PostgresBackend::publish_address(const std::string& address) {
  return lease_->publish(database_, address);
}

StoreResult<void> PostgresBackend::confirm_ownership() { return lease_->confirm(database_); }

StoreResult<std::uint32_t> PostgresBackend::format() { return format_in(database_); }

StoreResult<void> PostgresBackend::set_format(std::uint32_t format) {
  const std::string text = "UPDATE runstone_world SET format = " + std::to_string(format);
  return store_result(database_.run(text.c_str()));
}

std::string PostgresBackend::mixture_advice() const {
  return "another program changed the log. Restore the database from a backup";
}

StoreResult<void> PostgresBackend::shrink() {
  for (const char* table : {"edit_log", "log_box", "base", "snapshot", "keyframe", "keyframe_chunk",
                            "tile", "meta", "player_instance"}) {
    const std::string text = std::string("VACUUM (FULL, ANALYZE) ") + table;
    if (auto done = database_.run(text.c_str()); !done) return failed(done.error());
  }
  return {};
}

StoreResult<std::unique_ptr<Store>> create_postgres_world(const std::string& url,
                                                          const WorldMeta& meta,
                                                          const LeaseTerms& lease) {
  if (auto fits = check_new_meta(meta, sql::without_password(url)); !fits)
    return failed(fits.error());
  return create_postgres_world(
      url, [&](sql::Database& database) { return fill_new_world(database, meta); }, lease);
}

StoreResult<std::unique_ptr<Store>> create_postgres_world(const std::string& url,
                                                          const FillWorld& fill,
                                                          const LeaseTerms& terms) {
  auto connected = connect(url, StoreAccess::read_write);
  if (!connected) return failed(connected.error());
  const auto there = has_world_in(*connected);
  if (!there) return failed(there.error());
  if (*there) return fail_as(StoreError::Kind::exists, *connected, "is there already");
  auto backend = owned(url, *std::move(connected), terms);
  if (!backend) return failed(backend.error());
  sql::Database& database = (*backend)->database();
  {
    auto transaction = sql::Transaction::begin(database);
    if (!transaction) return failed(transaction.error());
    if (auto made = database.run(kMakeMark); !made) return failed(made.error());
    const std::string mark = "INSERT INTO runstone_world VALUES(" + std::to_string(kApplicationId) +
                             ", " + std::to_string(kWorldFormat) + ")";
    if (auto marked = database.run(mark.c_str()); !marked) return failed(marked.error());
    if (auto filled = fill(database); !filled) return failed(filled.error());
    if (auto confirmed = (*backend)->confirm_ownership(); !confirmed)
      return failed(confirmed.error());
    if (auto done = transaction->commit(); !done) return failed(done.error());
  }
  return open_in(*std::move(backend), StoreAccess::read_write);
}

StoreResult<std::unique_ptr<Store>> open_postgres_world(const std::string& url, StoreAccess access,
                                                        const LeaseTerms& terms) {
  auto database = connect(url, access);
  if (!database) return failed(database.error());
  const auto there = has_world_in(*database);
  if (!there) return failed(there.error());
  if (!*there) return fail_as(StoreError::Kind::not_a_world, *database, "holds no Runstone world");
  if (access == StoreAccess::read_only) {
    const auto format = format_in(*database);
    if (!format) return failed(format.error());
    if (auto known = check_format(database->file(), *format); !known) return failed(known.error());
    return open_in(std::make_unique<PostgresBackend>(*std::move(database), nullptr), access);
  }
  auto backend = owned(url, *std::move(database), terms);
  if (!backend) return failed(backend.error());
  const auto format = (*backend)->format();
  if (!format) return failed(format.error());
  const std::string& name = (*backend)->database().file();
  if (auto known = check_format(name, *format); !known) return failed(known.error());
  return open_in(*std::move(backend), access);
}

StoreResult<bool> has_postgres_world(const std::string& url) {
  auto database = connect(url, StoreAccess::read_only);
  if (!database) return failed(database.error());
  return has_world_in(*database);
}

}  // namespace runstone
