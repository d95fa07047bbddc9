// Translation of the texts of statements to the parameters of PostgreSQL.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace runstone::sql {

struct PostgresText {
  std::string text;        // with $1, $2 and so on, without gaps
  std::vector<int> slots;  // by parameter, from 0: its number in `text`, or 0 if it is not there
};

/// Translates a text with parameters `?1`, `?2` and so on. What is in quotes stays as it is.
PostgresText postgres_text(std::string_view sql);

}  // namespace runstone::sql
