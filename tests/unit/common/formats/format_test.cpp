#include "common/formats/format.hpp"

#include <catch2/catch.hpp>

#include "tests/support/formats/luanti_bytes.hpp"

using namespace runstone;

TEST_CASE("a format is found by the end of a path", "[formats]") {
  const Format* luanti = format_of_file("worlds/valley/map.sqlite");
  REQUIRE(luanti != nullptr);
  CHECK(luanti->name == "luanti");
  CHECK(format_of_file("worlds/valley/map.sqlite-wal") == nullptr);
  CHECK(format_of_file("") == nullptr);
}

TEST_CASE("every format that is read rejects no bytes and passes the error of a sink on", "[formats]") {
  int pieces = 0;
  const auto stop = [&](ForeignPiece&&) -> Result<void> {
    ++pieces;
    return fail(ErrorCode::not_permitted, "stop");
  };
  for (const Format& format : formats()) {
    CAPTURE(format.name);
    if (format.read == nullptr) continue;  // only written
    CHECK_FALSE(format.read({}, stop).has_value());
    CHECK(pieces == 0);
  }
  test::LuantiBlockFields fields;
  fields.names = {{7, "default:stone"}};
  fields.nodes.assign(4096, 7);
  const auto read = format_of_file("map.sqlite")->read(test::luanti_row(fields), stop);
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error().code == ErrorCode::not_permitted);
  CHECK(pieces == 1);
}
