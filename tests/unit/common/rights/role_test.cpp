#include "common/rights/role.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("names of roles and boxes are short and of few characters", "[rights]") {
  for (const char* good :
       {"a", "builder", "city-2.west_gate", "0", ".", "abcdefghijklmnopqrstuvwxyz012345"}) {
    CAPTURE(good);
    CHECK(is_rights_name(good));
  }
  for (const char* bad : {"", "Builder", "a b", "a\n", "\xc3\xa9", "a/b", "a\"",
                          "abcdefghijklmnopqrstuvwxyz0123456"}) {
    CAPTURE(bad);
    CHECK_FALSE(is_rights_name(bad));
  }
}

TEST_CASE("each built-in role has more rights than the one before", "[rights]") {
  const std::vector<Role> roles = built_in_roles();
  REQUIRE(roles.size() == 5);
  CHECK(roles[0].name == kNobodyRole);
  CHECK(roles[1].name == kVisitorRole);
  CHECK(roles[2].name == kBuilderRole);
  CHECK(roles[3].name == kModeratorRole);
  CHECK(roles[4].name == kAdministratorRole);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    CHECK(is_rights_name(roles[i].name));
    if (i == 0) continue;
    CHECK(roles[i].rights.includes(roles[i - 1].rights));
    CHECK_FALSE(roles[i - 1].rights.includes(roles[i].rights));
  }
  CHECK(roles[0].rights == RightSet{});
  CHECK(roles[1].rights == RightSet{Right::see, Right::chat, Right::look_back});
  CHECK_FALSE(roles[3].rights.has(Right::grant));
  CHECK(roles[4].rights == RightSet::all());
  CHECK(roles[1].claims_max == 0);
  CHECK(roles[2].claims_max == 5);
}

}  // namespace runstone::test
