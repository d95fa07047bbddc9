#include "common/postgres/postgres_text.hpp"

#include <algorithm>
#include <cstddef>

#include "common/core/assert.hpp"

namespace runstone::sql {

PostgresText postgres_text(std::string_view sql) {
  PostgresText out;
  int used = 0;
  char quote = 0;
  for (std::size_t i = 0; i < sql.size(); ++i) {
    const char c = sql[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '\'' || c == '"') {
      quote = c;
    }
    if (quote != 0 || c != '?') {
      out.text += c;
      continue;
    }
    std::size_t parameter = 0;
    while (i + 1 < sql.size() && sql[i + 1] >= '0' && sql[i + 1] <= '9')
      parameter = parameter * 10 + static_cast<std::size_t>(sql[++i] - '0');
    RUNSTONE_ASSERT(parameter > 0);
    out.slots.resize(std::max(out.slots.size(), parameter));
    int& slot = out.slots[parameter - 1];
    if (slot == 0) slot = ++used;
    out.text += '$' + std::to_string(slot);
  }
  return out;
}

}  // namespace runstone::sql
