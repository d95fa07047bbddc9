#include "common/rights/invite.hpp"

#include <catch2/catch.hpp>

#include "common/rights/change_rules.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kStart = 1'000, kEnd = 2'000;
const PublicKey kFirst{1}, kSecond{2}, kThird{3};

struct InvitedWorld {
  InvitedWorld() {
    make(SetDefaultRole{kNobodyRole});
    make(CreateInvite{{7, kBuilderRole, 2, kEnd}});
  }
  void make(const RightsChange& change, TimeUs now_us = kStart) {
    records.push_back({change, {++seq, 0, now_us}});
    state.apply(change, records.back().origin);
  }
  std::string why(const PublicKey& key, InviteId invite, TimeUs now_us = kStart) const {
    return why_refused(state, {key, false}, AcceptInvite{invite, key}, now_us).value_or("");
  }
  RightsState state;
  std::vector<RightsRecord> records;
  Sequence seq = 0;
};

}  // namespace

TEST_CASE("an invite gives its role to as many players as it has uses", "[rights]") {
  InvitedWorld world;
  CHECK_FALSE(world.state.decide(kFirst, Right::see, kStart).is_allowed);
  for (const PublicKey& key : {kFirst, kSecond}) {
    CHECK(world.why(key, 7).empty());
    world.make(AcceptInvite{7, key});
    CHECK(world.state.role_of(key).name == kBuilderRole);
    CHECK(world.state.decide(key, Right::see, kStart).by.seq == world.seq);
  }
  CHECK(world.why(kThird, 7) == "The invite was used as often as it may be.");
  world.make(AcceptInvite{7, kThird});  // a record that no server writes changes nothing
  CHECK(world.state.role_of(kThird).name == kNobodyRole);
  CHECK(world.state.invites().at(7).value.accepted == 2);
}

TEST_CASE("an invite ends, and can be cancelled", "[rights]") {
  InvitedWorld world;
  CHECK(world.why(kFirst, 7, kEnd) == "The invite has ended.");
  CHECK(world.state.usable_invite(7, kEnd - 1) != nullptr);
  CHECK(world.state.usable_invite(7, kEnd) == nullptr);
  CHECK(world.why(kFirst, 8) == "The invite was cancelled, has ended, or is of another world.");
  world.make(AcceptInvite{7, kFirst});
  world.make(CancelInvite{7});
  CHECK(world.why(kSecond, 7) == "The invite was cancelled, has ended, or is of another world.");
  CHECK(world.state.role_of(kFirst).name == kBuilderRole);
}

TEST_CASE("an invite that has ended is removed when a later one is made", "[rights]") {
  InvitedWorld world;
  world.make(CreateInvite{{8, kVisitorRole, 1, 2 * kEnd}}, kEnd);
  CHECK(world.state.invites().size() == 1);
  CHECK(world.state.invites().contains(8));
}

TEST_CASE("an invite takes nobody's role, and nobody accepts it for somebody else", "[rights]") {
  InvitedWorld world;
  world.make(GrantRole{kFirst, kModeratorRole});
  CHECK(world.why(kFirst, 7) == "You have a role already.");
  world.make(AcceptInvite{7, kFirst});
  CHECK(world.state.role_of(kFirst).name == kModeratorRole);
  CHECK(world.state.invites().at(7).value.accepted == 0);
  const auto for_another =
      why_refused(world.state, {kFirst, false}, AcceptInvite{7, kSecond}, kStart);
  CHECK(for_another == "Nobody accepts an invite for somebody else.");
  world.make(Restrict{RestrictionKind::ban, kSecond, 0, ""});
  CHECK(world.why(kSecond, 7) == "You are banned.");
}

TEST_CASE("who makes an invite gives only rights that are his", "[rights]") {
  InvitedWorld world;
  const auto why = [&](const PublicKey& key, const char* role, TimeUs until_us = kEnd) {
    return why_refused(world.state, {key, false}, CreateInvite{{9, role, 1, until_us}}, kStart)
        .value_or("");
  };
  CHECK(why(kFirst, kBuilderRole) == "You need the right \"grant\".");
  Role granter = built_in_roles()[2];
  granter.name = "granter";
  granter.rights.add(Right::grant);
  world.make(DefineRole{granter});
  world.make(GrantRole{kFirst, "granter"});
  CHECK(why(kFirst, kBuilderRole).empty());
  CHECK(why(kFirst, kModeratorRole).find("cannot give it") != std::string::npos);
  CHECK(why(kFirst, "pilot") == "There is no role \"pilot\" (roles lists them).");
  CHECK(why(kFirst, kBuilderRole, kStart) == "The invite would have ended already.");
}

TEST_CASE("an invite is for a role that may join, and ended ones leave room", "[rights]") {
  InvitedWorld world;
  const RightsActor console;
  const auto why = [&](const Invite& invite, TimeUs now_us) {
    return why_refused(world.state, console, CreateInvite{invite}, now_us).value_or("");
  };
  CHECK(
      why({9, kNobodyRole, 1, kEnd}, kStart) ==
      "Players with the role \"nobody\" may not join: choose a role with the right see (roles lists them).");
  for (InviteId id = 100; world.state.invites().size() < kInvitesMax; ++id)
    world.make(CreateInvite{{id, kBuilderRole, 1, kEnd}});
  CHECK_FALSE(why({9, kBuilderRole, 1, 2 * kEnd}, kStart).empty());
  CHECK(why({9, kBuilderRole, 1, 2 * kEnd}, kEnd).empty());
}

TEST_CASE("a record about invites can be taken back", "[rights]") {
  InvitedWorld world;
  CHECK(inverse_of(world.records, 2) == RightsChange(CancelInvite{7}));
  world.make(AcceptInvite{7, kFirst});
  CHECK(inverse_of(world.records, 3) == RightsChange(GrantRole{kFirst, ""}));
  world.make(GrantRole{kFirst, kModeratorRole});
  CHECK(inverse_of(world.records, 4) == RightsChange(GrantRole{kFirst, kBuilderRole}));
  world.make(CancelInvite{7});
  CHECK(inverse_of(world.records, 5) == RightsChange(CreateInvite{{7, kBuilderRole, 1, kEnd}}));
}

}  // namespace runstone::test
