#include "common/postgres/postgres_text.hpp"

#include <catch2/catch.hpp>

#include "common/postgres/postgres_database.hpp"

using namespace runstone;

TEST_CASE("parameters get numbers without gaps, in the order of their first use", "[postgres]") {
  const auto plain = sql::postgres_text("SELECT a FROM t WHERE b = ?1 AND c = ?2");
  CHECK(plain.text == "SELECT a FROM t WHERE b = $1 AND c = $2");
  CHECK(plain.slots == std::vector<int>{1, 2});
  const auto gaps = sql::postgres_text("f(?5, ?4) AND g(?5) AND h = ?12");
  CHECK(gaps.text == "f($1, $2) AND g($1) AND h = $3");
  CHECK(gaps.slots == std::vector<int>{0, 0, 0, 2, 1, 0, 0, 0, 0, 0, 0, 3});
  CHECK(sql::postgres_text("SELECT 1").slots.empty());
}

TEST_CASE("what is in quotes is no parameter", "[postgres]") {
  const auto text = sql::postgres_text("SELECT '?1', \"?2\", 'it''s ?3' WHERE a = ?1");
  CHECK(text.text == "SELECT '?1', \"?2\", 'it''s ?3' WHERE a = $1");
  CHECK(text.slots == std::vector<int>{1});
}

TEST_CASE("an address is shown without its password", "[postgres]") {
  using sql::without_password;
  CHECK(sql::is_postgres_url("postgresql://h/d"));
  CHECK(sql::is_postgres_url("postgres://h/d"));
  CHECK_FALSE(sql::is_postgres_url("folder/postgresql://h"));
  CHECK(without_password("postgresql://h/d") == "postgresql://h/d");
  CHECK(without_password("postgresql://ana@h:1/d") == "postgresql://ana@h:1/d");
  for (const char* url :
       {"postgresql://ana:secret@h:1/d", "postgresql://ana:se:cr%20et@h:1/d",
        "postgresql://ana:se?cret@h:1/d", "postgresql://ana@h:1/d?password=secret",
        "postgresql://ana@h:1/d?sslpassword=secret&password=secret",
        "postgresql://ana@h:1/d?%70assword=secret"}) {
    CAPTURE(url);
    CHECK(without_password(url) == "postgresql://ana@h:1/d");
  }
  CHECK(without_password("postgresql:///d?host=/tmp/a&password=secret&user=ana") ==
        "postgresql://ana@/d?host=/tmp/a");
  CHECK(without_password("postgresql://h/d?options=-csearch_path%3Dvalley") ==
        "postgresql://h/d?options=-csearch_path=valley");
  CHECK(without_password("postgresql://ana:x@h,i:2/d?target_session_attrs=read-write") ==
        "postgresql://ana@h,i:2/d");
  CHECK(without_password("postgresql://h:1,i:2/d") == "postgresql://h:1,i:2/d");
  CHECK(without_password("postgresql:///d?host=h,i&port=5") == "postgresql://h:5,i:5/d");
  CHECK(without_password("postgresql://ana:secre%t@h/d") == "postgresql://...");
  const auto wrong = sql::open_postgres("postgresql://ana:secre%t@h/d", sql::PostgresMode::read);
  REQUIRE_FALSE(wrong.has_value());
  CHECK(wrong.error().what == "is no address like postgresql://USER@HOST:PORT/DATABASE");
}

TEST_CASE("keywords of libpq are written as an address", "[postgres]") {
  using sql::url_of_keywords;
  CHECK(url_of_keywords("host=localhost dbname=x") == "postgresql://localhost/x");
  CHECK(url_of_keywords(" user = ana password=secret host=h port=1 dbname=d") ==
        "postgresql://ana@h:1/d");
  CHECK(url_of_keywords("host=localhost dbname") == "postgresql://...");
  for (const char* other : {"", "world", "a=b", "my host=x", "/srv/host=x", "./host=x", "=x"}) {
    CAPTURE(other);
    CHECK_FALSE(url_of_keywords(other).has_value());
  }
  CHECK(sql::is_readable_url("postgresql://ana:x@h:1/d"));
  CHECK_FALSE(sql::is_readable_url("postgresql://ana:secre%t@h/d"));
}

TEST_CASE("a database that does not answer is an error with its address", "[postgres]") {
  const auto database =
      sql::open_postgres("postgresql://ana:secret@127.0.0.1:1/d", sql::PostgresMode::read);
  REQUIRE_FALSE(database.has_value());
  CHECK(database.error().kind == sql::Error::Kind::io);
  CHECK(database.error().file == "postgresql://ana@127.0.0.1:1/d");
  CHECK(database.error().what.find("secret") == std::string::npos);
  CHECK(database.error().what.find('\n') == std::string::npos);
}
