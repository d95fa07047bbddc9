#include "common/rights/change_rules.hpp"

#include <catch2/catch.hpp>

#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

const PublicKey kRoot = key_of(21), kChief = key_of(22), kMod = key_of(23), kMason = key_of(24),
                kGranter = key_of(25), kStranger = key_of(26);
const RightsActor kConsole = {};

RightsActor player(const PublicKey& key) { return {key, false}; }

/// A world with an administrator, a moderator, a granter who is a moderator too, and a builder.
class RulesWorld {
 public:
  RulesWorld() {
    make(GrantRole{kRoot, kAdministratorRole});
    make(GrantRole{kMod, kModeratorRole});
    Role granter = built_in_roles()[3];
    granter.name = "granter";
    granter.rights.add(Right::grant);
    make(DefineRole{granter});
    make(GrantRole{kGranter, "granter"});
    make(GrantRole{kMason, kBuilderRole});
  }
  void make(const RightsChange& change) { state.apply(change, {++seq, 0, 0}); }
  std::string why(const RightsActor& actor, const RightsChange& change) const {
    REQUIRE(validate(change).has_value());
    const auto reason = why_refused(state, actor, change, 50);
    if (reason) CHECK(reason->back() == '.');
    return reason.value_or("");
  }
  bool allows(const RightsActor& actor, const RightsChange& change) const {
    return why(actor, change).empty();
  }
  RightsState state;
  Sequence seq = 0;
};

ProtectedBox claim_of(const PublicKey& owner, const std::string& name, const VoxelBox& box) {
  ProtectedBox out;
  out.name = name;
  out.box = box;
  out.owner = owner;
  return out;
}

constexpr VoxelBox kPlot = {{0, 0, 0}, {20, 20, 20}};

}  // namespace

TEST_CASE("only administrators change roles and the default role", "[rights]") {
  RulesWorld world;
  const Role guard{"guard", {Right::see}, 0, 0, 0};
  for (const RightsActor& actor : {player(kMod), player(kGranter), player(kStranger)}) {
    CHECK(world.why(actor, DefineRole{guard}) == "You need the right \"administer\".");
    CHECK_FALSE(world.allows(actor, RemoveRole{"granter"}));
    CHECK_FALSE(world.allows(actor, SetDefaultRole{kVisitorRole}));
  }
  for (const RightsActor& actor : {player(kRoot), kConsole, RightsActor{kStranger, true}}) {
    CHECK(world.allows(actor, DefineRole{guard}));
    CHECK(world.allows(actor, SetDefaultRole{kVisitorRole}));
  }
  CHECK(world.why(kConsole, SetDefaultRole{"guard"}) ==
        "There is no role \"guard\" (roles lists them).");
}

TEST_CASE("a role in use is not removed, and a built-in one only as far as it was changed",
          "[rights]") {
  RulesWorld world;
  CHECK(world.why(kConsole, RemoveRole{"guard"}) ==
        "There is no role \"guard\" (roles lists them).");
  CHECK(
      world.why(kConsole, RemoveRole{"granter"}) ==
      "A player has the role \"granter\": give the players with it another one first (grants lists them).");
  CHECK(world.why(kConsole, RemoveRole{kVisitorRole}) ==
        "The role \"visitor\" is built in, and nothing was changed of it.");
  world.make(DefineRole{{kBuilderRole, {Right::see}, 0, 0, 0}});
  CHECK(world.allows(kConsole, RemoveRole{kBuilderRole}));
  world.make(DefineRole{{"guard", {Right::see}, 0, 0, 0}});
  CHECK(world.allows(kConsole, RemoveRole{"guard"}));
  world.make(SetDefaultRole{"guard"});
  CHECK(
      world.why(kConsole, RemoveRole{"guard"}) ==
      "The role \"guard\" is the default role: make another one the default first (role default NAME).");
}

TEST_CASE("a role is given within the rights of the giver, to players with fewer rights",
          "[rights]") {
  RulesWorld world;
  CHECK(world.why(player(kMod), GrantRole{kMason, kVisitorRole}) ==
        "You need the right \"grant\".");
  CHECK(world.allows(player(kGranter), GrantRole{kMason, kModeratorRole}));
  CHECK(world.allows(player(kGranter), GrantRole{kStranger, "granter"}));
  CHECK(world.allows(player(kGranter), GrantRole{kMod, ""}));
  CHECK(world.why(player(kGranter), GrantRole{kMason, kAdministratorRole}) ==
        "You lack the right \"administer\" and cannot give it: ask an administrator, or the host.");
  CHECK(
      world.why(player(kGranter), GrantRole{kRoot, kVisitorRole}) ==
      "You can do this only to players who have fewer rights than you: ask an administrator, or the host.");
  world.make(GrantRole{kChief, "granter"});
  CHECK_FALSE(world.allows(player(kGranter), GrantRole{kChief, kVisitorRole}));
  CHECK(world.why(player(kGranter), GrantRole{kGranter, kVisitorRole}) ==
        "You cannot do this to yourself: another administrator can, or the host at the console.");
  CHECK(world.why(player(kGranter), GrantRole{kMason, "pilot"}) ==
        "There is no role \"pilot\" (roles lists them).");
  CHECK(world.allows(kConsole, GrantRole{kRoot, kAdministratorRole}));
  CHECK_FALSE(world.allows(RightsActor{kMason, true}, GrantRole{kMason, kVisitorRole}));
}

TEST_CASE("an administrator who lacks a right does not give it", "[rights]") {
  RulesWorld world;
  world.make(DefineRole{{"chief", {Right::see, Right::administer}, 0, 0, 0}});
  world.make(GrantRole{kChief, "chief"});
  CHECK_FALSE(world.allows(player(kChief), GrantRole{kMason, kModeratorRole}));
  CHECK_FALSE(world.allows(player(kChief), SetDefaultRole{kModeratorRole}));
  CHECK_FALSE(world.allows(player(kChief), DefineRole{{"x", {Right::build}, 0, 0, 0}}));
  // A role keeps rights that it has.
  CHECK(world.allows(player(kChief), DefineRole{{"granter", {Right::build}, 7, 0, 0}}));
  world.make(DefineRole{{kBuilderRole, {}, 0, 0, 0}});
  CHECK_FALSE(world.allows(player(kChief), RemoveRole{kBuilderRole}));
  CHECK(world.allows(player(kChief), GrantRole{kGranter, "chief"}));
}

TEST_CASE("moderators restrict players with fewer rights and lift their restrictions", "[rights]") {
  RulesWorld world;
  const auto ban = [](const RestrictionSubject& subject) {
    return Restrict{RestrictionKind::ban, subject, 0, ""};
  };
  CHECK(world.allows(player(kMod), ban(kMason)));
  CHECK(world.allows(player(kMod), Restrict{RestrictionKind::mute, kStranger, 60, "loud"}));
  CHECK_FALSE(world.allows(player(kMod), ban(kGranter)));
  CHECK_FALSE(world.allows(player(kMod), ban(kRoot)));
  CHECK_FALSE(world.allows(player(kMod), ban(kMod)));
  CHECK_FALSE(world.allows(player(kRoot), Restrict{RestrictionKind::mute, kRoot, 0, ""}));
  CHECK(world.why(player(kMason), ban(kStranger)) == "You need the right \"moderate\".");
  CHECK(world.why(player(kMod), Lift{RestrictionKind::ban, kMason}) ==
        "There is no such restriction (bans lists them).");
  world.make(ban(kMason));
  CHECK(world.allows(player(kMod), Lift{RestrictionKind::ban, kMason}));
  world.make(Restrict{RestrictionKind::mute, kMod, 0, ""});
  CHECK_FALSE(world.allows(player(kMod), Lift{RestrictionKind::mute, kMod}));
  CHECK(world.allows(player(kGranter), Lift{RestrictionKind::mute, kMod}));
  world.make(ban(kMod));
  CHECK(world.why(player(kMod), ban(kStranger)) == "You are banned.");
}

TEST_CASE("bans of many addresses need an administrator", "[rights]") {
  RulesWorld world;
  const auto ban = [](std::uint64_t first, std::uint8_t bits) {
    return Restrict{RestrictionKind::ban, AddressRange{AddressBlock{first}, bits}, 0, ""};
  };
  const std::uint64_t v4 = 0x0000'ffff'c000'0200, v6 = 0x2001'0db8'0001'0000;
  CHECK(world.allows(player(kMod), ban(v4, 64)));
  CHECK(world.allows(player(kMod), ban(v4, 32 + 24)));
  CHECK_FALSE(world.allows(player(kMod), ban(v4, 32 + 23)));
  CHECK(world.allows(player(kMod), ban(v6, 48)));
  CHECK_FALSE(world.allows(player(kMod), ban(0x2001'0db8'0000'0000, 47)));
  CHECK_FALSE(world.allows(player(kMod), ban(0, 0)));
  CHECK(world.allows(player(kRoot), ban(0, 0)));
}

TEST_CASE("the last administrator stays, whoever asks", "[rights]") {
  RulesWorld world;
  const std::string last =
      "The world would have no administrator any more: give another player a role with the rights see and administer first (grant PLAYER administrator).";
  const RightsActor op{kStranger, true};
  for (const RightsActor& actor : {kConsole, op}) {
    CHECK(world.why(actor, GrantRole{kRoot, kBuilderRole}) == last);
    CHECK(world.why(actor, GrantRole{kRoot, ""}) == last);
    CHECK(world.why(actor, DefineRole{{kAdministratorRole, {}, 0, 0, 0}}) == last);
    CHECK(world.why(actor, Restrict{RestrictionKind::ban, kRoot, 60, ""}) == last);
    CHECK(world.allows(actor, Restrict{RestrictionKind::mute, kRoot, 60, ""}));
  }
  CHECK(world.why(player(kRoot), DefineRole{{kAdministratorRole, {}, 0, 0, 0}}) == last);
  world.make(GrantRole{kChief, kAdministratorRole});
  CHECK(world.allows(kConsole, GrantRole{kRoot, kBuilderRole}));
  CHECK(world.allows(player(kChief), Restrict{RestrictionKind::ban, kRoot, 0, ""}));
  CHECK(world.why(kConsole, DefineRole{{kAdministratorRole, {}, 0, 0, 0}}) == last);
  world.make(Restrict{RestrictionKind::ban, kRoot, 0, ""});
  CHECK(world.why(kConsole, GrantRole{kChief, kBuilderRole}) == last);
}

TEST_CASE("a lower role for some time takes no protection from a player", "[rights]") {
  RulesWorld world;
  world.make(GrantRole{kChief, kAdministratorRole});
  world.make(GrantRole{kRoot, kVisitorRole, 100});
  // The role of an administrator counts again at 100.
  CHECK_FALSE(world.allows(player(kGranter), GrantRole{kRoot, kBuilderRole}));
  CHECK_FALSE(world.allows(player(kMod), Restrict{RestrictionKind::ban, kRoot, 0, ""}));
  // Without it kRoot would be the last administrator, who must stay.
  world.make(GrantRole{kChief, kBuilderRole});
  CHECK_FALSE(world.allows(kConsole, GrantRole{kRoot, ""}));
  CHECK_FALSE(world.allows(kConsole, Restrict{RestrictionKind::ban, kRoot, 0, ""}));
  // A higher role for some time protects while it is in force.
  world.make(GrantRole{kMason, kAdministratorRole, 100});
  CHECK_FALSE(world.allows(player(kMod), Restrict{RestrictionKind::mute, kMason, 0, ""}));
}

TEST_CASE("the default role and a changed role can hold the last administrators", "[rights]") {
  RulesWorld world;
  Role all{"all", RightSet::all(), 0, 0, 0};
  world.make(DefineRole{all});
  world.make(SetDefaultRole{"all"});
  CHECK(world.allows(kConsole, GrantRole{kRoot, kBuilderRole}));
  world.make(GrantRole{kRoot, kBuilderRole});
  CHECK_FALSE(world.allows(kConsole, SetDefaultRole{kBuilderRole}));
  // A built-in role that was given the right is the last one, too.
  world.make(SetDefaultRole{kBuilderRole});
  all.name = kModeratorRole;
  world.make(DefineRole{all});
  CHECK_FALSE(world.allows(kConsole, RemoveRole{kModeratorRole}));
  world.make(GrantRole{kRoot, kAdministratorRole});
  CHECK(world.allows(kConsole, RemoveRole{kModeratorRole}));
}

TEST_CASE("a world without administrators is changed freely", "[rights]") {
  const RightsState state;
  CHECK_FALSE(
      why_refused(state, kConsole, DefineRole{{kAdministratorRole, {}, 0, 0, 0}}, 0).has_value());
  CHECK_FALSE(
      why_refused(state, kConsole, Restrict{RestrictionKind::ban, kRoot, 0, ""}, 0).has_value());
}

TEST_CASE("a builder claims ground within the quota", "[rights]") {
  RulesWorld world;
  const RightsActor mason = player(kMason);
  CHECK(world.allows(mason, Protect{claim_of(kMason, "home", kPlot)}));
  CHECK_FALSE(world.allows(mason, Protect{claim_of(kStranger, "home", kPlot)}));
  ProtectedBox high = claim_of(kMason, "home", kPlot);
  high.priority = 1;
  CHECK_FALSE(world.allows(mason, Protect{high}));
  CHECK(
      world.why(mason, Protect{claim_of(kMason, "land", columns(0, 0, 9, 9))}) ==
      "Your role allows boxes of 1310720 voxels together: make it smaller, or remove one of yours first (unprotect NAME).");
  for (std::int32_t i = 0; i < 5; ++i) {
    const VoxelBox place = {{100 * i, 0, 0}, {100 * i + 64, 64, 32}};
    const Protect claim{claim_of(kMason, "claim-" + std::to_string(i), place)};
    CHECK(world.allows(mason, claim));
    world.make(claim);
  }
  CHECK(world.why(mason, Protect{claim_of(kMason, "more", {{0, 100, 0}, {1, 101, 1}})}) ==
        "Your role allows 5 boxes: remove one of yours first (unprotect NAME).");
  // A box that is replaced does not count.
  CHECK(world.allows(mason, Protect{claim_of(kMason, "claim-0", {{0, 0, 0}, {64, 64, 192}})}));
  CHECK_FALSE(
      world.allows(mason, Protect{claim_of(kMason, "claim-0", {{0, 0, 0}, {64, 64, 193}})}));
  world.make(GrantRole{kMason, kVisitorRole});
  CHECK(world.why(mason, Protect{claim_of(kMason, "more", kPlot)}) ==
        "You need the right \"protect\".");
}

TEST_CASE("a claim takes no ground of others", "[rights]") {
  RulesWorld world;
  ProtectedBox hall = claim_of(kStranger, "hall", kPlot);
  hall.members = {kMason};
  world.make(Protect{hall});
  const RightsActor mason = player(kMason);
  CHECK(world.why(mason, Protect{claim_of(kMason, "home", {{19, 19, 19}, {22, 22, 22}})}) ==
        "The box \"hall\" of somebody else lies there.");
  CHECK(world.allows(mason, Protect{claim_of(kMason, "home", {{20, 19, 19}, {22, 22, 22}})}));
  // Ground without an owner is that of all who share it.
  ProtectedBox city;
  city.name = "city";
  city.box = columns(100, 100, 200, 200);
  city.roles = {kBuilderRole};
  world.make(Protect{city});
  const Protect home{claim_of(kMason, "home", {{110, 0, 110}, {120, 9, 120}})};
  CHECK(world.why(mason, home) == "The box \"city\" of somebody else lies there.");
  city.priority = 1;  // it decides before every claim
  world.make(Protect{city});
  CHECK(world.allows(mason, home));
  city.roles.clear();
  world.make(Protect{city});
  CHECK(world.why(mason, home) == "You may not change the ground of the box \"city\".");
}

TEST_CASE("a change of members takes no ground back", "[rights]") {
  RulesWorld world;
  ProtectedBox home = claim_of(kMason, "home", kPlot);
  world.make(Protect{home});
  ProtectedBox road;
  road.name = "road";
  road.box = kPlot;
  world.make(Protect{road});
  home.members = {kStranger};
  CHECK(world.why(player(kMason), Protect{home}) ==
        "The box \"road\" of somebody else lies there.");
  world.make(Unprotect{"road"});
  CHECK(world.allows(player(kMason), Protect{home}));
  world.make(Restrict{RestrictionKind::freeze, kMason, 0, ""});
  CHECK(world.why(player(kMason), Protect{home}) == "You may not edit now.");
  CHECK(world.why(player(kMason), Unprotect{"home"}) == "You may not edit now.");
}

TEST_CASE("an administrator who may not join is none", "[rights]") {
  RulesWorld world;
  CHECK(
      world.why(kConsole, DefineRole{{kAdministratorRole, {Right::administer}, 0, 0, 0}}) ==
      "The world would have no administrator any more: give another player a role with the rights see and administer first (grant PLAYER administrator).");
}

TEST_CASE("owners change their boxes, and protectors all of them", "[rights]") {
  RulesWorld world;
  ProtectedBox home = claim_of(kMason, "home", kPlot);
  home.priority = 2;
  world.make(Protect{home});
  ProtectedBox changed = home;
  changed.members = {kStranger};
  changed.box.max.x = 30;
  CHECK(world.allows(player(kMason), Protect{changed}));
  CHECK(world.why(player(kStranger), Protect{changed}) ==
        "The box \"home\" belongs to somebody else.");
  CHECK_FALSE(world.allows(player(kStranger), Unprotect{"home"}));
  CHECK(world.allows(player(kMason), Unprotect{"home"}));
  changed.priority = 3;
  CHECK_FALSE(world.allows(player(kMason), Protect{changed}));
  CHECK(world.allows(player(kMod), Protect{changed}));
  changed.priority = 2;
  changed.owner = kStranger;
  CHECK_FALSE(world.allows(player(kMason), Protect{changed}));
  CHECK(world.allows(player(kMod), Protect{changed}));
  CHECK(world.allows(player(kMod), Unprotect{"home"}));
  CHECK(world.why(kConsole, Unprotect{"house"}) ==
        "There is no protected box \"house\" (protected lists them).");
  // Members can be changed without a quota, the place cannot.
  world.make(GrantRole{kMason, kVisitorRole});
  changed = home;
  changed.members = {kStranger};
  CHECK(world.allows(player(kMason), Protect{changed}));
  changed.box.max.x = 19;
  CHECK_FALSE(world.allows(player(kMason), Protect{changed}));
}

TEST_CASE("the roles of a box exist when they are added", "[rights]") {
  RulesWorld world;
  ProtectedBox home = claim_of(kMason, "home", kPlot);
  home.roles = {"guard"};
  CHECK(world.why(kConsole, Protect{home}) == "There is no role \"guard\" (roles lists them).");
  world.make(Protect{home});
  home.members = {kStranger};
  CHECK(world.allows(player(kMason), Protect{home}));
}

TEST_CASE("the number of roles is limited", "[rights]") {
  RulesWorld world;
  for (std::size_t i = world.state.roles().size(); i < kRolesMax; ++i) {
    world.make(DefineRole{{"role-" + std::to_string(i), {}, 0, 0, 0}});
  }
  CHECK_FALSE(world.allows(kConsole, DefineRole{{"more", {}, 0, 0, 0}}));
  CHECK(world.allows(kConsole, DefineRole{{"role-7", {Right::see}, 0, 0, 0}}));
}

TEST_CASE("the numbers of grants, restrictions and boxes are limited", "[rights]") {
  RulesWorld world;
  const auto numbered = [](std::size_t i) {
    PublicKey key = key_of(99);
    for (std::size_t byte = 0; byte < 4; ++byte) {
      key[1 + byte] = static_cast<std::uint8_t>(i >> (8 * byte));
    }
    return key;
  };
  for (std::size_t i = world.state.grants().size(); i < kGrantsMax; ++i) {
    world.make(GrantRole{numbered(i), kVisitorRole});
  }
  CHECK_FALSE(world.allows(kConsole, GrantRole{kStranger, kBuilderRole}));
  CHECK(world.allows(kConsole, GrantRole{kStranger, ""}));
  CHECK(world.allows(kConsole, GrantRole{kMason, kVisitorRole}));
  for (std::size_t i = 0; i < kRestrictionsMax; ++i) {
    world.make(Restrict{RestrictionKind::mute, numbered(i), 1, ""});
  }
  CHECK_FALSE(world.allows(kConsole, Restrict{RestrictionKind::ban, kStranger, 0, ""}));
  CHECK(world.allows(kConsole, Restrict{RestrictionKind::mute, numbered(5), 0, ""}));
  for (std::size_t i = 0; i < kBoxesMax; ++i) {
    const auto x = static_cast<std::int32_t>(i);
    world.make(Protect{claim_of(kMason, std::to_string(i), {{x, 0, 0}, {x + 1, 1, 1}})});
  }
  CHECK_FALSE(world.allows(kConsole, Protect{claim_of(kMason, "more", kPlot)}));
  CHECK(world.allows(kConsole, Protect{claim_of(kMason, "77", kPlot)}));
}

}  // namespace runstone::test
