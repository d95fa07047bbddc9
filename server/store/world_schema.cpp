#include "server/store/world_schema.hpp"

#include <xxhash.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "common/sqlite/sqlite_file.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {

namespace {

// A value is an integer, a text or a blob. PostgreSQL has a column for each.
constexpr const char* kSqliteMeta = R"sql(
CREATE TABLE meta(
  key TEXT NOT NULL PRIMARY KEY,
  value ANY NOT NULL,
  checksum INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
)sql";
constexpr const char* kPostgresMeta = R"sql(
CREATE TABLE meta(
  key TEXT NOT NULL PRIMARY KEY,
  integer_value INTEGER, text_value TEXT, blob_value BLOB,
  checksum INTEGER NOT NULL
);
)sql";

// `edit_log` and `player_instance` have small composite keys and no rowid: the rows lie in the tree
// of the key, and an edit of one voxel costs one cell. Rows of chunks are long, so they have a
// rowid. Their blob is the last column: keys and versions are read without its overflow pages.
constexpr const char* kTables = R"sql(
CREATE TABLE edit_log(
  log INTEGER NOT NULL, seq INTEGER NOT NULL, epoch INTEGER NOT NULL,
  author INTEGER NOT NULL, instance INTEGER NOT NULL, client_seq INTEGER NOT NULL,
  time_us INTEGER NOT NULL, cause INTEGER NOT NULL, subject INTEGER NOT NULL,
  min_x INTEGER NOT NULL, min_y INTEGER NOT NULL, min_z INTEGER NOT NULL,
  max_x INTEGER NOT NULL, max_y INTEGER NOT NULL, max_z INTEGER NOT NULL,
  descriptor BLOB NOT NULL,
  checksum INTEGER NOT NULL,
  PRIMARY KEY(log, seq)
) STRICT, WITHOUT ROWID;
CREATE TABLE player(
  author INTEGER NOT NULL PRIMARY KEY,
  key BLOB NOT NULL UNIQUE,
  name TEXT NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
CREATE TABLE player_instance(
  author INTEGER NOT NULL, instance INTEGER NOT NULL,
  decided INTEGER NOT NULL, last_us INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  PRIMARY KEY(author, instance)
) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kPlayerNames = R"sql(
CREATE TABLE player_name(
  author INTEGER NOT NULL, number INTEGER NOT NULL,
  name TEXT NOT NULL,
  checksum INTEGER NOT NULL,
  PRIMARY KEY(author, number)
) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kNameClaims = R"sql(
CREATE TABLE name_claim(
  folded TEXT NOT NULL PRIMARY KEY,
  name TEXT NOT NULL,
  key BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRightsRecords = R"sql(
CREATE TABLE rights_record(
  seq INTEGER NOT NULL PRIMARY KEY,
  record BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
)sql";

// The columns of the tables `base`, `snapshot` and `tile`, which have a row for each chunk or tile. The
// table `tile` is a cache, so `meta` does not count its rows.
constexpr const char* kChunkColumns = R"sql((
  lod INTEGER NOT NULL, x INTEGER NOT NULL, y INTEGER NOT NULL, z INTEGER NOT NULL,
  epoch INTEGER NOT NULL, seq INTEGER NOT NULL,
  digest0 INTEGER NOT NULL, digest1 INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  data BLOB NOT NULL,
  PRIMARY KEY(lod, x, y, z)
) STRICT;
)sql";

// There is no index by time. Times never fall within an era (log_eras), so a time is found by
// bisection.
// Nearly every edit has cause player, so the index by cause holds the others only.
constexpr const char* kIndexes = R"sql(
CREATE INDEX edit_log_author ON edit_log(author, seq);
CREATE INDEX edit_log_cause ON edit_log(cause, seq) WHERE cause <> 0;
)sql";

// An index in space of the log, see segment_table.hpp.
constexpr const char* kSqliteBoxes = R"sql(
CREATE VIRTUAL TABLE log_box USING rtree_i32(
  first_seq, min_x, max_x, min_y, max_y, min_z, max_z, +last_seq INTEGER, +author INTEGER
);
)sql";
constexpr const char* kPostgresBoxes = R"sql(
CREATE TABLE log_box(
  first_seq INTEGER NOT NULL PRIMARY KEY,
  min_x INTEGER NOT NULL, max_x INTEGER NOT NULL,
  min_y INTEGER NOT NULL, max_y INTEGER NOT NULL,
  min_z INTEGER NOT NULL, max_z INTEGER NOT NULL,
  last_seq INTEGER NOT NULL, author INTEGER NOT NULL
);
CREATE INDEX log_box_space ON log_box USING gist(
  int8range(min_x, max_x, '[]'), int8range(min_y, max_y, '[]'), int8range(min_z, max_z, '[]')
);
)sql";

// The index holds all columns of a row but checksum and voxels: the chunks of a moment are listed
// without a page of voxels.
constexpr const char* kKeyframes = R"sql(
CREATE TABLE keyframe(
  seq INTEGER NOT NULL PRIMARY KEY,
  epoch INTEGER NOT NULL, time_us INTEGER NOT NULL, chunks INTEGER NOT NULL,
  digest0 INTEGER NOT NULL, digest1 INTEGER NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
CREATE TABLE keyframe_chunk(
  lod INTEGER NOT NULL, x INTEGER NOT NULL, y INTEGER NOT NULL, z INTEGER NOT NULL,
  seq INTEGER NOT NULL, epoch INTEGER NOT NULL,
  digest0 INTEGER NOT NULL, digest1 INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  data BLOB NOT NULL,
  PRIMARY KEY(lod, x, y, z, seq)
) STRICT;
CREATE INDEX keyframe_chunk_digest ON keyframe_chunk(seq, lod, x, y, z, epoch, digest0, digest1);
)sql";

// A file is written before the row of its build, so its parts have a number of their own. The blob is
// the last column: checksums are read without its overflow pages.
constexpr const char* kLibrary = R"sql(
CREATE TABLE build(
  number INTEGER NOT NULL PRIMARY KEY,
  added_by INTEGER NOT NULL, file_bytes INTEGER NOT NULL, content INTEGER NOT NULL UNIQUE,
  name TEXT NOT NULL, author TEXT NOT NULL, tags TEXT NOT NULL,
  record BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
CREATE TABLE build_part(
  content INTEGER NOT NULL, part INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  data BLOB NOT NULL,
  PRIMARY KEY(content, part)
) STRICT;
)sql";
// Builds are found without their records. PostgreSQL has no index of such long rows, and reads the
// table.
constexpr const char* kSqliteLibrary = R"sql(
CREATE INDEX build_search ON build(number, name, author, tags);
)sql";

/// Replaces whole words that PostgreSQL writes otherwise.
std::string in_postgres(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> kWords[] = {
      {" STRICT, WITHOUT ROWID", ""},
      {" STRICT", ""},
      {"INTEGER", "BIGINT"},
      {"BLOB", "BYTEA"},
      {"TEXT", "TEXT COLLATE \"C\""}};
  std::string out(text);
  for (const auto& [from, to] : kWords) {
    for (std::size_t at = out.find(from); at != std::string::npos;
         at = out.find(from, at + to.size()))
      out.replace(at, from.size(), to);
  }
  return out;
}

/// Runs statements that are written for SQLite.
StoreResult<void> run_in_dialect(sql::Database& database, const std::string& text) {
  if (database.dialect() == sql::Dialect::sqlite) return store_result(database.run(text.c_str()));
  return store_result(database.run(in_postgres(text).c_str()));
}

StoreResult<void> make_chunk_table(sql::Database& database, const char* name) {
  return run_in_dialect(database, std::string("CREATE TABLE ") + name + kChunkColumns);
}

}  // namespace

StoreResult<void> create_schema(sql::Database& database) {
  const bool is_sqlite = database.dialect() == sql::Dialect::sqlite;
  for (const char* part : {is_sqlite ? kSqliteMeta : kPostgresMeta, kTables, kPlayerNames, kIndexes,
                           is_sqlite ? kSqliteBoxes : kPostgresBoxes, kKeyframes}) {
    if (auto made = run_in_dialect(database, part); !made) return made;
  }
  for (const char* name : {"base", "snapshot"}) {
    if (auto made = make_chunk_table(database, name); !made) return made;
  }
  if (auto made = add_tables_of_format_3(database); !made) return made;
  return add_tables_of_format_4(database);
}

StoreResult<void> add_tables_of_format_3(sql::Database& database) {
  for (const char* table : {kNameClaims, kRightsRecords}) {
    if (auto made = run_in_dialect(database, table); !made) return made;
  }
  return {};
}

StoreResult<void> add_tables_of_format_4(sql::Database& database) {
  return make_chunk_table(database, "tile");
}

StoreResult<void> add_tables_of_library(sql::Database& database) {
  if (auto made = run_in_dialect(database, kLibrary); !made) return made;
  if (database.dialect() != sql::Dialect::sqlite) return {};
  return run_in_dialect(database, kSqliteLibrary);
}

StoreResult<void> check_format(const std::string& file, std::uint32_t version) {
  const auto fail_as = [&](StoreError::Kind kind, std::string what) {
    return failure(StoreError{kind, file, "", std::move(what)});
  };
  if (version > kWorldFormatNewest) {
    return fail_as(StoreError::Kind::newer_version,
                   "is of world format " + std::to_string(version) +
                       "; this program knows format " + std::to_string(kWorldFormatNewest) +
                       ". Nothing was changed.");
  }
  if (version == 1) {
    return fail_as(StoreError::Kind::bad_request,
                   "is of world format 1; this program knows format " +
                       std::to_string(kWorldFormat) +
                       ". The runstone-replay that is as old as the world can export its log, and "
                       "`runstone-replay import` of this program makes a world of it. Nothing was "
                       "changed.");
  }
  if (version < kWorldFormatConverted)
    return fail_as(StoreError::Kind::corrupt, "names world format " + std::to_string(version));
  return {};
}

StoreResult<void> check_marks(const std::string& file, const std::string& vfs) {
  const auto fail_as = [&](StoreError::Kind kind, std::string what) {
    return failure(StoreError{kind, file, "", std::move(what)});
  };
  // A disk that does not answer says nothing about the file.
  auto database = sql::open_sqlite(file, sql::SqliteMode::header, vfs);
  if (!database) return fail_as(StoreError::Kind::io, "cannot be opened: " + database.error().what);
  // The bytes are read directly, without a PRAGMA: after a crash during a checkpoint the main file
  // is not valid until its WAL is applied. The marks are in it even then, because they were written
  // before the WAL existed.
  const auto read = sql::file_header(*database);
  if (!read) return failed(read.error());
  const std::optional<sql::SqliteHeader>& header = *read;
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  const auto big_endian = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | (*header)[i];
    return value;
  };
  const bool is_sqlite = header && std::equal(kMagic.begin(), kMagic.end(), header->begin(),
                                              [](char a, std::uint8_t b) {
                                                return static_cast<std::uint8_t>(a) == b;
                                              });
  // SQLite writes the first page when the creation of a world sets how free pages are given back,
  // before the transaction that writes tables and marks. A database of one page has no table.
  if (is_sqlite && big_endian(68) == 0 && big_endian(28) == 1) {
    return fail_as(StoreError::Kind::not_a_world,
                   "its creation was interrupted; delete it and create the world again");
  }
  if (!is_sqlite || big_endian(68) != kApplicationId)
    return fail_as(StoreError::Kind::not_a_world, "is not a Runstone world");
  return check_format(file, big_endian(60));
}

RowChecksum& RowChecksum::integer(std::int64_t value) {
  ByteWriter(bytes_).u64(static_cast<std::uint64_t>(value));
  return *this;
}

RowChecksum& RowChecksum::blob(ByteView value) {
  ByteWriter writer(bytes_);
  writer.u64(value.size());
  writer.bytes(value);
  return *this;
}

RowChecksum& RowChecksum::text(std::string_view value) {
  return blob({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
}

std::int64_t RowChecksum::value() const {
  return static_cast<std::int64_t>(XXH3_64bits(bytes_.data(), bytes_.size()));
}

}  // namespace runstone
