#include "server/admin/author_names.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/key_fingerprint.hpp"

using namespace runstone;

TEST_CASE("a name finds its author, or nobody if several authors have it", "[server]") {
  const AuthorNames names({{3, {}, "ana"}, {4, {}, "bob"}, {9, {}, "bob"}, {12, {}, "bob"}}, {});
  CHECK(names.of(0) == "the server");
  CHECK(names.of(3) == "ana #3");
  CHECK(names.of(9) == "bob #9");
  CHECK(names.with_key(9) == "bob #9 " + key_fingerprint({}));
  CHECK(names.with_key(5) == "#5");
  CHECK(names.with_key(0) == "the server");
  CHECK(names.of(5) == "#5");
  CHECK(*names.find("ana") == 3);
  REQUIRE_FALSE(names.find("an").has_value());
  CHECK(names.find("an").error() == "nobody of that name has ever built (players lists them)");
  REQUIRE_FALSE(names.find("bob").has_value());
  CHECK(names.find("bob").error() ==
        "several players have or had that name: bob #4, bob #9, bob #12 (give # and a number)");
}

TEST_CASE("an earlier name finds its author, unless somebody else has or had it too", "[server]") {
  const AuthorNames names({{3, {}, "carl"}, {4, {}, "bob"}, {5, {}, "eve"}},
                          {{3, "ana"}, {3, "carl"}, {4, "bob"}, {5, "dora"}, {5, "bob"}});
  REQUIRE(names.find("ana").has_value());
  CHECK(*names.find("ana") == 3);
  CHECK_FALSE(names.is_in_use("ana", 3));
  CHECK(names.is_in_use("carl", 3));
  CHECK(*names.find("carl") == 3);
  REQUIRE_FALSE(names.find("bob").has_value());
  CHECK(names.find("bob").error() ==
        "several players have or had that name: bob #4, eve #5 (give # and a number)");
}
