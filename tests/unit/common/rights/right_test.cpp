#include "common/rights/right.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("each right has a name that leads back to it", "[rights]") {
  for (std::size_t i = 0; i < kRightCount; ++i) {
    const auto right = static_cast<Right>(i);
    CHECK_FALSE(name_of(right).empty());
    CHECK(right_named(name_of(right)) == right);
  }
  CHECK(name_of(Right::administer) == "administer");
  CHECK_FALSE(right_named("Build").has_value());
  CHECK_FALSE(right_named("").has_value());
}

TEST_CASE("a set of rights holds what was added and not removed", "[rights]") {
  RightSet set{Right::see, Right::build};
  CHECK(set.bits() == 3);
  CHECK(set.has(Right::build));
  CHECK(set.includes({Right::see}));
  CHECK_FALSE(set.includes({Right::see, Right::chat}));
  set.remove(Right::see);
  set.add(Right::administer);
  CHECK(set == RightSet{Right::build, Right::administer});
  CHECK(RightSet::all().bits() == 0xfff);
  CHECK(RightSet::of_bits(set.bits()) == set);
}

}  // namespace runstone::test
