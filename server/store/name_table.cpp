#include "server/store/name_table.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

std::int64_t name_checksum(std::int64_t author, std::int64_t number, std::string_view name) {
  return RowChecksum("player_name").integer(author).integer(number).text(name).value();
}

}  // namespace

StoreResult<NameTable> NameTable::open(sql::Database& database) {
  const std::string row = "SELECT author, number, name, checksum FROM player_name";
  auto all = database.prepare(row + " ORDER BY author, number");
  if (!all) return failed(all.error());
  auto by_author = database.prepare(row + " WHERE author = ?1 ORDER BY number");
  if (!by_author) return failed(by_author.error());
  auto insert = database.prepare(
      "INSERT INTO player_name(author, number, name, checksum) VALUES(?1, ?2, ?3, ?4)");
  if (!insert) return failed(insert.error());
  auto drop = database.prepare("DELETE FROM player_name WHERE author = ?1 AND number <= ?2");
  if (!drop) return failed(drop.error());
  return NameTable(database.file(), *std::move(all), *std::move(by_author), *std::move(insert),
                   *std::move(drop));
}

StoreResult<UsedName> NameTable::name_of(const sql::Statement& row) const {
  const std::int64_t author = row.integer(0);
  const std::int64_t number = row.integer(1);
  const std::string name(row.text(2));
  if (row.integer(3) != name_checksum(author, number, name) || author < 1 ||
      author > std::numeric_limits<AuthorId>::max()) {
    return failure(StoreError{
        StoreError::Kind::corrupt, file_,
        "player_name author=" + std::to_string(author) + " number=" + std::to_string(number),
        "checksum is wrong"});
  }
  return UsedName{static_cast<AuthorId>(author), name};
}

StoreResult<std::vector<UsedName>> NameTable::names() {
  const sql::ResetAtEnd reset_at_end(all_);
  std::vector<UsedName> names;
  for (;;) {
    const auto more = all_.step();
    if (!more) return failed(more.error());
    if (!*more) return names;
    auto name = name_of(all_);
    if (!name) return failed(name.error());
    names.push_back(*std::move(name));
  }
}

StoreResult<std::int64_t> NameTable::add(const UsedName& name) {
  std::vector<std::int64_t> numbers;
  {
    const sql::ResetAtEnd reset_at_end(by_author_);
    by_author_.bind(1, std::int64_t{name.author});
    for (;;) {
      const auto more = by_author_.step();
      if (!more) return failed(more.error());
      if (!*more) break;
      const auto used = name_of(by_author_);
      if (!used) return failed(used.error());
      if (used->name == name.name) return std::int64_t{0};
      numbers.push_back(by_author_.integer(1));
    }
  }
  const std::int64_t number = numbers.empty() ? 1 : numbers.back() + 1;
  const auto inserted = insert_.bind(1, std::int64_t{name.author})
                            .bind(2, number)
                            .bind(3, std::string_view(name.name))
                            .bind(4, name_checksum(name.author, number, name.name))
                            .run();
  if (!inserted) return failed(inserted.error());
  const std::int64_t last_dropped = number - kNamesPerAuthorMax;
  const auto dropped = drop_.bind(1, std::int64_t{name.author}).bind(2, last_dropped).run();
  if (!dropped) return failed(dropped.error());
  return 1 - std::count_if(numbers.begin(), numbers.end(),
                           [&](std::int64_t one) { return one <= last_dropped; });
}

}  // namespace runstone
