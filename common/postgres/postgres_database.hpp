// Opens PostgreSQL databases as sql::Database. This folder is the only one that calls libpq.
//   - Statements are prepared once for each text, and stay prepared.
//   - Parameters and results are binary. The rows of a result are in memory as a whole, so a
//     statement that may have very many rows must be asked for a part of them at a time.
//   - In a write transaction, Statement::run() sends the statement and does not wait for its answer
//     (libpq's pipeline mode). The next call that needs an answer waits for all of them.
// Threads: the one that owns the database. Every call blocks on the network.
#pragma once
#include <optional>
#include <string>

#include "common/sql/database.hpp"

namespace runstone::sql {

enum class PostgresMode { read, write };

/// Returns true if a text is the address of a PostgreSQL database: postgresql://...
bool is_postgres_url(const std::string& text);
/// Returns true if libpq can read an address.
bool is_readable_url(const std::string& url);
/// Returns the address, without a password, that says the same as the keywords of libpq, such as
/// "host=localhost dbname=valley". Returns nullopt if the text does not begin with such a keyword.
std::optional<std::string> url_of_keywords(const std::string& text);
/// Returns user, host, port, name and options of a database as an address, for messages. It has no
/// password.
std::string without_password(const std::string& url);

/// Connects, and sets what a world needs (set_up_session()). `url` is a connection URI of libpq.
/// Fails (io) if nothing answers within 10 s, unless the address has a `connect_timeout` of its
/// own, if the texts of the database are not in UTF-8, and if a pooler does not keep the session.
/// Fails (read_only) if the mode is `write` and the database takes no writes.
Result<Database> open_postgres(const std::string& url, PostgresMode mode);

}  // namespace runstone::sql
