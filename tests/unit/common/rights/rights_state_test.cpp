#include "common/rights/rights_state.hpp"

#include <catch2/catch.hpp>

#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

const PublicKey kAda = key_of(1), kBob = key_of(2);

ProtectedBox box_named(const std::string& name, const VoxelBox& box) {
  ProtectedBox out;
  out.name = name;
  out.box = box;
  return out;
}

}  // namespace

TEST_CASE("a world without records has the built-in roles, and players are builders", "[rights]") {
  const RightsState state;
  CHECK(state.roles().size() == 5);
  CHECK(state.role_of(kAda).name == kBuilderRole);
  CHECK(state.default_role().value == kBuilderRole);
  CHECK(state.default_role().by.seq == 0);
  CHECK(state.administrators(0).empty());
  CHECK(state.boxes().empty());
  const RightsDecision decision = state.decide(kAda, Right::build, 0);
  CHECK(decision.is_allowed);
  CHECK(decision.reason == RightsDecision::Reason::default_role);
  CHECK(decision.role == kBuilderRole);
  CHECK_FALSE(state.decide(kAda, Right::protect, 0).is_allowed);
}

TEST_CASE("a grant of a role that does not exist counts as no grant", "[rights]") {
  RightsState state;
  state.apply(GrantRole{kAda, "mason"}, {1, 9, 10});
  CHECK(state.role_of(kAda).name == kBuilderRole);
  CHECK(state.decide(kAda, Right::see, 0).reason == RightsDecision::Reason::default_role);
  state.apply(DefineRole{{"mason", {Right::see}, 0, 0, 0}}, {2, 9, 20});
  CHECK(state.role_of(kAda).name == "mason");
  const RightsDecision decision = state.decide(kAda, Right::see, 0);
  CHECK(decision.reason == RightsDecision::Reason::role);
  CHECK(decision.by == ChangeOrigin{2, 9, 20});
  state.apply(RemoveRole{"mason"}, {3, 9, 30});
  CHECK(state.find_role("mason") == nullptr);
  CHECK(state.role_of(kAda).name == kBuilderRole);
  state.apply(SetDefaultRole{"mason"}, {4, 9, 40});
  CHECK(state.role_of(kAda).name == kVisitorRole);
}

TEST_CASE("a built-in role that is removed is as it was built in", "[rights]") {
  RightsState state;
  state.apply(DefineRole{{kVisitorRole, {}, 0, 0, 0}}, {1, 9, 10});
  CHECK(state.find_role(kVisitorRole)->value.rights == RightSet{});
  state.apply(RemoveRole{kVisitorRole}, {2, 9, 20});
  CHECK(state.find_role(kVisitorRole)->value == built_in_roles()[1]);
  CHECK(state.find_role(kVisitorRole)->by == ChangeOrigin{2, 9, 20});
}

TEST_CASE("a grant with an end counts before the other until it ends", "[rights]") {
  RightsState state;
  state.apply(GrantRole{kAda, kVisitorRole}, {1, 9, 10});
  state.apply(GrantRole{kAda, kModeratorRole, 100}, {2, 9, 20});
  state.apply(GrantRole{kBob, kModeratorRole, 50}, {3, 9, 20});
  CHECK(state.role_of(kAda).name == kModeratorRole);
  CHECK(state.role_of(kAda, 99).name == kModeratorRole);
  CHECK(state.role_of(kAda, 100).name == kVisitorRole);
  CHECK(state.role_of(kBob, 50).name == kBuilderRole);
  CHECK(state.decide(kAda, Right::moderate, 99).by == ChangeOrigin{2, 9, 20});
  CHECK(state.decide(kAda, Right::moderate, 100).by == ChangeOrigin{1, 9, 10});
  CHECK(state.rights_in_force(kAda, 99).has(Right::moderate));
  CHECK_FALSE(state.rights_in_force(kAda, 100).has(Right::moderate));
  state.set_time(100);
  CHECK(state.role_of(kAda).name == kVisitorRole);
  CHECK(state.grants_ended(49, 50) == std::vector<GrantRole>{{kBob, kModeratorRole, 50}});
  CHECK(state.grants_ended(50, 99).empty());
  CHECK(state.grants_ended(0, 100).size() == 2);

  // A later grant without an end replaces both.
  state.apply(GrantRole{kAda, kBuilderRole}, {4, 9, 30});
  CHECK(state.role_of(kAda, 30).name == kBuilderRole);
  // A grant that has ended is removed by the next one with an end.
  CHECK(state.timed_grants().contains(kBob));
  state.apply(GrantRole{kAda, kModeratorRole, 200}, {5, 9, 60});
  CHECK_FALSE(state.timed_grants().contains(kBob));
  state.apply(GrantRole{kAda, ""}, {6, 9, 70});
  CHECK(state.timed_grants().empty());
  CHECK(state.role_of(kAda, 70).name == kBuilderRole);
  CHECK(state.decide(kAda, Right::see, 70).reason == RightsDecision::Reason::default_role);
}

TEST_CASE("a correction of the time moves the end of a grant that the wrong clock gave",
          "[rights][clock]") {
  RightsState state;
  state.apply(GrantRole{kBob, kModeratorRole, 300}, {1, 9, 10});
  state.apply(GrantRole{kAda, kModeratorRole, 1'100}, {2, 9, 1'000});
  CHECK(state.has_ends_given_since(2, 1'000));
  state.apply(CorrectTime{-900, 2}, {3, 0, 100});
  CHECK(state.role_of(kAda, 199).name == kModeratorRole);
  CHECK(state.role_of(kAda, 200).name == kBuilderRole);
  CHECK_FALSE(state.timed_grants().contains(kBob));  // it had ended by the wrong clock
}

TEST_CASE("a restriction holds until it ends or is lifted", "[rights]") {
  RightsState state;
  state.apply(Restrict{RestrictionKind::mute, kAda, 100, "loud"}, {1, 9, 10});
  CHECK_FALSE(state.decide(kAda, Right::chat, 99).is_allowed);
  CHECK(state.decide(kAda, Right::chat, 99).reason == RightsDecision::Reason::mute);
  CHECK(state.decide(kAda, Right::build, 99).is_allowed);
  CHECK(state.decide(kAda, Right::chat, 100).is_allowed);
  CHECK(state.restrictions().size() == 1);
  state.apply(Restrict{RestrictionKind::mute, kAda, 0, ""}, {2, 9, 20});
  CHECK(state.restriction_count() == 1);
  CHECK(state.decide(kAda, Right::chat, 1'000'000).by.seq == 2);
  state.apply(Restrict{RestrictionKind::freeze, kAda, 0, ""}, {3, 9, 20});
  for (const Right right : {Right::build, Right::build_protected, Right::undo}) {
    CHECK(state.decide(kAda, right, 0).reason == RightsDecision::Reason::freeze);
  }
  state.apply(Lift{RestrictionKind::mute, kAda}, {4, 9, 30});
  CHECK(state.decide(kAda, Right::chat, 0).is_allowed);
  CHECK(state.find_restriction(RestrictionKind::freeze, kAda) != nullptr);
  CHECK(state.find_restriction(RestrictionKind::mute, kAda) == nullptr);
}

TEST_CASE("a banned administrator has no right and is not listed", "[rights]") {
  RightsState state;
  state.apply(GrantRole{kAda, kAdministratorRole}, {1, 9, 10});
  state.apply(GrantRole{kBob, kAdministratorRole}, {2, 9, 10});
  CHECK(state.administrators(0) == std::vector<PublicKey>{kAda, kBob});
  state.apply(Restrict{RestrictionKind::ban, kAda, 50, ""}, {3, 9, 10});
  CHECK(state.administrators(49) == std::vector<PublicKey>{kBob});
  CHECK(state.administrators(50) == std::vector<PublicKey>{kAda, kBob});
  const RightsDecision decision = state.decide(kAda, Right::see, 0);
  CHECK_FALSE(decision.is_allowed);
  CHECK(decision.reason == RightsDecision::Reason::ban);
  CHECK(decision.role == kAdministratorRole);
}

TEST_CASE("of several bans of an address the one with the longest prefix is named", "[rights]") {
  RightsState state;
  const AddressBlock address = address_block_v4(0xc000'0207);
  state.apply(Restrict{RestrictionKind::ban, AddressRange{AddressBlock{0}, 0}, 100, ""}, {1, 0, 0});
  const AddressRange near{address_block_v4(0xc000'0200), 32 + 24};
  state.apply(Restrict{RestrictionKind::ban, near, 50, ""}, {2, 0, 0});
  CHECK(state.address_ban(address, 0)->by.seq == 2);
  CHECK(state.address_ban(address, 50)->by.seq == 1);
  CHECK(state.address_ban(address, 100) == nullptr);
  CHECK(state.address_ban(address_block_v4(1), 0)->by.seq == 1);
  state.apply(Lift{RestrictionKind::ban, near}, {3, 0, 0});
  state.apply(Lift{RestrictionKind::ban, near}, {4, 0, 0});
  CHECK(state.address_ban(address, 0)->by.seq == 1);
}

TEST_CASE("the box of highest priority decides, and among equal ones the newest", "[rights]") {
  RightsState state;
  const VoxelPos at = {1, 1, 1};
  state.apply(Protect{box_named("old", {{0, 0, 0}, {4, 4, 4}})}, {1, 0, 0});
  state.apply(Protect{box_named("new", {{1, 1, 1}, {2, 2, 2}})}, {2, 0, 0});
  CHECK(state.box_at(at)->value.name == "new");
  CHECK(state.box_at({0, 0, 0})->value.name == "old");
  CHECK(state.box_at({4, 4, 4}) == nullptr);
  // A changed box counts as made then.
  state.apply(Protect{box_named("old", {{0, 0, 0}, {5, 5, 5}})}, {3, 0, 0});
  CHECK(state.box_at(at)->value.name == "old");
  CHECK(state.box_at({4, 4, 4})->by.seq == 3);
  ProtectedBox high = box_named("high", columns(0, 0, 3, 3));
  high.priority = 1;
  state.apply(Protect{high}, {4, 0, 0});
  state.apply(Protect{box_named("new", {{1, 1, 1}, {2, 2, 2}})}, {5, 0, 0});
  const auto boxes = state.boxes_in({at, {2, 2, 2}});
  REQUIRE(boxes.size() == 3);
  CHECK(boxes[0]->value.name == "high");
  CHECK(boxes[1]->value.name == "new");
  CHECK(boxes[2]->value.name == "old");
  state.apply(Unprotect{"high"}, {6, 0, 0});
  state.apply(Unprotect{"nowhere"}, {7, 0, 0});
  CHECK(state.box_at(at)->value.name == "new");
  CHECK(state.boxes().size() == 2);
  CHECK(state.boxes_in({{0, 0, 0}, {0, 0, 0}}).empty());
}

TEST_CASE("the holding of an owner follows its boxes", "[rights]") {
  RightsState state;
  ProtectedBox home = box_named("home", {{0, 0, 0}, {2, 2, 2}});
  home.owner = kAda;
  state.apply(Protect{home}, {1, 0, 0});
  ProtectedBox field = box_named("field", {{9, 0, 0}, {10, 1, 1}});
  field.owner = kAda;
  state.apply(Protect{field}, {2, 0, 0});
  CHECK(state.holding_of(kAda).boxes == 2);
  CHECK(state.holding_of(kAda).volume == 9);
  CHECK(state.holding_of(kAda, &home).volume == 1);
  field.owner = kBob;
  field.box = columns(-kWorldLimit, -kWorldLimit, kWorldLimit, kWorldLimit);
  state.apply(Protect{field}, {3, 0, 0});
  CHECK(state.holding_of(kAda).boxes == 1);
  CHECK(state.holding_of(kBob).volume == UINT64_MAX);
  field.name = "meadow";
  state.apply(Protect{field}, {4, 0, 0});
  CHECK(state.holding_of(kBob).boxes == 2);
  CHECK(state.holding_of(kBob).volume == UINT64_MAX);
  state.apply(Unprotect{"home"}, {5, 0, 0});
  CHECK(state.holding_of(kAda).boxes == 0);
}

TEST_CASE("a state can be moved", "[rights]") {
  RightsState state;
  state.apply(Protect{box_named("a", {{0, 0, 0}, {2, 2, 2}})}, {1, 0, 0});
  const RightsState moved = std::move(state);
  CHECK(moved.box_at({1, 1, 1}) == moved.find_box("a"));
}

}  // namespace runstone::test
