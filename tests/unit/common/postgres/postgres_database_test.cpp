// These cases need a PostgreSQL server: RUNSTONE_TEST_POSTGRES has its address. scripts/check-postgres
// starts one and runs them.
#include "common/postgres/postgres_database.hpp"

#include <catch2/catch.hpp>

#include "common/sql/transaction.hpp"
#include "tests/support/sql/temp_place.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// A table t(k, i, s, b) in a schema of its own.
struct Bench {
  Bench() {
    REQUIRE(database
                .run("CREATE TABLE t(k BIGINT PRIMARY KEY, i BIGINT, s TEXT, b BYTEA); "
                     "SELECT 1")
                .has_value());
  }
  std::int64_t rows() { return *database.integer("SELECT count(*) FROM t"); }
  sql::Statement prepared(const char* text) {
    auto statement = database.prepare(text);
    if (!statement) FAIL(statement.error().what);
    return *std::move(statement);
  }

  TempPlace place;
  sql::Database database = *sql::open_postgres(place.path(), sql::PostgresMode::write);
};

}  // namespace

TEST_CASE("PostgreSQL gives back what was bound", "[.postgres-server]") {
  Bench bench;
  auto insert = bench.prepared("INSERT INTO t(k, i, s, b) VALUES(?1, ?2, ?3, ?4)");
  const Bytes bytes = {0, 1, 255};
  REQUIRE(insert.bind(1, std::int64_t{1})
              .bind(2, std::int64_t{-7})
              .bind(3, std::string_view("grüße"))
              .bind(4, ByteView(bytes))
              .run()
              .has_value());
  CHECK(bench.database.changes() == 1);
  REQUIRE(insert.bind(1, std::int64_t{2})
              .bind(2, std::numeric_limits<std::int64_t>::min())
              .bind(3, std::string_view())
              .bind(4, ByteView())
              .run()
              .has_value());
  REQUIRE(insert.bind(1, std::int64_t{3}).run().has_value());  // the rest is NULL

  auto read = bench.prepared("SELECT i, s, b FROM t WHERE k >= ?1 ORDER BY k");
  CHECK(read.parameter_count() == 1);
  read.bind(1, std::int64_t{1});
  for (int pass = 0; pass < 2; ++pass) {
    REQUIRE(*read.step());
    CHECK(read.type(0) == sql::Type::integer);
    CHECK(read.integer(0) == -7);
    CHECK(read.type(1) == sql::Type::text);
    CHECK(read.text(1) == "grüße");
    CHECK(read.type(2) == sql::Type::blob);
    CHECK(Bytes(read.blob(2).begin(), read.blob(2).end()) == bytes);
    REQUIRE(*read.step());
    CHECK(read.integer(0) == std::numeric_limits<std::int64_t>::min());
    CHECK(read.type(1) == sql::Type::text);
    CHECK(read.text(1).empty());
    CHECK(read.type(2) == sql::Type::blob);
    CHECK(read.blob(2).empty());
    REQUIRE(*read.step());
    for (int column = 0; column < 3; ++column) CHECK(read.type(column) == sql::Type::other);
    CHECK_FALSE(*read.step());
    CHECK_FALSE(*read.step());
    read.rewind();  // keeps the bound value
  }
  read.reset();
  CHECK_FALSE(*read.step());  // NULL is bound now
}

TEST_CASE("statements of a PostgreSQL connection do not disturb each other", "[.postgres-server]") {
  Bench bench;
  auto insert = bench.prepared("INSERT INTO t(k, i) VALUES(?1, ?2)");
  for (std::int64_t k = 0; k < 10; ++k) REQUIRE(insert.bind(1, k).bind(2, k * k).run().has_value());
  auto outer = bench.prepared("SELECT k FROM t ORDER BY k");
  auto inner = bench.prepared("SELECT i FROM t WHERE k = ?1");
  auto twin = bench.prepared("SELECT k FROM t ORDER BY k");  // the same text
  REQUIRE(*twin.step());
  for (std::int64_t k = 0; k < 10; ++k) {
    REQUIRE(*outer.step());
    const sql::ResetAtEnd reset_at_end(inner);
    REQUIRE(*inner.bind(1, outer.integer(0)).step());
    CHECK(inner.integer(0) == k * k);
  }
  CHECK(twin.integer(0) == 0);
}

TEST_CASE("a transaction of PostgreSQL is committed as a whole or not at all",
          "[.postgres-server]") {
  Bench bench;
  auto insert = bench.prepared("INSERT INTO t(k) VALUES(?1)");
  const auto insert_rows = [&](std::int64_t first, std::int64_t count) {
    for (std::int64_t k = first; k < first + count; ++k)
      REQUIRE(insert.bind(1, k).run().has_value());
  };
  {
    auto transaction = *sql::Transaction::begin(bench.database);
    insert_rows(0, 5'000);  // more than the connection keeps without an answer
    CHECK(bench.rows() == 5'000);
    REQUIRE(transaction.commit().has_value());
  }
  {
    auto transaction = *sql::Transaction::begin(bench.database);
    insert_rows(5'000, 10);
  }
  CHECK(bench.rows() == 5'000);
  SECTION("the error of a statement comes with the next answer") {
    auto transaction = *sql::Transaction::begin(bench.database);
    insert_rows(4'999, 3);  // the first of them is there
    const auto row = insert.bind(1, std::int64_t{6'000}).step();
    REQUIRE_FALSE(row.has_value());
    CHECK(row.error().kind == sql::Error::Kind::constraint);
  }
  SECTION("or with the commit") {
    auto transaction = *sql::Transaction::begin(bench.database);
    insert_rows(4'999, 3);
    const auto committed = transaction.commit();
    REQUIRE_FALSE(committed.has_value());
    CHECK(committed.error().kind == sql::Error::Kind::constraint);
  }
  CHECK(bench.rows() == 5'000);
  insert_rows(7'000, 1);  // the connection goes on
  CHECK(bench.rows() == 5'001);
}

TEST_CASE("joined reads of PostgreSQL see one moment", "[.postgres-server]") {
  Bench bench;
  auto reader = *sql::open_postgres(bench.place.path(), sql::PostgresMode::read);
  const auto count = [&] { return *reader.integer("SELECT count(*) FROM t"); };
  REQUIRE(reader.begin_reads().has_value());
  REQUIRE(reader.begin_reads().has_value());
  CHECK(count() == 0);
  REQUIRE(bench.database.run("INSERT INTO t(k) VALUES(1)").has_value());
  CHECK(count() == 0);
  REQUIRE(reader.end_reads().has_value());
  CHECK(count() == 0);
  REQUIRE(reader.end_reads().has_value());
  CHECK(count() == 1);
  const auto refused = reader.run("INSERT INTO t(k) VALUES(2)");
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().kind == sql::Error::Kind::read_only);
}

TEST_CASE("a connection that ends is an error, and a commit on it is none", "[.postgres-server]") {
  Bench bench;
  auto insert = bench.prepared("INSERT INTO t(k) VALUES(?1)");
  const auto id = *bench.database.integer("SELECT pg_backend_pid()");
  auto transaction = *sql::Transaction::begin(bench.database);
  REQUIRE(insert.bind(1, std::int64_t{1}).run().has_value());
  const std::string ended =
      raw_sql(bench.place.path(), "SELECT pg_terminate_backend(" + std::to_string(id) + ", 5000)");
  REQUIRE(ended == "t");
  const auto committed = transaction.commit();
  REQUIRE_FALSE(committed.has_value());
  CHECK(committed.error().kind == sql::Error::Kind::io);
  CHECK_FALSE(bench.database.integer("SELECT 1").has_value());
  CHECK(raw_sql(bench.place.path(), "SELECT count(*) FROM t") == "0");
}
