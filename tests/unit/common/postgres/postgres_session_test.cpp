// What a session of PostgreSQL keeps, whatever the settings of role, database and address are. The
// cases need servers: RUNSTONE_TEST_POSTGRES has the address of a PostgreSQL server, and
// RUNSTONE_TEST_POOLER that of a pgbouncer, as scripts/check-postgres starts them.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "common/postgres/postgres_database.hpp"
#include "common/sql/transaction.hpp"
#include "tests/support/sql/temp_place.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

using std::chrono::milliseconds;

// Longer than each timeout of hostile().
constexpr milliseconds kPause{400};

/// Returns the address of a place with settings that end statements, transactions and sessions, and
/// damage texts. They are in force as those of a role are.
std::string hostile(const TempPlace& place) {
  std::string url = place.path();
  for (const char* setting :
       {"statement_timeout%3D100", "lock_timeout%3D100",
        "idle_in_transaction_session_timeout%3D100", "idle_session_timeout%3D100",
        "default_transaction_read_only%3Don", "standard_conforming_strings%3Doff",
        "default_transaction_isolation%3Dserializable", "synchronous_commit%3Doff"})
    url += std::string("%20-c") + setting;
  return url + "&client_encoding=LATIN1";
}

sql::Database opened(const std::string& url, sql::PostgresMode mode) {
  auto database = sql::open_postgres(url, mode);
  INFO((database ? std::string() : database.error().what));
  REQUIRE(database.has_value());
  return *std::move(database);
}

/// Returns the address of a pool with this pool_mode.
std::string pool(const std::string& mode) {
  const char* url = std::getenv("RUNSTONE_TEST_POOLER");
  REQUIRE(url != nullptr);
  std::string text = url;
  return text.replace(text.find("POOL"), 4, mode);
}

/// Makes the whole server of PostgreSQL read-only by its configuration while it lives.
class ReadOnlyServer {
 public:
  explicit ReadOnlyServer(std::string url) : url_(std::move(url)) { set("on"); }
  ~ReadOnlyServer() { set("off"); }
  ReadOnlyServer(const ReadOnlyServer&) = delete;
  ReadOnlyServer& operator=(const ReadOnlyServer&) = delete;

 private:
  void set(const std::string& value) {
    raw_sql(url_, "ALTER SYSTEM SET default_transaction_read_only = " + value);
    raw_sql(url_, "SELECT pg_reload_conf()");
    for (int i = 0; i < 1'000 && configured() != value; ++i)
      std::this_thread::sleep_for(milliseconds(10));
    CHECK(configured() == value);
  }
  std::string configured() const {
    return raw_sql(
        url_, "SELECT reset_val FROM pg_settings WHERE name = 'default_transaction_read_only'");
  }
  const std::string url_;
};

}  // namespace

TEST_CASE("no timeout of role, database or address ends a session or a statement",
          "[.postgres-server]") {
  TempPlace place;
  const std::string url = hostile(place);
  auto database = opened(url, sql::PostgresMode::write);
  REQUIRE(database.run("CREATE TABLE t(k BIGINT PRIMARY KEY)").has_value());
  CHECK(database.run("SELECT pg_sleep(0.4)").has_value());
  std::this_thread::sleep_for(kPause);
  {
    auto transaction = *sql::Transaction::begin(database);
    REQUIRE(database.run("INSERT INTO t VALUES(1)").has_value());
    std::this_thread::sleep_for(kPause);
    REQUIRE(transaction.commit().has_value());
  }
  // A lock of another connection is waited for.
  auto other = opened(url, sql::PostgresMode::write);
  REQUIRE(other.run("BEGIN; LOCK TABLE t").has_value());
  std::thread unlock([&] {
    std::this_thread::sleep_for(kPause);
    CHECK(other.run("COMMIT").has_value());
  });
  CHECK(database.run("INSERT INTO t VALUES(2)").has_value());
  unlock.join();
  auto reader = opened(url, sql::PostgresMode::read);
  std::this_thread::sleep_for(kPause);
  CHECK(*reader.integer("SELECT count(*) FROM t") == 2);
}

TEST_CASE("texts are in UTF-8 whatever encoding the address names", "[.postgres-server]") {
  TempPlace place;
  auto database = opened(hostile(place), sql::PostgresMode::write);
  REQUIRE(database.run("CREATE TABLE t(s TEXT)").has_value());
  auto insert = *database.prepare("INSERT INTO t VALUES(?1)");
  REQUIRE(insert.bind(1, std::string_view("grüße")).run().has_value());
  CHECK(*database.integer("SELECT octet_length(s) FROM t") == 7);
  CHECK(*opened(place.path(), sql::PostgresMode::read).text("SELECT s FROM t") == "grüße");
  CHECK(*database.integer("SELECT length('a\\b')") == 3);
}

TEST_CASE("a session has the settings that a world needs", "[.postgres-server]") {
  TempPlace place;
  for (const auto mode : {sql::PostgresMode::write, sql::PostgresMode::read}) {
    auto database = opened(hostile(place), mode);
    const auto setting = [&](const std::string& name) {
      return *database.text("SELECT current_setting('" + name + "')");
    };
    CHECK(setting("synchronous_commit") == "on");
    CHECK(setting("default_transaction_isolation") == "read committed");
    CHECK(setting("default_transaction_read_only") ==
          (mode == sql::PostgresMode::read ? "on" : "off"));
    CHECK(place.path().ends_with(setting("search_path")));
  }
}

TEST_CASE("a server that is read-only by its configuration takes no writes until it is not",
          "[.postgres-server]") {
  TempPlace place;
  auto database = opened(place.path(), sql::PostgresMode::write);
  REQUIRE(database.run("CREATE TABLE t(k BIGINT)").has_value());
  const auto insert = [&] { return database.run("INSERT INTO t VALUES(1)"); };
  {
    const ReadOnlyServer read_only(place.path());
    const auto refused = insert();
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().kind == sql::Error::Kind::read_only);
    const auto writer = sql::open_postgres(place.path(), sql::PostgresMode::write);
    REQUIRE_FALSE(writer.has_value());
    CHECK(writer.error().kind == sql::Error::Kind::read_only);
    CHECK(writer.error().what.find("default_transaction_read_only") != std::string::npos);
    CHECK(sql::open_postgres(place.path(), sql::PostgresMode::read).has_value());
  }
  CHECK(insert().has_value());
}

TEST_CASE("a pooler that does not keep a session is named", "[.postgres-pooler]") {
  for (const char* mode : {"transaction", "statement"}) {
    for (const auto use : {sql::PostgresMode::write, sql::PostgresMode::read}) {
      CAPTURE(mode);
      const auto database = sql::open_postgres(pool(mode), use);
      REQUIRE_FALSE(database.has_value());
      CHECK(database.error().what.find("pgbouncer") != std::string::npos);
      CHECK(database.error().what.find("pool_mode = session") != std::string::npos);
    }
  }
  const auto with_options = sql::open_postgres(pool("transaction") + "&options=-csearch_path%3Dx",
                                               sql::PostgresMode::write);
  REQUIRE_FALSE(with_options.has_value());
  CHECK(with_options.error().what.find("pgbouncer") != std::string::npos);
}

TEST_CASE("a pooler that keeps the session is as good as PostgreSQL", "[.postgres-pooler]") {
  auto database = opened(pool("session"), sql::PostgresMode::write);
  REQUIRE(*database.integer("SELECT pg_try_advisory_lock(7)::int") == 1);
  auto other = opened(pool("session"), sql::PostgresMode::write);
  CHECK(*other.integer("SELECT pg_try_advisory_lock(7)::int") == 0);
  CHECK(*database.integer("SELECT pg_advisory_unlock(7)::int") == 1);
}
