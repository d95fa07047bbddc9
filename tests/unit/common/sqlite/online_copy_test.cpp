#include "common/sqlite/online_copy.hpp"

#include <sqlite3.h>

#include <catch2/catch.hpp>
#include <string>

#include "common/sqlite/sqlite_file.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr int kPagesPerStep = 10;

/// A database in WAL mode with about 200 pages.
sql::Database filled(const std::string& file) {
  auto database = sql::open_sqlite(file, sql::SqliteMode::create);
  REQUIRE(database.has_value());
  REQUIRE(database->text("PRAGMA journal_mode = WAL").has_value());
  REQUIRE(database
              ->run("CREATE TABLE t(k INTEGER PRIMARY KEY, v BLOB); WITH RECURSIVE n(i) AS (SELECT "
                    "1 UNION ALL SELECT i + 1 FROM n WHERE i < 200) INSERT INTO t SELECT i, "
                    "zeroblob(3000) FROM n")
              .has_value());
  return *std::move(database);
}

/// Changes a row that was copied already, and adds a row.
void write(sql::Database& database) {
  REQUIRE(
      database.run("UPDATE t SET v = x'01' WHERE k = 1; INSERT INTO t(v) VALUES(zeroblob(3000))")
          .has_value());
}

sql::Database opened(const std::string& file, sql::SqliteMode mode) {
  auto database = sql::open_sqlite(file, mode);
  REQUIRE(database.has_value());
  return *std::move(database);
}

}  // namespace

TEST_CASE("a copy under constant writing is of one moment and never begins anew", "[sqlite]") {
  const TempFolder folder;
  auto writer = filled(folder / "a.sqlite");
  {
    auto from = opened(folder / "a.sqlite", sql::SqliteMode::read);
    auto to = opened(folder / "b.sqlite", sql::SqliteMode::create);
    REQUIRE(from.run("BEGIN").has_value());
    const auto pages = from.integer("PRAGMA page_count");
    REQUIRE(pages.has_value());
    auto copy = sql::OnlineCopy::begin(from, to);
    REQUIRE(copy.has_value());
    std::int64_t steps = 1;
    for (auto more = copy->step(kPagesPerStep); *more; more = copy->step(kPagesPerStep), ++steps) {
      REQUIRE(more.has_value());
      CHECK(copy->pages_left() == static_cast<std::uint64_t>(*pages - steps * kPagesPerStep));
      CHECK(copy->page_count() == static_cast<std::uint64_t>(*pages));
      write(writer);
    }
    CHECK(steps == (*pages + kPagesPerStep - 1) / kPagesPerStep);
    CHECK(*writer.integer("SELECT count(*) FROM t") == 200 + steps - 1);
  }
  CHECK(raw_sql(folder / "b.sqlite", "SELECT count(*) FROM t") == "200");
  CHECK(raw_sql(folder / "b.sqlite", "SELECT length(v) FROM t WHERE k = 1") == "3000");
  CHECK(raw_sql(folder / "b.sqlite", "PRAGMA integrity_check") == "ok");
}

TEST_CASE("SQLite begins a copy without a read transaction anew, so begin() refuses it",
          "[sqlite]") {
  const TempFolder folder;
  auto writer = filled(folder / "a.sqlite");
  SECTION("SQLite") {
    sqlite3 *from = nullptr, *to = nullptr;
    REQUIRE(sqlite3_open((folder / "a.sqlite").c_str(), &from) == SQLITE_OK);
    REQUIRE(sqlite3_open((folder / "b.sqlite").c_str(), &to) == SQLITE_OK);
    sqlite3_backup* copy = sqlite3_backup_init(to, "main", from, "main");
    REQUIRE(sqlite3_backup_step(copy, kPagesPerStep) == SQLITE_OK);
    const int left = sqlite3_backup_remaining(copy);
    write(writer);
    REQUIRE(sqlite3_backup_step(copy, kPagesPerStep) == SQLITE_OK);
    CHECK(sqlite3_backup_remaining(copy) >= left);
    sqlite3_backup_finish(copy);
    sqlite3_close(from);
    sqlite3_close(to);
  }
  SECTION("begin()") {
    auto from = opened(folder / "a.sqlite", sql::SqliteMode::read);
    auto to = opened(folder / "b.sqlite", sql::SqliteMode::create);
    const auto copy = sql::OnlineCopy::begin(from, to);
    REQUIRE_FALSE(copy.has_value());
    CHECK(copy.error().what == "has no read transaction to copy");
  }
}
