// What a correction of the time changes in the rights of a world.
#include <catch2/catch.hpp>

#include "common/rights/change_rules.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kHour = TimeUs{3'600} * 1'000'000;
constexpr TimeUs kRight = 1'000'000 * kHour;     // the right time
constexpr TimeUs kAhead = 2 * 365 * 24 * kHour;  // of the wrong clock
constexpr TimeUs kWrong = kRight + kAhead;
const PublicKey kMole{1}, kCrow{2};
const AddressRange kNet{AddressBlock{0}, 40};

struct WrongWorld {
  void make(const RightsChange& change, TimeUs now_us) {
    records.push_back({change, {++seq, 0, now_us}});
    state.apply(change, records.back().origin);
  }
  TimeUs end_of(RestrictionKind kind, const RestrictionSubject& subject) const {
    const auto* found = state.find_restriction(kind, subject);
    REQUIRE(found != nullptr);
    return found->value.until_us;
  }
  RightsState state;
  std::vector<RightsRecord> records;
  Sequence seq = 0;
};

}  // namespace

TEST_CASE("what a wrong clock gave ends after the time that was left, and nothing else moves",
          "[rights][clock]") {
  WrongWorld world;
  world.make(Restrict{RestrictionKind::freeze, kCrow, kRight + kHour, ""}, kRight - kHour);
  world.make(Restrict{RestrictionKind::ban, kMole, kWrong + kHour, ""}, kWrong);
  world.make(Restrict{RestrictionKind::ban, kNet, kWrong + 2 * kHour, ""}, kWrong);
  world.make(Restrict{RestrictionKind::mute, kMole, 0, ""}, kWrong);
  world.make(CreateInvite{{7, kBuilderRole, 2, kWrong + 3 * kHour}}, kWrong);
  world.make(CorrectTime{kAhead}, kRight + kHour / 2);
  CHECK(world.end_of(RestrictionKind::freeze, kCrow) == kRight + kHour);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kRight + kHour);
  CHECK(world.end_of(RestrictionKind::ban, kNet) == kRight + 2 * kHour);
  CHECK(world.end_of(RestrictionKind::mute, kMole) == 0);  // until it is lifted
  CHECK(world.state.usable_invite(7, kRight + 3 * kHour - 1) != nullptr);
  CHECK(world.state.usable_invite(7, kRight + 3 * kHour) == nullptr);
  // A later correction is of another wrong clock.
  world.make(Restrict{RestrictionKind::freeze, kMole, kWrong, ""}, kWrong - kHour);
  world.make(CorrectTime{kAhead}, kRight + kHour);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kRight + kHour);
  CHECK(world.end_of(RestrictionKind::freeze, kMole) == kRight);
}

TEST_CASE("a restriction that is over before 1970 does not become one without an end",
          "[rights][clock]") {
  WrongWorld world;
  world.make(Restrict{RestrictionKind::ban, kMole, 5, ""}, 4);
  world.make(CorrectTime{100}, 2);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == 1);
  CHECK(world.state.restriction(RestrictionKind::ban, kMole, 1) == nullptr);
}

TEST_CASE("a correction needs the right administer, and cannot be taken back", "[rights][clock]") {
  WrongWorld world;
  world.make(GrantRole{kMole, kModeratorRole}, kRight);
  world.make(GrantRole{kCrow, kAdministratorRole}, kRight);
  const CorrectTime change{kAhead};
  CHECK(why_refused(world.state, {kMole, false}, change, kWrong) ==
        "You need the right \"administer\".");
  CHECK_FALSE(why_refused(world.state, {kCrow, false}, change, kWrong).has_value());
  CHECK_FALSE(why_refused(world.state, {}, change, kWrong).has_value());
  world.make(change, kRight);
  CHECK_FALSE(inverse_of(world.records, world.seq).has_value());
}

TEST_CASE("a restriction that is restored has the end that a correction has given it",
          "[rights][clock]") {
  WrongWorld world;
  world.make(Restrict{RestrictionKind::ban, kMole, kWrong + kHour, ""}, kWrong);
  world.make(Lift{RestrictionKind::ban, kMole}, kWrong + 1);
  world.make(CorrectTime{kAhead}, kRight + 1);
  CHECK(inverse_of(world.records, 2) ==
        RightsChange(Restrict{RestrictionKind::ban, kMole, kRight + kHour, ""}));
}

}  // namespace runstone::test
