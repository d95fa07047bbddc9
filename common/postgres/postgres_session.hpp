// What a session of PostgreSQL needs before a world may rely on it. Settings of the role, of the
// database and of the address do not matter afterwards, with one exception: a server whose own
// configuration makes it read-only stays read-only.
// Threads: the one that owns the connection.
#pragma once
#include <functional>
#include <string>

#include "common/postgres/postgres_connection.hpp"
#include "common/postgres/postgres_database.hpp"
#include "common/sql/sql_error.hpp"

namespace runstone::sql {

/// Fails (io) if a pooler stands between this program and PostgreSQL and gives the next transaction
/// another session, as pgbouncer does with pool_mode = transaction or statement: locks, settings and
/// prepared statements would get lost. `connect` makes a second connection to the same address.
/// `name` is that of the database in messages.
Result<void> refuse_shared_session(pg_conn* handle, const std::string& name,
                                   const std::function<ConnectionHandle()>& connect);

/// Sets what the session needs:
///   - texts are in UTF-8, and strings have no escapes;
///   - no timeout of statements, locks, transactions or sessions ends anything;
///   - a commit is on disk when it returns;
///   - all tables are in the first schema of the search path;
///   - a session of PostgresMode::read writes nothing.
/// Fails (io) if the database stores texts otherwise than in UTF-8. Fails (read_only) if the mode is
/// `write` and the database takes no writes.
Result<void> set_up_session(pg_conn* handle, const std::string& name, PostgresMode mode);

}  // namespace runstone::sql
