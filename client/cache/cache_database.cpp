#include "client/cache/cache_database.hpp"

#include <utility>

#include "common/sqlite/sqlite_file.hpp"

namespace runstone {

CacheDatabase::CacheDatabase(const std::string& file) {
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

}  // namespace runstone
