// The effect of a correction of the time on the rights of a world.
#include <catch2/catch.hpp>
#include <limits>

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
  /// Corrects the time at a start: `since` is this record.
  void correct(TimeUs step_us, TimeUs now_us) { make(CorrectTime{step_us, seq + 1}, now_us); }
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
  world.correct(-kAhead, kRight + kHour / 2);
  CHECK(world.end_of(RestrictionKind::freeze, kCrow) == kRight + kHour);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kRight + kHour);
  CHECK(world.end_of(RestrictionKind::ban, kNet) == kRight + 2 * kHour);
  CHECK(world.end_of(RestrictionKind::mute, kMole) == 0);  // until it is lifted
  CHECK(world.state.usable_invite(7, kRight + 3 * kHour - 1) != nullptr);
  CHECK(world.state.usable_invite(7, kRight + 3 * kHour) == nullptr);
  // A later correction is of another wrong clock.
  world.make(Restrict{RestrictionKind::freeze, kMole, kWrong, ""}, kWrong - kHour);
  world.correct(-kAhead, kRight + kHour);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kRight + kHour);
  CHECK(world.end_of(RestrictionKind::freeze, kMole) == kRight);
}

TEST_CASE("restrictions of the clock that is corrected count by what has passed, not by its time",
          "[rights][clock]") {
  // Record 1 is of a start with a right clock. Since record 2 the clock is wrong by this much.
  const TimeUs wrong_us = GENERATE(-kAhead, -kHour / 4, kHour / 4, kAhead);
  CAPTURE(wrong_us);
  WrongWorld world;
  world.make(Restrict{RestrictionKind::freeze, kCrow, kRight + 5 * kHour, ""}, kRight - kHour);
  world.make(Restrict{RestrictionKind::ban, kMole, kRight + wrong_us + 2 * kHour, ""},
             kRight + wrong_us);
  world.make(Restrict{RestrictionKind::ban, kNet, kRight + wrong_us + kHour / 2, ""},
             kRight + wrong_us);
  world.make(CreateInvite{{7, kBuilderRole, 2, kRight + wrong_us + 3 * kHour}}, kRight + wrong_us);
  // The clock has been wrong for an hour, so a ban of half an hour is over.
  CHECK(world.state.has_ends_given_since(2, kRight + kHour + wrong_us));
  CHECK_FALSE(world.state.has_ends_given_since(5, kRight + kHour + wrong_us));
  CHECK_FALSE(world.state.has_ends_given_since(2, kRight + 3 * kHour + wrong_us));
  CHECK_FALSE(world.state.is_time_corrected());
  world.make(CorrectTime{-wrong_us, 2}, kRight + kHour);
  CHECK(world.state.is_time_corrected());
  CHECK(world.end_of(RestrictionKind::freeze, kCrow) == kRight + 5 * kHour);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kRight + 2 * kHour);
  CHECK(world.end_of(RestrictionKind::ban, kNet) == kRight + kHour / 2);
  CHECK(world.state.usable_invite(7, kRight + 3 * kHour - 1) != nullptr);
  CHECK(world.state.usable_invite(7, kRight + 3 * kHour) == nullptr);
}

TEST_CASE("a step to a wrong time and the step back leave all ends as they were",
          "[rights][clock]") {
  WrongWorld world;
  world.make(Restrict{RestrictionKind::freeze, kCrow, kRight + kHour, ""}, kRight - 9 * kHour);
  world.make(Restrict{RestrictionKind::ban, kMole, kRight + 2 * kHour, ""}, kRight);  // this run
  world.make(CorrectTime{kAhead, 2}, kWrong);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kWrong + 2 * kHour);
  world.make(Restrict{RestrictionKind::ban, kNet, kWrong + 3 * kHour, ""}, kWrong);
  // In the same run, and at a later start.
  const Sequence since = GENERATE(Sequence{3}, Sequence{5});
  world.make(CorrectTime{-kAhead, since}, kRight + kHour);
  CHECK(world.end_of(RestrictionKind::freeze, kCrow) == kRight + kHour);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kRight + 2 * kHour);
  CHECK(world.end_of(RestrictionKind::ban, kNet) == kRight + 3 * kHour);
  // A lifted restriction has these ends, too, if its Lift is taken back.
  world.make(Lift{RestrictionKind::ban, kMole}, kRight + kHour);
  CHECK(inverse_of(world.records, world.seq) ==
        RightsChange(Restrict{RestrictionKind::ban, kMole, kRight + 2 * kHour, ""}));
}

TEST_CASE("a correction to a time that is still wrong is corrected by the next one",
          "[rights][clock]") {
  WrongWorld world;
  world.make(Restrict{RestrictionKind::ban, kMole, kWrong + kHour, ""}, kWrong);
  world.correct(-kAhead / 2, kWrong - kAhead / 2);
  world.correct(-kAhead / 2, kRight);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kRight + kHour);
}

TEST_CASE("the largest steps keep ends within their range", "[rights][clock]") {
  constexpr TimeUs kLast = std::numeric_limits<TimeUs>::max();
  WrongWorld world;
  world.make(Restrict{RestrictionKind::ban, kMole, kLast, ""}, 1);
  world.make(CorrectTime{kLast, 1}, kLast);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == kLast);
  world.make(CorrectTime{std::numeric_limits<TimeUs>::min(), 1}, 1);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == 1);
}

TEST_CASE("a restriction that is over before 1970 does not become one without an end",
          "[rights][clock]") {
  WrongWorld world;
  world.make(Restrict{RestrictionKind::ban, kMole, 5, ""}, 4);
  world.correct(-100, 2);
  CHECK(world.end_of(RestrictionKind::ban, kMole) == 1);
  CHECK(world.state.restriction(RestrictionKind::ban, kMole, 1) == nullptr);
}

TEST_CASE("a correction needs the right administer, and cannot be taken back", "[rights][clock]") {
  WrongWorld world;
  world.make(GrantRole{kMole, kModeratorRole}, kRight);
  world.make(GrantRole{kCrow, kAdministratorRole}, kRight);
  const CorrectTime change{-kAhead, 3};
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
  world.correct(-kAhead, kRight + 1);
  CHECK(inverse_of(world.records, 2) ==
        RightsChange(Restrict{RestrictionKind::ban, kMole, kRight + kHour, ""}));
}

}  // namespace runstone::test
