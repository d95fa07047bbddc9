#include "common/rights/join_password.hpp"

#include <catch2/catch.hpp>

#include "common/rights/change_rules.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kJoinTime = 1'000;
const PublicKey kJoiner{1}, kOtherJoiner{2};

struct PasswordWorld {
  PasswordWorld() { make(SetDefaultRole{kNobodyRole}); }
  void make(const RightsChange& change) {
    records.push_back({change, {records.size() + 1, 0, kJoinTime}});
    state.apply(change, records.back().origin);
  }
  void set_password(const std::string& role) { make(SetPassword{{{role, {7}, {8}}}}); }
  std::string why(const RightsChange& change, const RightsActor& actor = {}) const {
    return why_refused(state, actor, change, kJoinTime).value_or("");
  }
  std::string why_not_accepted(const PublicKey& key) const {
    return why(AcceptPassword{key}, {key, false});
  }
  RightsState state;
  std::vector<RightsRecord> records;
};

}  // namespace

TEST_CASE("a password gives its role to players who have none", "[rights]") {
  PasswordWorld world;
  CHECK(world.why_not_accepted(kJoiner) == "The world has no password.");
  world.make(AcceptPassword{kJoiner});  // a record that no server writes changes nothing
  CHECK(world.state.role_of(kJoiner).name == kNobodyRole);
  world.set_password(kBuilderRole);
  CHECK(world.why_not_accepted(kJoiner).empty());
  world.make(AcceptPassword{kJoiner});
  CHECK(world.state.role_of(kJoiner).name == kBuilderRole);
  CHECK(world.state.decide(kJoiner, Right::see, kJoinTime).by.seq == world.records.size());
  CHECK(world.why_not_accepted(kJoiner) == "You have a role already.");
  world.set_password(kVisitorRole);
  world.make(AcceptPassword{kJoiner});
  CHECK(world.state.role_of(kJoiner).name == kBuilderRole);
  world.make(SetPassword{});
  CHECK(world.state.role_of(kJoiner).name == kBuilderRole);
  CHECK(world.why_not_accepted(kOtherJoiner) == "The world has no password.");
}

TEST_CASE("a password is for the player who brings it, and for nobody who is banned", "[rights]") {
  PasswordWorld world;
  world.set_password(kBuilderRole);
  CHECK(world.why(AcceptPassword{kOtherJoiner}, {kJoiner, false}) ==
        "Nobody joins with a password for somebody else.");
  CHECK_FALSE(world.why(AcceptPassword{kOtherJoiner}).empty());  // the console is nobody's key
  world.make(Restrict{RestrictionKind::ban, kJoiner, 0, ""});
  CHECK(world.why_not_accepted(kJoiner) == "You are banned.");
}

TEST_CASE("administrators set a password, for a role that may join", "[rights]") {
  PasswordWorld world;
  const auto set = [](const std::string& role) { return SetPassword{{{role, {}, {}}}}; };
  CHECK(world.why(SetPassword{}) == "The world has no password.");
  CHECK(world.why(set(kBuilderRole)).empty());
  CHECK(
      world.why(set(kNobodyRole)) ==
      "Players with the role \"nobody\" may not join: choose a role with the right see (roles lists them).");
  CHECK(world.why(set("pilot")) == "There is no role \"pilot\" (roles lists them).");
  world.make(GrantRole{kJoiner, kModeratorRole});
  CHECK(world.why(set(kBuilderRole), {kJoiner, false}) == "You need the right \"administer\".");
  world.set_password(kBuilderRole);
  CHECK(world.why(SetPassword{}, {kJoiner, false}) == "You need the right \"administer\".");
  CHECK(world.why(SetPassword{}).empty());
}

TEST_CASE("a record about the password can be taken back", "[rights]") {
  PasswordWorld world;
  world.set_password(kBuilderRole);
  CHECK(inverse_of(world.records, 2) == RightsChange(SetPassword{}));
  world.make(AcceptPassword{kJoiner});
  CHECK(inverse_of(world.records, 3) == RightsChange(GrantRole{kJoiner, ""}));
  world.make(GrantRole{kJoiner, kModeratorRole});
  CHECK_FALSE(inverse_of(world.records, 3).has_value());
  CHECK(inverse_of(world.records, 4) == RightsChange(GrantRole{kJoiner, kBuilderRole}));
  const RightsChange first = world.records[1].change;
  world.make(SetPassword{});
  CHECK_FALSE(inverse_of(world.records, 2).has_value());
  CHECK(inverse_of(world.records, 5) == first);
}

}  // namespace runstone::test
