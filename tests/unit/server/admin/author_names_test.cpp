#include "server/admin/author_names.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a name finds its author, or nobody if several authors have it", "[server]") {
  const AuthorNames names({{3, {}, "ana"}, {4, {}, "bob"}, {9, {}, "bob"}, {12, {}, "bob"}});
  CHECK(names.of(0) == "the server");
  CHECK(names.of(3) == "ana #3");
  CHECK(names.of(9) == "bob #9");
  CHECK(names.of(5) == "#5");
  CHECK(*names.find("ana") == 3);
  REQUIRE_FALSE(names.find("an").has_value());
  CHECK(names.find("an").error() == "nobody of that name has ever built (players lists them)");
  REQUIRE_FALSE(names.find("bob").has_value());
  CHECK(names.find("bob").error() == "several players have that name: #4 #9 #12");
}
