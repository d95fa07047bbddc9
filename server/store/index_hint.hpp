// indexed_by: names the index that a statement must use, where the database lets us.
#pragma once
#include <string>

#include "common/sql/database.hpp"

namespace runstone {

/// Returns the part of a statement behind the name of a table. SQLite keeps no statistics of our
/// tables, and a wrong index would read the whole log. PostgreSQL keeps them, and has no such part.
/// Null means the primary key.
inline std::string indexed_by(const sql::Database& database, const char* index) {
  if (database.dialect() == sql::Dialect::postgres) return "";
  return index == nullptr ? " NOT INDEXED" : std::string(" INDEXED BY ") + index;
}

}  // namespace runstone
