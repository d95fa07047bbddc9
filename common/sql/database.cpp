#include "common/sql/database.hpp"

namespace runstone::sql {

Result<Statement> Database::first_row(std::string_view sql) {
  auto statement = prepare(sql);
  if (!statement) return statement;
  const auto row = statement->step();
  if (!row) return failure(row.error());
  if (!*row) return failure(Error{Error::Kind::corrupt, file(), "has not the row of a query"});
  return statement;
}

Result<std::int64_t> Database::integer(std::string_view sql) {
  const auto row = first_row(sql);
  if (!row) return failure(row.error());
  return row->integer(0);
}

Result<std::string> Database::text(std::string_view sql) {
  const auto row = first_row(sql);
  if (!row) return failure(row.error());
  return std::string(row->text(0));
}

}  // namespace runstone::sql
