// Opens PostgreSQL databases as sql::Database. This folder is the only one that calls libpq.
//   - Statements are prepared once for each text, and stay prepared.
//   - Parameters and results are binary. The rows of a result are in memory as a whole, so a
//     statement that may have very many rows must be asked for a part of them at a time.
//   - In a write transaction, Statement::run() sends the statement and does not wait for its answer
//     (libpq's pipeline mode). The next call that needs an answer waits for all of them.
// Threads: the one that owns the database. Every call blocks on the network.
#pragma once
#include <string>

#include "common/sql/database.hpp"

namespace runstone::sql {

enum class PostgresMode { read, write };

/// Returns true if a text is the address of a PostgreSQL database: postgresql://...
bool is_postgres_url(const std::string& text);
/// Returns user, host, port, name and options of a database as an address, for messages. It has no
/// password.
std::string without_password(const std::string& url);

/// Connects. `url` is a connection URI of libpq. Fails (io) if nothing answers within 10 s, unless
/// the address has a `connect_timeout` of its own, and if the texts of the database are not in
/// UTF-8. A commit is on disk when it returns, also if the database's `synchronous_commit` is off.
Result<Database> open_postgres(const std::string& url, PostgresMode mode);

}  // namespace runstone::sql
