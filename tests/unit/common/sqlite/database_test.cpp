#include "common/sql/database.hpp"
#include "common/sqlite/sqlite_file.hpp"

#include <catch2/catch.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/sql/transaction.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/fault_vfs.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

sql::Database created(const std::string& file) {
  auto database = sql::open_sqlite(file, sql::SqliteMode::create);
  REQUIRE(database.has_value());
  REQUIRE(database->run("CREATE TABLE t(k INTEGER PRIMARY KEY, v ANY) STRICT").has_value());
  return *std::move(database);
}

std::int64_t rows_of(sql::Database& database) {
  const auto count = database.integer("SELECT count(*) FROM t");
  REQUIRE(count.has_value());
  return *count;
}

}  // namespace

TEST_CASE("a statement gives back what was bound", "[sqlite]") {
  const TempFolder folder;
  auto database = created(folder / "a.sqlite");
  auto insert = database.prepare("INSERT INTO t(v) VALUES(?1)");
  REQUIRE(insert.has_value());
  const Bytes bytes = {0, 1, 255};
  REQUIRE(insert->bind(1, std::int64_t{-7}).run().has_value());
  REQUIRE(insert->bind(1, ByteView(bytes)).run().has_value());
  REQUIRE(insert->bind(1, std::string_view("a\0b", 3)).run().has_value());
  REQUIRE(insert->bind(1, ByteView()).run().has_value());
  REQUIRE(insert->run().has_value());  // run() has cleared the bindings: NULL
  CHECK(database.changes() == 1);

  auto read = database.prepare("SELECT v FROM t WHERE k > ?1 ORDER BY k");
  REQUIRE(read.has_value());
  CHECK(read->parameter_count() == 1);
  read->bind(1, std::int64_t{0});
  for (int pass = 0; pass < 2; ++pass) {
    REQUIRE(*read->step());
    CHECK(read->type(0) == sql::Type::integer);
    CHECK(read->integer(0) == -7);
    REQUIRE(*read->step());
    CHECK(read->type(0) == sql::Type::blob);
    CHECK(Bytes(read->blob(0).begin(), read->blob(0).end()) == bytes);
    REQUIRE(*read->step());
    CHECK(read->type(0) == sql::Type::text);
    CHECK(read->text(0) == std::string_view("a\0b", 3));
    REQUIRE(*read->step());
    CHECK(read->type(0) == sql::Type::blob);
    CHECK(read->blob(0).empty());
    REQUIRE(*read->step());
    CHECK(read->type(0) == sql::Type::other);
    CHECK_FALSE(*read->step());
    read->rewind();  // keeps the bound value
  }
  read->reset();
  CHECK_FALSE(*read->step());  // NULL is bound now, and k > NULL holds for no row
}

TEST_CASE("a failed bind is the error of the next step", "[sqlite]") {
  const TempFolder folder;
  auto database = created(folder / "a.sqlite");
  auto insert = database.prepare("INSERT INTO t(v) VALUES(?1)");
  REQUIRE(insert.has_value());
  CHECK_FALSE(insert->bind(2, std::int64_t{1}).run().has_value());
  CHECK(rows_of(database) == 0);
  CHECK(insert->bind(1, std::int64_t{1}).run().has_value());  // run() has reset the statement
  sql::Statement empty;
  CHECK(empty.bind(1, std::int64_t{1}).step().error().kind == sql::Error::Kind::bad_statement);
  empty.reset();
}

TEST_CASE("a transaction that is not committed leaves nothing", "[sqlite]") {
  const TempFolder folder;
  auto database = created(folder / "a.sqlite");
  {
    auto transaction = sql::Transaction::begin(database);
    REQUIRE(transaction.has_value());
    REQUIRE(database.run("INSERT INTO t(v) VALUES(1)").has_value());
  }
  CHECK(rows_of(database) == 0);
  auto transaction = sql::Transaction::begin(database);
  REQUIRE(transaction.has_value());
  REQUIRE(database.run("INSERT INTO t(v) VALUES(1)").has_value());
  REQUIRE(transaction->commit().has_value());
  CHECK(rows_of(database) == 1);
}

TEST_CASE("nothing is written behind an error that has rolled the transaction back", "[sqlite]") {
  const TempFolder folder;
  auto database = created(folder / "a.sqlite");
  REQUIRE(database.run("INSERT INTO t VALUES(1, 'one')").has_value());
  auto late = database.prepare("INSERT INTO t(v) VALUES('late')");
  REQUIRE(late.has_value());
  {
    auto transaction = sql::Transaction::begin(database);
    REQUIRE(transaction.has_value());
    REQUIRE(database.run("INSERT INTO t VALUES(2, 'two')").has_value());
    // An error of the disk has this effect, too.
    CHECK_FALSE(database.run("INSERT OR ROLLBACK INTO t VALUES(1, 'again')").has_value());
    CHECK_FALSE(database.run("INSERT INTO t VALUES(3, 'three')").has_value());
    const auto refused = late->run();
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().what == "an error before has rolled the transaction back");
    CHECK_FALSE(transaction->commit().has_value());
  }
  CHECK(rows_of(database) == 1);
  CHECK(late->run().has_value());
  CHECK(rows_of(database) == 2);
}

TEST_CASE("errors name the file and their kind", "[sqlite]") {
  const TempFolder folder;
  const std::string file = folder / "a.sqlite";
  auto database = created(file);
  using Kind = sql::Error::Kind;

  const auto missing = database.prepare("SELECT * FROM nowhere");
  REQUIRE_FALSE(missing.has_value());
  CHECK(missing.error().kind == Kind::bad_statement);
  CHECK(missing.error().file == file);
  CHECK(missing.error().what.find("nowhere") != std::string::npos);

  REQUIRE(database.run("INSERT INTO t VALUES(1, 1)").has_value());
  CHECK(database.run("INSERT INTO t VALUES(1, 1)").error().kind == Kind::constraint);
  CHECK(database.integer("SELECT k FROM t WHERE k = 9").error().kind == Kind::corrupt);

  const auto absent = sql::open_sqlite(folder / "none.sqlite", sql::SqliteMode::write);
  REQUIRE_FALSE(absent.has_value());
  CHECK(absent.error().kind == Kind::io);
  CHECK(absent.error().file == folder / "none.sqlite");

  std::ofstream(folder / "text") << std::string(2000, 'x');
  auto text = sql::open_sqlite(folder / "text", sql::SqliteMode::write);
  REQUIRE(text.has_value());
  CHECK(text->integer("SELECT count(*) FROM t").error().kind == Kind::corrupt);
}

TEST_CASE("a database open for reading refuses writes", "[sqlite]") {
  const TempFolder folder;
  const std::string file = folder / "a.sqlite";
  created(file);
  auto database = sql::open_sqlite(file, sql::SqliteMode::read);
  REQUIRE(database.has_value());
  CHECK_FALSE(database->run("INSERT INTO t(v) VALUES(1)").has_value());
  CHECK(rows_of(*database) == 0);
}

TEST_CASE("names with characters of a URI are names of files", "[sqlite]") {
  const TempFolder folder;
  for (const std::string name : {"a?mode=memory", "b#c", "d%41", "e f"}) {
    created(folder / name);
    CHECK(std::filesystem::file_size(folder / name) > 0);
  }
  created("/" + (folder / "twice"));  // the path begins with "//"
  CHECK(std::filesystem::file_size(folder / "twice") > 0);
}

TEST_CASE("the header is read from the main file", "[sqlite]") {
  const TempFolder folder;
  const std::string file = folder / "a.sqlite";
  {
    auto database = created(file);
    REQUIRE(database.run("PRAGMA application_id = 258").has_value());
  }
  auto database = sql::open_sqlite(file, sql::SqliteMode::header);
  REQUIRE(database.has_value());
  const auto header = sql::file_header(*database);
  REQUIRE(header.has_value());
  REQUIRE(header->has_value());
  CHECK((**header)[70] == 1);
  CHECK((**header)[71] == 2);
  std::ofstream(folder / "short") << "SQLite";
  auto shorter = sql::open_sqlite(folder / "short", sql::SqliteMode::header);
  REQUIRE(shorter.has_value());
  const auto none = sql::file_header(*shorter);
  REQUIRE(none.has_value());
  CHECK_FALSE(none->has_value());
}

TEST_CASE("a file is looked up through its VFS", "[sqlite]") {
  const TempFolder folder;
  CHECK_FALSE(*sql::file_exists(folder / "a.sqlite", ""));
  created(folder / "a.sqlite");
  CHECK(*sql::file_exists(folder / "a.sqlite", ""));
  CHECK_FALSE(sql::file_exists(folder / "a.sqlite", "no such vfs").has_value());
}

TEST_CASE("a file that cannot be made or written is named with the error of the disk",
          "[sqlite][faults]") {
  const TempFolder folder;
  created(folder / "there.sqlite");
  FaultVfs vfs;
  const auto opening_error = [&](const std::string& name, sql::SqliteMode mode) {
    const auto opened = sql::open_sqlite(folder / name, mode, FaultVfs::name());
    vfs.heal();
    return opened ? std::string() : opened.error().what;
  };
  vfs.fail(1, EDQUOT, FaultVfs::Lasts::for_ever);
  CHECK(opening_error("new.sqlite", sql::SqliteMode::create) ==
        "cannot be made: Disk quota exceeded (system error " + std::to_string(EDQUOT) + ")");
  vfs.fail(1, EDQUOT, FaultVfs::Lasts::once);
  CHECK(opening_error("new.sqlite", sql::SqliteMode::create) ==
        "cannot be made, but another one can be made there now: try again");
  for (const int system_error : {EROFS, EIO}) {
    vfs.fail(1, system_error, FaultVfs::Lasts::once);
    CHECK(opening_error("there.sqlite", sql::SqliteMode::write) ==
          std::string("cannot be opened for writing: ") + std::strerror(system_error) +
              " (system error " + std::to_string(system_error) + ")");
  }
  CHECK_FALSE(std::filesystem::exists(folder / "new.sqlite-probe"));
}
