#include "server/repair/found_rows.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

std::int64_t integer(const StoredRow& row, std::size_t column) {
  return std::get<std::int64_t>(row[column]);
}

std::string parameters(std::size_t count) {
  std::string out;
  for (std::size_t i = 1; i <= count; ++i) out += (i > 1 ? ", ?" : "?") + std::to_string(i);
  return out;
}

/// Returns the statement that inserts a row, unless its key is there.
std::string insert_text(const FoundColumns& table) {
  const std::string into = std::string(table.name) + "(" + std::string(table.columns) +
                           ") VALUES(" + parameters(table.types.size()) + ")";
  if (table.table != FoundTable::player_instance) return "INSERT OR IGNORE INTO " + into;
  return "INSERT INTO " + into +
         " ON CONFLICT(author, instance) DO UPDATE SET decided = excluded.decided, last_us = "
         "excluded.last_us, checksum = excluded.checksum WHERE excluded.decided > decided";
}

/// Returns true if a row of this table never changes once it is written, so that a row outside the
/// committed pages is as good as one in them.
bool is_lasting(FoundTable table) {
  return table == FoundTable::edit_log || table == FoundTable::player ||
         table == FoundTable::player_instance;
}

/// The rows of `meta` that only rise.
bool only_rises(std::string_view key) {
  constexpr std::array<std::string_view, 3> kRising = {"epoch", "author_max", "log_last"};
  return std::ranges::find(kRising, key) != kRising.end();
}

std::int32_t coordinate(std::int64_t value) {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(value, -kWorldLimit, kWorldLimit));
}

}  // namespace

StoreResult<void> FoundRows::make_library() {
  if (has_library_) return {};
  has_library_ = true;
  return add_tables_of_library(*database_);
}

void FoundRows::add_meta(const StoredRow& row, RowOrigin origin) {
  const std::string& key = std::get<std::string>(row[0]);
  MetaValue value;
  if (const auto* integer_value = std::get_if<std::int64_t>(&row[1])) value = *integer_value;
  if (const auto* text = std::get_if<std::string>(&row[1])) value = *text;
  if (const auto* blob = std::get_if<Bytes>(&row[1])) value = *blob;
  const auto there = meta_.find(key);
  if (only_rises(key) && there != meta_.end()) {
    there->second = std::max(there->second, value);
  } else if (only_rises(key) || (there == meta_.end() && origin == RowOrigin::used)) {
    meta_.insert_or_assign(key, std::move(value));
  }
}

StoreResult<void> FoundRows::add(FoundTable table, const StoredRow& row, RowOrigin origin) {
  if (table == FoundTable::meta) {
    if (origin != RowOrigin::free) add_meta(row, origin);
    return {};
  }
  // A free page may have rows from before a compaction. A record of the log says by its sequence
  // whether it still counts. A watermark only rises and is never deleted, so an older one is a
  // lower bound.
  const bool is_known_when_free =
      table == FoundTable::edit_log || table == FoundTable::player_instance;
  if (origin == RowOrigin::free && !is_known_when_free) return {};
  if (origin == RowOrigin::torn && !is_lasting(table)) return {};
  if (table == FoundTable::build || table == FoundTable::build_part) {
    if (auto made = make_library(); !made) return made;
  }
  auto insert = inserts_.find(table);
  if (insert == inserts_.end()) {
    auto prepared = database_->prepare(insert_text(columns_of(table)));
    if (!prepared) return failed(prepared.error());
    insert = inserts_.emplace(table, *std::move(prepared)).first;
  }
  for (std::size_t i = 0; i < row.size(); ++i)
    bind_value(insert->second, static_cast<int>(i + 1), row[i]);
  if (auto inserted = insert->second.run(); !inserted) return failed(inserted.error());
  if (table == FoundTable::edit_log && origin != RowOrigin::used && database_->changes() != 0)
    doubtful_.emplace(static_cast<Sequence>(integer(row, 1)), origin);
  return {};
}

void FoundRows::add_damaged(FoundTable table, const StoredRow& row) {
  const std::string name = columns_of(table).name;
  if (table != FoundTable::edit_log) {
    const auto* key = std::get_if<std::int64_t>(&row.front());
    const auto* text = std::get_if<std::string>(&row.front());
    damage_.push_back(name + " " +
                      (key != nullptr ? std::to_string(*key)
                       : text         ? *text
                                      : "?") +
                      ": checksum is wrong");
    return;
  }
  damage_.push_back(name + " seq=" + std::to_string(integer(row, 1)) + ": checksum is wrong");
  const std::int64_t author = integer(row, 3);
  UnprovenRecord record;
  if (author > 0 && author <= std::numeric_limits<AuthorId>::max())
    record.author = static_cast<AuthorId>(author);
  record.time_us = integer(row, 6);
  record.box = {
      {coordinate(integer(row, 9)), coordinate(integer(row, 10)), coordinate(integer(row, 11))},
      {coordinate(integer(row, 12)), coordinate(integer(row, 13)), coordinate(integer(row, 14))}};
  unproven_.emplace(static_cast<Sequence>(integer(row, 1)), record);
}

}  // namespace runstone
