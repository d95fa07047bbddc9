#include "common/postgres/postgres_session.hpp"

#include <libpq-fe.h>
#include <poll.h>

#include <chrono>
#include <optional>
#include <string_view>

namespace runstone::sql {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// A pool that has no session to spare lets the second connection wait.
constexpr milliseconds kAnswerWait{3'000};
// Other programs that use the pool can disturb one comparison.
constexpr int kComparisons = 4;
constexpr const char* kProcess = "SELECT pg_catalog.pg_backend_pid()";
constexpr const char* kBeginAndProcess = "BEGIN; SELECT pg_catalog.pg_backend_pid()";

// They come first, so that no limit ends the statements behind them. LATIN1 as the encoding of the
// client would damage names.
constexpr const char* kSetFirst = "SET statement_timeout = 0; SET client_encoding = 'UTF8'";
// A version of PostgreSQL need not have all of them. Another isolation level would refuse a row that
// was changed after the begin of a statement, such as a lease that was renewed.
constexpr const char* kSetAll =
    "SELECT pg_catalog.set_config(s.name, v.value, false) FROM pg_catalog.pg_settings AS s JOIN "
    "(VALUES ('lock_timeout', '0'), ('idle_in_transaction_session_timeout', '0'), "
    "('idle_session_timeout', '0'), ('transaction_timeout', '0'), "
    "('standard_conforming_strings', 'on'), ('default_transaction_isolation', 'read committed'), "
    "('default_transaction_deferrable', 'off')) AS v(name, value) ON v.name = s.name WHERE "
    "s.setting <> v.value";
constexpr const char* kSetCommit =
    "SELECT pg_catalog.set_config('synchronous_commit', 'on', false) WHERE "
    "pg_catalog.current_setting('synchronous_commit') = 'off'";
constexpr const char* kSetSchema =
    "SELECT pg_catalog.set_config('search_path', "
    "pg_catalog.quote_ident(pg_catalog.current_schema()), false) WHERE "
    "pg_catalog.current_schema() IS NOT NULL";
constexpr const char* kSetRead = "SET default_transaction_read_only = on";
// What the configuration of the server says stays in force, also when it changes: a provider makes a
// database read-only in this way when its disk is nearly full.
constexpr const char* kSetWrite =
    "SELECT pg_catalog.set_config(name, 'off', false) FROM pg_catalog.pg_settings WHERE name = "
    "'default_transaction_read_only' AND source IN ('client', 'global', 'user', 'database', 'database user')";
// PostgreSQL, too, notices that this machine vanished, and gives its locks back.
constexpr const char* kSetKeepalives =
    "SET tcp_keepalives_idle = 5; SET tcp_keepalives_interval = 5; SET tcp_keepalives_count = 2; "
    "SET tcp_user_timeout = 15000";

struct Answer {
  std::optional<std::string> value;  // the first of the last row; nullopt: there is none in time
  std::string error;                 // the text of PostgreSQL; empty: none
};

bool waits_for_input(PGconn* handle, steady_clock::time_point until) {
  const auto left = std::chrono::duration_cast<milliseconds>(until - steady_clock::now()).count();
  if (left <= 0) return false;
  pollfd entry{PQsocket(handle), POLLIN, 0};
  return ::poll(&entry, 1, static_cast<int>(left)) > 0;
}

/// Carries out statements, and waits for kAnswerWait at most.
Answer ask(PGconn* handle, const char* sql) {
  Answer answer;
  if (PQsendQuery(handle, sql) != 1) return {std::nullopt, connection_message(handle)};
  const auto until = steady_clock::now() + kAnswerWait;
  for (;;) {
    while (PQisBusy(handle) == 1) {
      if (!waits_for_input(handle, until)) return {};
      if (PQconsumeInput(handle) != 1) return {std::nullopt, connection_message(handle)};
    }
    const PostgresResult result(PQgetResult(handle));
    if (!result) return answer;
    const ExecStatusType status = PQresultStatus(result.get());
    if (status == PGRES_TUPLES_OK && PQntuples(result.get()) > 0)
      answer.value = PQgetvalue(result.get(), 0, 0);
    if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK)
      answer.error = connection_message(handle);
  }
}

Unexpected<Error> shared_session(const std::string& name, const std::string& why) {
  return {Error{Error::Kind::io, name,
                "a pooler such as pgbouncer answers here, and it does not keep a session for one "
                "program" +
                    why +
                    ": give the address of PostgreSQL itself, or that of a pool with pool_mode = "
                    "session"}};
}

/// Carries out statements without a limit of time. Returns the first value of the last row.
Result<std::string> run(PGconn* handle, const std::string& name, const char* sql) {
  const PostgresResult result(PQexec(handle, sql));
  const ExecStatusType status = PQresultStatus(result.get());
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK)
    return failure(result_error(handle, name, result.get()));
  return std::string(PQntuples(result.get()) > 0 ? PQgetvalue(result.get(), 0, 0) : "");
}

Result<void> check_writable(PGconn* handle, const std::string& name) {
  const auto read_only = run(handle, name, "SHOW transaction_read_only");
  if (!read_only) return failure(read_only.error());
  if (*read_only != "on") return {};
  const auto standby = run(handle, name, "SELECT pg_catalog.pg_is_in_recovery()");
  if (!standby) return failure(standby.error());
  return failure(
      Error{Error::Kind::read_only, name,
            *standby == "t"
                ? "this PostgreSQL is a standby, which takes no writes: give the address of its "
                  "primary, or promote it"
                : "the database takes no writes, because default_transaction_read_only is on in "
                  "the configuration of PostgreSQL: switch it off there, and reload it"});
}

}  // namespace

Result<void> refuse_shared_session(pg_conn* handle, const std::string& name,
                                   const std::function<ConnectionHandle()>& connect) {
  // A pooler has given the connection a key of its own to cancel statements.
  const Answer first = ask(handle, kProcess);
  if (PQstatus(handle) != CONNECTION_OK) return failure(Error{Error::Kind::io, name, first.error});
  if (!first.value || *first.value == std::to_string(PQbackendPID(handle))) return {};
  const ConnectionHandle other = connect();
  if (PQstatus(other.get()) != CONNECTION_OK) return {};
  for (int i = 0; i < kComparisons; ++i) {
    // The transaction of `other` occupies a session. If that is the one of `handle`, or `handle` has
    // another one now, both share a pool of sessions.
    const Answer others = ask(other.get(), kBeginAndProcess);
    if (!others.error.empty()) return shared_session(name, " (" + others.error + ")");
    if (!others.value) return {};  // the pool has no second session, so `handle` keeps the first
    const bool is_shared =
        *others.value == *first.value || ask(handle, kProcess).value != first.value;
    if (is_shared) return shared_session(name, " (pool_mode = transaction)");
    ask(other.get(), "COMMIT");
  }
  return {};
}

Result<void> set_up_session(pg_conn* handle, const std::string& name, PostgresMode mode) {
  const bool writes = mode == PostgresMode::write;
  for (const char* set :
       {kSetFirst, kSetAll, kSetCommit, kSetSchema, writes ? kSetWrite : kSetRead}) {
    if (const auto done = run(handle, name, set); !done) return failure(done.error());
  }
  const auto encoding = run(handle, name, "SHOW server_encoding");
  if (!encoding) return failure(encoding.error());
  if (*encoding != "UTF8") {
    return failure(Error{Error::Kind::io, name,
                         "the encoding of the database is " + *encoding + ", not UTF8"});
  }
  if (!writes) return {};
  if (const auto done = run(handle, name, kSetKeepalives); !done) return failure(done.error());
  return check_writable(handle, name);
}

}  // namespace runstone::sql
