#include "server/store/copy_stored_world.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "common/postgres/postgres_database.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "server/store/build_table.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/postgres_backend.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sqlite_backend.hpp"
#include "server/store/store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

struct CopiedTable {
  const char* name;
  int keys;                  // the first columns
  std::string_view columns;  // separated by ", "
};

constexpr std::string_view kChunk = "lod, x, y, z, epoch, seq, digest0, digest1, checksum, data";

// Every table but `meta`, whose columns differ between the databases.
constexpr std::array kCopiedTables = {
    CopiedTable{"edit_log", 2,
                "log, seq, epoch, author, instance, client_seq, time_us, cause, subject, min_x, "
                "min_y, min_z, max_x, max_y, max_z, descriptor, checksum"},
    CopiedTable{"log_box", 1,
                "first_seq, min_x, max_x, min_y, max_y, min_z, max_z, last_seq, author"},
    CopiedTable{"player", 1, "author, key, name, checksum"},
    CopiedTable{"player_instance", 2, "author, instance, decided, last_us, checksum"},
    CopiedTable{"player_name", 2, "author, number, name, checksum"},
    CopiedTable{"name_claim", 1, "folded, name, key, checksum"},
    CopiedTable{"rights_record", 1, "seq, record, checksum"},
    CopiedTable{"base", 4, kChunk},
    CopiedTable{"snapshot", 4, kChunk},
    CopiedTable{"tile", 4, kChunk},
    CopiedTable{"keyframe", 1, "seq, epoch, time_us, chunks, digest0, digest1, checksum"},
    CopiedTable{"keyframe_chunk", 5, "lod, x, y, z, seq, epoch, digest0, digest1, checksum, data"}};

// The tables of a world that has a library.
constexpr std::array kLibraryTables = {
    CopiedTable{"build", 1,
                "number, added_by, file_bytes, content, name, author, tags, record, checksum"},
    CopiedTable{"build_part", 2, "content, part, checksum, data"}};

constexpr std::int64_t kFormatCopied = 4;  // the first one with all tables
// The rows of chunks, and of other tables, that PostgreSQL is asked for at a time.
constexpr int kChunksAtOnce = 64, kRowsAtOnce = 1'024;

/// Returns the first `count` columns.
std::string_view first_columns(std::string_view columns, int count) {
  std::size_t end = 0;
  for (int i = 0; i < count && end != std::string_view::npos; ++i)
    end = columns.find(", ", end == 0 ? 0 : end + 2);
  return columns.substr(0, end);
}

std::string parameters(int count) {
  std::string out;
  for (int i = 1; i <= count; ++i) out += (i > 1 ? ", ?" : "?") + std::to_string(i);
  return out;
}

void bind_column(sql::Statement& into, int parameter, const sql::Statement& row, int column) {
  switch (row.type(column)) {
    case sql::Type::integer:
      into.bind(parameter, row.integer(column));
      break;
    case sql::Type::text:
      into.bind(parameter, row.text(column));
      break;
    case sql::Type::blob:
      into.bind(parameter, row.blob(column));
      break;
    case sql::Type::other:
      break;  // NULL, which a column of a world may not have: the row is refused
  }
}

void bind_value(sql::Statement& into, int parameter, const MetaValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    into.bind(parameter, *integer);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    into.bind(parameter, std::string_view(*text));
  } else {
    into.bind(parameter, ByteView(*std::get_if<Bytes>(&value)));
  }
}

/// Returns the first `count` columns of a row, which are integers or texts.
std::vector<MetaValue> key_of(const sql::Statement& row, int count) {
  std::vector<MetaValue> key;
  for (int i = 0; i < count; ++i) {
    if (row.type(i) == sql::Type::text) {
      key.emplace_back(std::string(row.text(i)));
    } else {
      key.emplace_back(row.integer(i));
    }
  }
  return key;
}

/// Copies rows in the transaction of the caller.
class Copying {
 public:
  Copying(sql::Database& from, sql::Database& to, const CopyProgress& progress)
      : from_(from), to_(to), progress_(progress) {}

  /// Counts the rows of all tables, for the progress.
  StoreResult<void> count_all(std::span<const CopiedTable> tables);
  StoreResult<void> table(const CopiedTable& table);
  StoreResult<void> meta();
  std::uint64_t rows() const { return rows_; }

 private:
  void count_row();

  sql::Database& from_;
  sql::Database& to_;
  const CopyProgress& progress_;
  std::uint64_t rows_ = 0, all_ = 0;
};

StoreResult<void> Copying::table(const CopiedTable& table) {
  const std::string columns(table.columns);
  const std::string keys(first_columns(columns, table.keys));
  int count = 1;
  for (std::size_t at = columns.find(", "); at != std::string::npos;
       at = columns.find(", ", at + 2))
    ++count;
  auto insert = to_.prepare(std::string("INSERT INTO ") + table.name + "(" + columns + ") VALUES(" +
                            parameters(count) + ")");
  if (!insert) return failed(insert.error());
  // PostgreSQL returns all rows of a statement at once, so it is asked for some at a time.
  const int at_once = table.columns.ends_with("data") ? kChunksAtOnce : kRowsAtOnce;
  const bool in_parts = from_.dialect() == sql::Dialect::postgres;
  const std::string select = "SELECT " + columns + " FROM " + table.name;
  const std::string order =
      in_parts ? " ORDER BY " + keys + " LIMIT " + std::to_string(at_once) : std::string();
  auto first = from_.prepare(select + order);
  if (!first) return failed(first.error());
  auto next =
      from_.prepare(select + " WHERE (" + keys + ") > (" + parameters(table.keys) + ")" + order);
  if (!next) return failed(next.error());
  std::vector<MetaValue> key;  // of the last row
  for (int found = at_once; found == at_once;) {
    sql::Statement& rows = key.empty() ? *first : *next;
    rows.reset();
    for (std::size_t i = 0; i < key.size(); ++i) bind_value(rows, static_cast<int>(i + 1), key[i]);
    for (found = 0;; ++found) {
      const auto more = rows.step();
      if (!more) return failed(more.error());
      if (!*more) break;
      for (int i = 0; i < count; ++i) bind_column(*insert, i + 1, rows, i);
      if (auto inserted = insert->run(); !inserted) return failed(inserted.error());
      count_row();
      if (in_parts && found + 1 == at_once) key = key_of(rows, table.keys);
    }
    if (!in_parts) return {};
  }
  return {};
}

StoreResult<void> Copying::meta() {
  auto source = MetaTable::open(from_);
  if (!source) return failed(source.error());
  auto target = MetaTable::open(to_);
  if (!target) return failed(target.error());
  // read_all() leaves these out if they are damaged. A copy must not lack them without a word.
  if (const auto places = source->places(); !places) return failed(places.error());
  if (const auto clock = source->clock(); !clock) return failed(clock.error());
  const auto rows = source->read_all();
  if (!rows) return failed(rows.error());
  for (const auto& [key, value] : *rows) {
    if (key == "open_epoch") continue;  // nobody writes the copy
    if (auto put = target->put(key, value); !put) return put;
    count_row();
  }
  return {};
}

StoreResult<void> Copying::count_all(std::span<const CopiedTable> tables) {
  for (const CopiedTable& table : tables) {
    const auto count = from_.integer(std::string("SELECT count(*) FROM ") + table.name);
    if (!count) return failed(count.error());
    all_ += static_cast<std::uint64_t>(*count);
  }
  return {};
}

void Copying::count_row() {
  ++rows_;
  if (progress_ && rows_ % kRowsAtOnce == 0) progress_(rows_, std::max(rows_, all_));
}

/// Returns true if the world has the tables of a library.
StoreResult<bool> has_library_in(sql::Database& database) {
  auto meta = MetaTable::open(database);
  if (!meta) return failed(meta.error());
  const auto rows = meta->read_all();
  if (!rows) return failed(rows.error());
  return rows->contains(kBuildFoldKey);
}

/// Opens the tables of a world for reading. The store has checked its format and its meta rows.
StoreResult<sql::Database> open_tables(const std::string& place) {
  if (sql::is_postgres_url(place))
    return store_result(sql::open_postgres(place, sql::PostgresMode::read));
  auto database = sql::open_sqlite(place + "/world.sqlite", sql::SqliteMode::read);
  if (!database) return failed(database.error());
  const auto set = database->run("PRAGMA query_only = ON; PRAGMA trusted_schema = OFF");
  if (!set) return failed(set.error());
  const auto format = database->integer("PRAGMA user_version");
  if (!format) return failed(format.error());
  if (*format < kFormatCopied) {
    return failure(StoreError{StoreError::Kind::bad_request, database->file(), "",
                              "is of world format " + std::to_string(*format) +
                                  ": start a server on it once, which converts it"});
  }
  return *std::move(database);
}

}  // namespace

StoreResult<CopiedWorld> copy_stored_world(const std::string& from, const std::string& to,
                                           const CopyProgress& progress) {
  auto original = open_world(from, StoreAccess::read_only);
  if (!original) return failed(original.error());
  if ((*original)->loss()) return failed(*(*original)->loss());
  auto tables = open_tables(from);
  if (!tables) return failed(tables.error());
  CopiedWorld out;
  const auto fill = [&](sql::Database& database) -> StoreResult<void> {
    if (auto made = create_schema(database); !made) return made;
    if (const auto begun = tables->begin_reads(); !begun) return failed(begun.error());
    Copying copying(*tables, database, progress);
    const auto has_library = has_library_in(*tables);
    StoreResult<void> copied;
    if (!has_library) copied = failed(has_library.error());
    std::vector<CopiedTable> copied_tables(kCopiedTables.begin(), kCopiedTables.end());
    if (has_library && *has_library) {
      copied_tables.insert(copied_tables.end(), kLibraryTables.begin(), kLibraryTables.end());
      copied = add_tables_of_library(database);
    }
    if (copied) copied = copying.count_all(copied_tables);
    if (copied) copied = copying.meta();
    for (const CopiedTable& table : copied_tables) {
      if (copied) copied = copying.table(table);
    }
    out.rows = copying.rows();
    if (const auto ended = tables->end_reads(); !ended && copied) return failed(ended.error());
    return copied;
  };
  auto made = sql::is_postgres_url(to) ? create_postgres_world(to, fill, {})
                                       : create_sqlite_world(to, fill, {});
  if (!made) return failed(made.error());
  if (auto sound = (*made)->check(); !sound) return failed(sound.error());
  const auto last = (*made)->last_sequence();
  if (!last) return failed(last.error());
  out.last = *last;
  return out;
}

}  // namespace runstone
