#include "server/repair/found_row.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/edits/descriptor/edit_record.hpp"
#include "server/store/log_table.hpp"
#include "server/store/record_checksum.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

constexpr std::string_view kChunk = "lod, x, y, z, epoch, seq, digest0, digest1, checksum, data";

constexpr std::array kTables = {
    FoundColumns{FoundTable::meta, "meta", "key, value, checksum", "tvi", 2},
    FoundColumns{FoundTable::edit_log, "edit_log",
                 "log, seq, epoch, author, instance, client_seq, time_us, cause, subject, min_x, "
                 "min_y, min_z, max_x, max_y, max_z, descriptor, checksum",
                 "iiiiiiiiiiiiiiibi", 16},
    FoundColumns{FoundTable::player, "player", "author, key, name, checksum", "ibti", 3},
    FoundColumns{FoundTable::player_instance, "player_instance",
                 "author, instance, decided, last_us, checksum", "iiiii", 4},
    FoundColumns{FoundTable::player_name, "player_name", "author, number, name, checksum", "iiti",
                 3},
    FoundColumns{FoundTable::name_claim, "name_claim", "folded, name, key, checksum", "ttbi", 3},
    FoundColumns{FoundTable::rights_record, "rights_record", "seq, record, checksum", "ibi", 2},
    FoundColumns{FoundTable::base, "base", kChunk, "iiiiiiiiib", 8},
    FoundColumns{FoundTable::snapshot, "snapshot", kChunk, "iiiiiiiiib", 8},
    FoundColumns{FoundTable::build, "build",
                 "number, added_by, file_bytes, content, name, author, tags, record, checksum",
                 "iiiitttbi", 8},
    FoundColumns{FoundTable::build_part, "build_part", "content, part, checksum, data", "iiib", 2}};

bool is_of_type(const StoredValue& value, char type) {
  switch (type) {
    case 'i':
      return std::holds_alternative<std::int64_t>(value);
    case 't':
      return std::holds_alternative<std::string>(value);
    case 'b':
      return std::holds_alternative<Bytes>(value);
    default:
      return !std::holds_alternative<std::monostate>(value);
  }
}

bool has_columns_of(const FoundColumns& table, const StoredRow& row) {
  return std::equal(row.begin(), row.end(), table.types.begin(), table.types.end(), is_of_type);
}

/// Returns the checksum of a row as RowChecksum describes it.
std::int64_t row_checksum(const FoundColumns& table, const StoredRow& row) {
  RowChecksum sum(table.name);
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i == table.checksum) continue;
    const bool has_type = table.types[i] == 'v';
    if (const auto* integer = std::get_if<std::int64_t>(&row[i])) {
      if (has_type) sum.text("integer");
      sum.integer(*integer);
    } else if (const auto* text = std::get_if<std::string>(&row[i])) {
      if (has_type) sum.text("text");
      sum.text(*text);
    } else {
      if (has_type) sum.text("blob");
      sum.blob(*std::get_if<Bytes>(&row[i]));
    }
  }
  return sum.value();
}

/// Returns true if the row holds the record of its sequence.
bool is_kept_record(const StoredRow& row) {
  const auto record = decode_record(*std::get_if<Bytes>(&row[1]));
  return record &&
         static_cast<std::int64_t>(record->version.seq) == std::get<std::int64_t>(row[0]) &&
         static_cast<std::int64_t>(record_checksum(*record)) == std::get<std::int64_t>(row[2]);
}

}  // namespace

std::span<const FoundColumns> found_tables() { return kTables; }

const FoundColumns& columns_of(FoundTable table) {
  return *std::ranges::find(kTables, table, &FoundColumns::table);
}

void bind_value(sql::Statement& into, int parameter, const StoredValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    into.bind(parameter, *integer);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    into.bind(parameter, std::string_view(*text));
  } else if (const auto* blob = std::get_if<Bytes>(&value)) {
    into.bind(parameter, ByteView(*blob));
  }
}

StoreResult<RowProof> RowProof::open(sql::Database& database) {
  auto record = database.prepare(
      "SELECT ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16");
  if (!record) return failed(record.error());
  return RowProof(*std::move(record));
}

StoreResult<bool> RowProof::proves(const FoundColumns& table, const StoredRow& row) {
  if (table.table == FoundTable::rights_record) return is_kept_record(row);
  if (table.table != FoundTable::edit_log)
    return std::get<std::int64_t>(row[table.checksum]) == row_checksum(table, row);
  // Log 0 is the only one.
  if (std::get<std::int64_t>(row[0]) != 0 || std::get<std::int64_t>(row[1]) < 1) return false;
  const sql::ResetAtEnd reset_at_end(record_);
  for (std::size_t i = 1; i < row.size(); ++i) bind_value(record_, static_cast<int>(i), row[i]);
  const auto found = record_.step();
  if (!found) return failed(found.error());
  return LogTable::record_in(record_).has_value();
}

StoreResult<std::optional<FoundTable>> RowProof::table_of(const StoredRow& row) {
  for (const FoundColumns& table : kTables) {
    if (!has_columns_of(table, row)) continue;
    const auto proven = proves(table, row);
    if (!proven) return failed(proven.error());
    if (*proven) return std::optional(table.table);
  }
  return std::optional<FoundTable>();
}

std::optional<FoundTable> RowProof::likely_table_of(const StoredRow& row) {
  std::optional<FoundTable> likely;
  for (const FoundColumns& table : kTables) {
    if (!has_columns_of(table, row)) continue;
    // An index of chunks has rows of five integers, too.
    if (likely || table.table == FoundTable::player_instance) return std::nullopt;
    likely = table.table;
  }
  return likely;
}

}  // namespace runstone
