#include "server/limits/recent_refusals.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

PublicKey numbered(std::size_t n) {
  return {static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(n >> 8), 1};
}

}  // namespace

TEST_CASE("equal refusals of a player are one row with a count", "[limits]") {
  RecentRefusals refusals;
  refusals.add(numbered(1), "edit: busy", 10);
  refusals.add(numbered(2), "edit: busy", 20);
  refusals.add(numbered(1), "edit: busy", 30);
  refusals.add(numbered(1), "edit: too_large", 40);
  CHECK(refusals.rows() == std::vector<RefusalRow>{{numbered(2), "edit: busy", 1, 20, 20},
                                                   {numbered(1), "edit: busy", 2, 10, 30},
                                                   {numbered(1), "edit: too_large", 1, 40, 40}});
}

TEST_CASE("a player with many refusals loses the oldest of his own rows", "[limits]") {
  RecentRefusals refusals;
  refusals.add(numbered(1), "edit: busy", 1);
  for (std::size_t i = 0; i <= kRefusalRowsOfKeyMax; ++i)
    refusals.add(numbered(2), "edit: box " + std::to_string(i), static_cast<TimeUs>(10 + i));
  const auto rows = refusals.rows();
  CHECK(rows.size() == 1 + kRefusalRowsOfKeyMax);
  CHECK(rows[0].key == numbered(1));
  CHECK(rows[1].what == "edit: box 1");
}

TEST_CASE("of too many players the one refused longest ago is forgotten", "[limits]") {
  RecentRefusals refusals;
  for (std::size_t i = 0; i <= kRefusalRowsMax; ++i)
    refusals.add(numbered(i), "edit: busy", static_cast<TimeUs>(i));
  const auto rows = refusals.rows();
  CHECK(rows.size() == kRefusalRowsMax);
  CHECK(rows.front().key == numbered(1));
}

TEST_CASE("refused joins of many keys do not push out what players did", "[limits]") {
  RecentRefusals refusals;
  refusals.add(numbered(1), "edit: the ground is protected: spawn", 1);
  for (std::size_t i = 2; i < 3 * kRefusalRowsMax; ++i)
    refusals.add(numbered(i), "join: your role is nobody", static_cast<TimeUs>(i));
  const auto rows = refusals.rows();
  CHECK(rows.size() == kRefusalRowsMax);
  CHECK(rows.front().key == numbered(1));
}

}  // namespace runstone::test
