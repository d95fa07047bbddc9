#include "server/store/postgres_lease.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/os/boot_clock.hpp"
#include "common/postgres/postgres_database.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

using std::chrono::milliseconds;

// A world has one lease. The column has room for a world whose parts have different owners.
constexpr const char* kMakeTable =
    "CREATE TABLE IF NOT EXISTS lease(shard BIGINT NOT NULL PRIMARY KEY, owner TEXT NOT NULL, "
    "term BIGINT NOT NULL, expires_us BIGINT NOT NULL, address TEXT NOT NULL DEFAULT '')";
// A table that an older program made has no address.
constexpr const char* kHasAddress =
    "SELECT count(*) FROM lease WHERE to_jsonb(lease)->'address' IS NOT NULL";
constexpr const char* kAddAddress =
    "ALTER TABLE lease ADD COLUMN IF NOT EXISTS address TEXT NOT NULL DEFAULT ''";
constexpr const char* kMakeRow =
    "INSERT INTO lease VALUES(0, '', 0, 0) ON CONFLICT (shard) DO NOTHING";
// clock_timestamp() is the time of the call, now() that of the begin of the transaction.
#define RUNSTONE_NOW_US "(extract(epoch FROM clock_timestamp()) * 1000000)::bigint"
#define RUNSTONE_ROW "SELECT owner, term, expires_us, expires_us - " RUNSTONE_NOW_US
// The address is empty if the table has no such column.
constexpr const char* kRead =
    RUNSTONE_ROW ", coalesce(to_jsonb(lease)->>'address', '') FROM lease WHERE shard = 0";
constexpr const char* kConfirm = RUNSTONE_ROW ", address FROM lease WHERE shard = 0 FOR SHARE";
#undef RUNSTONE_ROW
constexpr const char* kTake =
    // Also in a database that was put back from a backup, no term is given twice.
    "UPDATE lease SET owner = ?1, address = '', term = greatest(term + 1, " RUNSTONE_NOW_US
    "), expires_us = " RUNSTONE_NOW_US " + ?2 WHERE shard = 0 AND expires_us <= " RUNSTONE_NOW_US
    " RETURNING term";
constexpr const char* kRenew = "UPDATE lease SET expires_us = " RUNSTONE_NOW_US
                               " + ?2 WHERE shard = 0 AND term = ?1 RETURNING term";
constexpr const char* kPublish =
    "UPDATE lease SET address = ?2 WHERE shard = 0 AND term = ?1 RETURNING term";
constexpr const char* kRelease = "UPDATE lease SET expires_us = 0 WHERE shard = 0 AND term = ?1";

// An advisory lock has two numbers: ?1, which is kWriterLock or kTakingLock, and that of the schema.
constexpr std::int64_t kWriterLock = kApplicationId;
// A program holds it while it takes the lease. So programs that take the lease at the same time do not end
// each other's connections.
constexpr std::int64_t kTakingLock = kApplicationId + 1;
#define RUNSTONE_SCHEMA \
  "(SELECT oid::int FROM pg_catalog.pg_namespace WHERE nspname = current_schema())"
constexpr const char* kLock = "SELECT pg_try_advisory_lock(?1::bigint::int, " RUNSTONE_SCHEMA ")";
constexpr const char* kUnlock = "SELECT pg_advisory_unlock(?1::bigint::int, " RUNSTONE_SCHEMA ")";
// It looks again whether the lease has run out, because the owner may have renewed it meanwhile.
constexpr const char* kEndHolder =
    "SELECT count(pg_terminate_backend(pid)) FROM pg_catalog.pg_locks WHERE locktype = 'advisory' "
    "AND database = (SELECT oid FROM pg_catalog.pg_database WHERE datname = current_database()) "
    "AND classid = ?1::bigint::oid AND objid = " RUNSTONE_SCHEMA
    "::oid AND objsubid = 2 AND granted AND pid <> pg_backend_pid() AND EXISTS(SELECT 1 FROM lease "
    "WHERE shard = 0 AND expires_us <= " RUNSTONE_NOW_US ")";
constexpr const char* kHasWriter =
    "SELECT count(*) FROM pg_catalog.pg_locks WHERE locktype = 'advisory' AND classid = "
    "?1::bigint::oid AND objid = " RUNSTONE_SCHEMA
    "::oid AND objsubid = 2 AND granted AND pid = ?2::bigint::int";
constexpr const char* kHasTable =
    "SELECT count(*) FROM pg_catalog.pg_class WHERE relname = 'lease' AND "
    "relnamespace = " RUNSTONE_SCHEMA "::oid";
#undef RUNSTONE_SCHEMA
#undef RUNSTONE_NOW_US

constexpr int kLockTries = 50;
// A program holds kTakingLock while take_lock() tries, for half of this time at most. A program that holds it
// for longer does not run, and its connection is ended.
constexpr int kTakingTries = 2 * kLockTries;
constexpr milliseconds kPause{100};

/// The row of the lease.
struct Row {
  std::string owner;
  std::int64_t term = 0, expires_us = 0, left_us = 0;
  std::string address;
};

std::int64_t us_of(milliseconds time) { return std::chrono::microseconds(time).count(); }

std::string name_of(const LeaseTerms& terms) {
  if (!terms.owner.empty()) return terms.owner;
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  return std::string(host.data()) + " (process " + std::to_string(::getpid()) + ")";
}

StoreResult<Row> read_row(sql::Database& database, const char* text) {
  auto row = database.prepare(text);
  if (!row) return failed(row.error());
  const auto is_there = row->step();
  if (!is_there) return failed(is_there.error());
  if (!*is_there) {
    return failure(StoreError{StoreError::Kind::corrupt, database.file(), "lease", "has no row"});
  }
  return Row{std::string(row->text(0)), row->integer(1), row->integer(2), row->integer(3),
             std::string(row->text(4))};
}

/// Returns the first number of the first row of a statement, or nullopt if it has no row.
StoreResult<std::optional<std::int64_t>> number_of(
    sql::Database& database, const char* text, const std::function<void(sql::Statement&)>& bind) {
  auto statement = database.prepare(text);
  if (!statement) return failed(statement.error());
  bind(*statement);
  const auto is_there = statement->step();
  if (!is_there) return failed(is_there.error());
  return *is_there ? std::optional(statement->integer(0)) : std::nullopt;
}

StoreResult<std::optional<std::int64_t>> renewed_term(sql::Database& database, std::int64_t term,
                                                      milliseconds length) {
  return number_of(database, kRenew, [&](sql::Statement& statement) {
    statement.bind(1, term).bind(2, us_of(length));
  });
}

StoreError taken_by(const sql::Database& database, const std::string& owner) {
  return {StoreError::Kind::locked, database.file(), "lease",
          owner + " has taken this world over: this program may not write it any more"};
}

StoreResult<void> make_table(sql::Database& writer) {
  const auto schema = writer.text("SELECT coalesce(current_schema(), '')");
  if (!schema) return failed(schema.error());
  if (schema->empty()) {
    return failure(StoreError{StoreError::Kind::not_a_world, writer.file(), "",
                              "the first schema of its search_path does not exist"});
  }
  // PostgreSQL can refuse this if another program makes the table at the same moment. The table is there
  // at the second try.
  auto made = writer.run(kMakeTable);
  if (!made && writer.is_connected()) made = writer.run(kMakeTable);
  if (!made) return failed(made.error());
  return store_result(writer.run(kMakeRow));
}

StoreResult<std::optional<std::int64_t>> ask_lock(sql::Database& database, const char* text,
                                                  std::int64_t lock) {
  return number_of(database, text, [lock](sql::Statement& statement) { statement.bind(1, lock); });
}

StoreError lock_is_kept(const sql::Database& database, std::int64_t lock) {
  return {StoreError::Kind::locked, database.file(), "lease",
          "another connection keeps the advisory lock " + std::to_string(lock) +
              " of this schema, and does not end"};
}

/// Ends the connection of an owner whose lease has run out, and takes its lock. Returns false if the
/// lease has not run out.
StoreResult<bool> take_lock(sql::Database& writer) {
  for (int i = 0; i < kLockTries; ++i) {
    if (i > 0) std::this_thread::sleep_for(kPause);
    const auto row = read_row(writer, kRead);
    if (!row) return failed(row.error());
    if (row->left_us > 0) return false;
    const auto is_locked = ask_lock(writer, kLock, kWriterLock);
    if (!is_locked) return failed(is_locked.error());
    if (*is_locked != 0) return true;
    if (const auto ended = ask_lock(writer, kEndHolder, kWriterLock); !ended)
      return failed(ended.error());
  }
  return failure(lock_is_kept(writer, kWriterLock));
}

/// Adds the column of the address if the table lacks it. Requires the lock: no transaction of an earlier
/// owner is under way then, which the change of the table would wait for.
StoreResult<void> add_address(sql::Database& writer) {
  // PostgreSQL locks the table also if it has the column. Behind a long backup, for example, that would
  // keep the lease from being renewed.
  const auto is_there = writer.integer(kHasAddress);
  if (!is_there) return failed(is_there.error());
  return *is_there != 0 ? StoreResult<void>() : store_result(writer.run(kAddAddress));
}

/// Takes a lease that has run out, and the lock. Returns the term, or nullopt if it has not run out.
StoreResult<std::optional<std::int64_t>> take_expired(sql::Database& writer,
                                                      const LeaseTerms& terms) {
  const auto is_locked = take_lock(writer);
  if (!is_locked) return failed(is_locked.error());
  if (!*is_locked) return std::optional<std::int64_t>();
  if (const auto added = add_address(writer); !added) return failed(added.error());
  return number_of(writer, kTake, [&](sql::Statement& statement) {
    statement.bind(1, std::string_view(terms.owner)).bind(2, us_of(terms.length));
  });
}

}  // namespace

StoreResult<std::unique_ptr<PostgresLease>> PostgresLease::take(const std::string& url,
                                                                sql::Database& writer,
                                                                const LeaseTerms& terms) {
  if (auto made = make_table(writer); !made) return failed(made.error());
  LeaseTerms own = terms;
  own.owner = name_of(terms);
  std::optional<Row> first;
  int tries = 0;
  for (;;) {
    const auto row = read_row(writer, kRead);
    if (!row) return failed(row.error());
    if (row->left_us > 0) {
      if (!first) first = *row;
      if (!own.waits || row->expires_us > first->expires_us || row->term != first->term) {
        return failure(StoreError{StoreError::Kind::locked, writer.file(), "",
                                  "another program is writing this world: " + row->owner});
      }
      std::this_thread::sleep_for(std::min<std::chrono::microseconds>(
          kPause, std::chrono::microseconds(row->left_us + 1'000)));
      continue;
    }
    const auto is_taking = ask_lock(writer, kLock, kTakingLock);
    if (!is_taking) return failed(is_taking.error());
    if (*is_taking == 0) {
      if (++tries > 2 * kTakingTries) return failure(lock_is_kept(writer, kTakingLock));
      if (tries == kTakingTries) {
        const auto ended = ask_lock(writer, kEndHolder, kTakingLock);
        if (!ended) return failed(ended.error());
      }
      std::this_thread::sleep_for(kPause);
      continue;
    }
    const TimeUs asked_us = boot_now_us();
    const auto term = take_expired(writer, own);
    if (!term) return failed(term.error());
    if (*term) {
      if (const auto unlocked = ask_lock(writer, kUnlock, kTakingLock); !unlocked)
        return failed(unlocked.error());
      const auto process = writer.integer("SELECT pg_backend_pid()");
      if (!process) return failed(process.error());
      return std::unique_ptr<PostgresLease>(
          new PostgresLease(url, **term, *process, std::move(own), asked_us));
    }
    if (const auto unlocked = writer.run("SELECT pg_advisory_unlock_all()"); !unlocked)
      return failed(unlocked.error());
  }
}

PostgresLease::PostgresLease(std::string url, std::int64_t term, std::int64_t writer,
                             LeaseTerms terms, TimeUs asked_us)
    : url_(std::move(url)),
      term_(term),
      writer_(writer),
      terms_(std::move(terms)),
      valid_until_us_(0) {
  on_renewed(asked_us);
  renewals_ = std::thread([this] { run(); });
}

PostgresLease::~PostgresLease() { stop_renewals(); }

void PostgresLease::stop_renewals() {
  {
    const std::lock_guard guard(mutex_);
    is_stopping_ = true;
  }
  stop_.notify_all();
  if (renewals_.joinable()) renewals_.join();
}

bool PostgresLease::is_valid() const { return boot_now_us() < valid_until_us_.load(); }

void PostgresLease::on_renewed(TimeUs asked_us) {
  renewed_us_ = asked_us;
  // A tenth is for clocks of different speed.
  valid_until_us_.store(asked_us + us_of(terms_.length) * 9 / 10);
}

void PostgresLease::watch(std::function<void(const StoreError&)> on_lost) {
  const std::lock_guard guard(mutex_);
  on_lost_ = std::move(on_lost);
  if (lost_ && on_lost_) on_lost_(*lost_);
}

std::optional<milliseconds> PostgresLease::renew() {
  if (!connection_) {
    auto opened = sql::open_postgres(url_, sql::PostgresMode::write);
    if (!opened) return try_again(failed(opened.error()).error);
    connection_ = *std::move(opened);
  }
  const TimeUs asked_us = boot_now_us();
  const auto term = renewed_term(*connection_, term_, terms_.length);
  if (!term) return try_again(term.error());
  if (!*term) {
    const auto row = read_row(*connection_, kRead);
    on_lost(taken_by(*connection_, row ? row->owner : "another program"));
    return std::nullopt;
  }
  const auto has_writer = number_of(*connection_, kHasWriter, [this](sql::Statement& statement) {
    statement.bind(1, kWriterLock).bind(2, writer_);
  });
  if (!has_writer) return try_again(has_writer.error());
  if (*has_writer == 0) {
    on_lost({StoreError::Kind::io, connection_->file(), "lease",
             "the connection that writes this world has ended"});
    return std::nullopt;
  }
  on_renewed(asked_us);
  return terms_.length / 3;
}

std::optional<milliseconds> PostgresLease::try_again(const StoreError& error) {
  connection_.reset();
  // A database that takes no writes gives the lease to nobody else.
  if (error.kind == StoreError::Kind::read_only) return terms_.length / 20;
  const TimeUs alone_us = boot_now_us() - renewed_us_;
  if (terms_.alone_max.count() == 0 || alone_us < us_of(terms_.alone_max))
    return terms_.length / 20;
  on_lost({StoreError::Kind::io, sql::without_password(url_), "lease",
           "the database was not reached for " + std::to_string(alone_us / 1'000'000) +
               " s: another server may own the world"});
  return std::nullopt;
}

void PostgresLease::on_lost(const StoreError& error) {
  const std::lock_guard guard(mutex_);
  valid_until_us_.store(0);
  lost_ = error;
  if (on_lost_) on_lost_(error);
}

void PostgresLease::run() {
  milliseconds pause = terms_.length / 3;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (stop_.wait_for(lock, pause, [this] { return is_stopping_; })) return;
    }
    const auto next = renew();
    if (!next) return;
    pause = *next;
  }
}

StoreResult<void> PostgresLease::confirm(sql::Database& writer) {
  const auto row = read_row(writer, kConfirm);
  if (!row) return failed(row.error());
  if (row->term != term_) return failure(taken_by(writer, row->owner));
  if (row->left_us > 0) return {};
  // is_valid() does not follow, because the caller's transaction may still be rolled back.
  const auto renewed = renewed_term(writer, term_, terms_.length);
  if (!renewed) return failed(renewed.error());
  return {};
}

StoreResult<void> PostgresLease::publish(sql::Database& writer, const std::string& address) {
  const auto term = number_of(writer, kPublish, [&](sql::Statement& statement) {
    statement.bind(1, term_).bind(2, std::string_view(address));
  });
  if (!term) return failed(term.error());
  if (*term) return {};
  const auto row = read_row(writer, kRead);
  if (!row) return failed(row.error());
  return failure(taken_by(writer, row->owner));
}

void PostgresLease::release(sql::Database& writer) {
  stop_renewals();
  valid_until_us_.store(0);
  const auto is_released = [this](sql::Database& database) {
    auto statement = database.prepare(kRelease);
    return statement && statement->bind(1, term_).run();
  };
  // If the writer's connection has ended, the other one may be alive. If not, the lease runs out.
  if (!is_released(writer) && connection_) static_cast<void>(is_released(*connection_));
}

StoreResult<std::optional<LeaseOwner>> LeaseWatch::ask(sql::Database& database) {
  const auto is_there = database.integer(kHasTable);
  if (!is_there) return failed(is_there.error());
  if (*is_there == 0) return std::optional<LeaseOwner>();
  auto row = read_row(database, kRead);
  if (!row) return failed(row.error());
  if (row->left_us <= 0) return std::optional<LeaseOwner>();
  return std::optional(LeaseOwner{std::move(row->owner), std::move(row->address), row->term});
}

StoreResult<std::optional<LeaseOwner>> LeaseWatch::owner() {
  if (!connection_) {
    auto opened = sql::open_postgres(url_, sql::PostgresMode::read);
    if (!opened) return failed(opened.error());
    connection_ = *std::move(opened);
  }
  auto found = ask(*connection_);
  if (!found) connection_.reset();
  return found;
}

}  // namespace runstone
