#include "client/cache/cache_database.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "common/sqlite/sqlite_file.hpp"

namespace runstone {
namespace {

constexpr std::int64_t kEvictedAtATime = 64;
constexpr const char* kPragmas =
    "PRAGMA auto_vacuum = INCREMENTAL;"
    "PRAGMA journal_mode = WAL;"
    "PRAGMA synchronous = NORMAL;"
    "PRAGMA journal_size_limit = 4194304;"
    "PRAGMA cell_size_check = ON;";

}  // namespace

CacheDatabase::CacheDatabase(const std::string& file, const char* schema, std::int64_t layout) {
  open(file);
  const std::int64_t found = integer("PRAGMA user_version");
  if (ok() && found != 0 && found != layout) {
    database_.reset();
    remove(file);
    open(file);
  }
  run(kPragmas);
  run(schema);
  run(("PRAGMA user_version = " + std::to_string(layout)).c_str());
}

void CacheDatabase::remove(const std::string& file) {
  std::error_code ignored;
  for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(file + end, ignored);
}

void CacheDatabase::open(const std::string& file) {
  auto opened = sql::open_sqlite(file, sql::SqliteMode::create);
  if (opened) {
    database_ = *std::move(opened);
  } else {
    fail(opened.error());
  }
}

bool CacheDatabase::is_corrupt() const {
  if (ok()) return false;
  switch (failure_->kind) {
    case sql::Error::Kind::corrupt:
    case sql::Error::Kind::constraint:
    // A table or a column is missing: the database belongs to another program, or it is damaged.
    case sql::Error::Kind::bad_statement:
      return true;
    case sql::Error::Kind::io:
    case sql::Error::Kind::full:
    case sql::Error::Kind::read_only:
    case sql::Error::Kind::locked:
      break;
  }
  return false;
}

sql::Statement CacheDatabase::prepare(const char* text) {
  if (!ok()) return {};
  auto prepared = database_->prepare(text);
  if (prepared) return *std::move(prepared);
  fail(prepared.error());
  return {};
}

bool CacheDatabase::step(sql::Statement& statement) {
  if (!ok()) return false;
  const auto row = statement.step();
  if (!row) fail(row.error());
  return row && *row;
}

void CacheDatabase::run(sql::Statement& statement) {
  while (step(statement)) {
  }
  statement.reset();
}

void CacheDatabase::run(const char* text) {
  if (!ok()) return;
  if (const auto done = database_->run(text); !done) fail(done.error());
}

std::int64_t CacheDatabase::integer(const char* text) {
  sql::Statement statement = prepare(text);
  return step(statement) ? statement.integer(0) : 0;
}

std::uint64_t CacheDatabase::evict(sql::Statement& oldest, sql::Statement& drop,
                                   std::uint64_t& bytes, std::uint64_t bytes_max) {
  std::uint64_t dropped = 0;
  while (ok() && bytes > bytes_max) {
    std::vector<std::pair<std::int64_t, std::uint64_t>> rows;
    oldest.bind(1, kEvictedAtATime);
    while (step(oldest))
      rows.emplace_back(oldest.integer(0), static_cast<std::uint64_t>(oldest.integer(1)));
    oldest.reset();
    if (rows.empty()) bytes = 0;
    for (const auto& [id, size] : rows) {
      if (bytes <= bytes_max) break;
      run(drop.bind(1, id));
      bytes -= std::min(bytes, size);
      ++dropped;
    }
  }
  return dropped;
}

}  // namespace runstone
