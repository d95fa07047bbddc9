// Which session is sent which permissions and protected boxes, and when.
#include "server/world/ground/ground_rules.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "protocol/codec/key_fingerprint.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

PublicKey public_key_of(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

ProtectedBox box_named(const char* name, const VoxelBox& where) {
  ProtectedBox box;
  box.name = name;
  box.box = where;
  return box;
}
constexpr VoxelBox kNear = {{0, 0, 0}, {8, 8, 8}}, kFar = {{1000, 0, 0}, {1008, 8, 8}};

struct GroundBench : WorldBench {
  using WorldBench::WorldBench;

  void join_with(SessionId session, std::uint8_t who, std::uint64_t features = kFeatureRights) {
    join(session, who, 1, {}, features);
  }
  Sequence change(const RightsChange& change) {
    const auto done = server.changes().change_rights(change, RightsActor{}, 0, now());
    INFO((done ? std::string() : done.error()));
    REQUIRE(done.has_value());
    return *done;
  }
  std::vector<Permissions> permissions(SessionId session) const {
    return environment.messages<Permissions>(session, kEdge);
  }
  std::vector<ProtectedGround> ground(SessionId session) const {
    return environment.messages<ProtectedGround>(session, kEdge);
  }
  /// Returns the boxes that the session knows by what it was sent.
  std::map<Sequence, GroundBox> known(SessionId session) const {
    std::map<Sequence, GroundBox> boxes;
    for (const ProtectedGround& change : ground(session)) {
      for (const Sequence seq : change.removed) REQUIRE(boxes.erase(seq) == 1);
      for (const GroundBox& box : change.boxes) boxes[box.seq] = box;
    }
    return boxes;
  }
};

}  // namespace

TEST_CASE("a session gets its permissions when it opens, if it has the feature",
          "[world][rights]") {
  GroundBench bench;
  bench.join_with(1, 1);
  bench.join_with(2, 2, 0);
  bench.change(Protect{box_named("spawn", kNear)});
  bench.view(1, kSmall);
  bench.view(2, kSmall);
  bench.tick();
  const auto sent = bench.permissions(1);
  REQUIRE(sent.size() == 1);
  const Role& builder = bench.server.rights().state().find_role(kBuilderRole)->value;
  CHECK(sent[0] == Permissions{kBuilderRole, builder.rights.bits(), builder.edit_volume_max, ""});
  CHECK(bench.ground(1).size() == 1);
  CHECK(bench.permissions(2).empty());
  CHECK(bench.ground(2).empty());
}

TEST_CASE("boxes near the view are sent when the view comes, moves, and when they change",
          "[world][rights]") {
  GroundBench bench;
  const Sequence spawn = bench.change(Protect{box_named("spawn", kNear)});
  bench.change(Protect{box_named("far", kFar)});
  bench.join_with(1, 1);
  bench.tick();
  CHECK(bench.ground(1).empty());  // no view yet
  bench.view(1, kSmall);
  bench.tick();
  REQUIRE(bench.ground(1).size() == 1);
  CHECK(bench.ground(1)[0] == ProtectedGround{{}, {{spawn, kNear, 0, false, "spawn", ""}}});
  bench.tick();
  CHECK(bench.ground(1).size() == 1);

  const Sequence plaza = bench.change(Protect{box_named("plaza", {{2, 2, 2}, {4, 4, 4}})});
  bench.change(Protect{box_named("farther", {{2000, 0, 0}, {2001, 1, 1}})});
  bench.tick();
  REQUIRE(bench.ground(1).size() == 2);
  CHECK(bench.ground(1)[1].boxes.size() == 1);
  CHECK(bench.known(1).contains(plaza));
  bench.change(Unprotect{"plaza"});
  bench.tick();
  CHECK(bench.ground(1).back() == ProtectedGround{{plaza}, {}});

  bench.view(1, {2, {62, 0, 0}, 1, 0});
  bench.tick();
  const auto boxes = bench.known(1);
  REQUIRE(boxes.size() == 1);
  CHECK(boxes.begin()->second.name == "far");
}

TEST_CASE("a box that moves away from the view is forgotten", "[world][rights]") {
  GroundBench bench;
  bench.join_with(1, 1);
  bench.view(1, kSmall);
  bench.change(Protect{box_named("spawn", kNear)});
  bench.tick();
  CHECK(bench.known(1).size() == 1);
  bench.change(Protect{box_named("spawn", kFar)});
  bench.tick();
  CHECK(bench.known(1).empty());
}

TEST_CASE("a new member, another role and another owner change what a box admits",
          "[world][rights]") {
  GroundBench bench;
  bench.join_with(1, 1);
  bench.join_with(2, 2);
  for (const SessionId session : {1U, 2U}) bench.view(session, kSmall);
  ProtectedBox box = box_named("spawn", kNear);
  box.owner = public_key_of(2);
  bench.change(Protect{box});
  bench.tick();
  CHECK_FALSE(bench.known(1).begin()->second.admits);
  CHECK(bench.known(1).begin()->second.owner == "player2");
  CHECK(bench.known(2).begin()->second.admits);
  box.members = {public_key_of(1)};
  const Sequence changed = bench.change(Protect{box});
  bench.tick();
  REQUIRE(bench.known(1).size() == 1);
  CHECK(bench.known(1).at(changed).admits);
  box.members.clear();
  box.owner = public_key_of(3);
  bench.change(Protect{box});
  bench.tick();
  CHECK_FALSE(bench.known(1).begin()->second.admits);
  CHECK(bench.known(1).begin()->second.owner == key_fingerprint(public_key_of(3)));
  bench.change(GrantRole{public_key_of(1), kModeratorRole});
  bench.tick();
  CHECK(bench.known(1).begin()->second.admits);
  CHECK_FALSE(bench.known(2).begin()->second.admits);
  REQUIRE(bench.permissions(1).size() == 2);
  CHECK(bench.permissions(1)[1].role == kModeratorRole);
  CHECK(bench.permissions(2).size() == 1);
}

TEST_CASE("an operator may do everything, also after a change of the settings", "[world][rights]") {
  GroundBench bench;
  bench.change(SetDefaultRole{kVisitorRole});
  bench.change(Protect{box_named("spawn", kNear)});
  bench.join_with(1, 1);
  bench.view(1, kSmall);
  bench.tick();
  CHECK_FALSE(bench.known(1).begin()->second.admits);
  WorldConfig changed = config();
  changed.operators.insert(public_key_of(1));
  bench.server.reconfigure(changed);
  bench.tick();
  CHECK(bench.permissions(1).back().rights == RightSet::all().bits());
  CHECK(bench.known(1).begin()->second.admits);
}

TEST_CASE("a restriction is announced, and its end too", "[world][rights]") {
  GroundBench bench;
  bench.join_with(1, 1);
  bench.tick();
  const std::uint32_t rights = bench.permissions(1)[0].rights;
  bench.change(Restrict{RestrictionKind::mute, public_key_of(1), 0, ""});
  const TimeUs until = bench.now().utc_us + 10'000'000;
  bench.change(Restrict{RestrictionKind::freeze, public_key_of(1), until, "griefing"});
  bench.tick();
  REQUIRE(bench.permissions(1).size() == 2);
  const Permissions frozen = bench.permissions(1)[1];
  CHECK(frozen.edits_refused.starts_with("you may not edit until "));
  CHECK(frozen.edits_refused.ends_with(": griefing"));
  RightSet left = RightSet::of_bits(rights);
  for (const Right right : {Right::build, Right::build_protected, Right::undo, Right::chat})
    left.remove(right);
  CHECK(frozen.rights == left.bits());
  bench.tick(9'000'000);
  CHECK(bench.permissions(1).size() == 2);
  bench.tick(1'000'000);
  REQUIRE(bench.permissions(1).size() == 3);
  CHECK(bench.permissions(1)[2].edits_refused.empty());
  left = RightSet::of_bits(rights);
  left.remove(Right::chat);
  CHECK(bench.permissions(1)[2].rights == left.bits());
}

TEST_CASE("what does not fit a full queue is sent later", "[world][rights]") {
  GroundBench bench;
  bench.join_with(1, 1);
  bench.view(1, kSmall);
  bench.tick();
  bench.environment.full.insert(1);
  bench.change(Protect{box_named("spawn", kNear)});
  bench.change(GrantRole{public_key_of(1), kVisitorRole});
  for (int i = 0; i < 3; ++i) bench.tick();
  bench.environment.full.clear();
  bench.tick();
  CHECK(bench.known(1).size() == 1);
  REQUIRE(bench.permissions(1).size() == 2);
  CHECK(bench.permissions(1)[1].role == kVisitorRole);
  bench.tick();
  CHECK(bench.ground(1).size() == 1);
  CHECK(bench.permissions(1).size() == 2);
}

TEST_CASE("of too many boxes a session knows those near the centre of its view",
          "[world][rights]") {
  GroundBench bench;
  bench.join_with(1, 1);
  bench.view(1, {1, {0, 0, 0}, 4, 0});
  const auto protect_column = [&](int i, std::int32_t x, std::int32_t y) {
    bench.change(
        Protect{box_named(("b" + std::to_string(i)).c_str(), {{x, y, 0}, {x + 1, y + 1, 1}})});
  };
  for (int i = 0; i < 100; ++i) protect_column(i, i % 10, i / 10);
  for (int i = 100; i < 1200; ++i) protect_column(i, 48 + i % 16, i / 100);
  bench.tick();
  const auto boxes = bench.known(1);
  CHECK(boxes.size() == 100);  // those within two chunks of the centre
  for (const auto& [seq, box] : boxes) CHECK(box.box.max.x <= 48);
  for (int i = 1200; i < 2400; ++i) protect_column(i, i % 16, i / 160);
  bench.tick();
  CHECK(bench.known(1).size() == kGroundBoxesMax);
}

TEST_CASE("many sessions take turns on a tick", "[world][rights]") {
  GroundBench bench;
  for (int i = 0; i < 1000; ++i)
    bench.change(Protect{box_named(("b" + std::to_string(i)).c_str(),
                                   {{i % 16, i / 16 % 16, i / 256}, {i % 16 + 1, 16, 16}})});
  constexpr SessionId kSessions = 40;
  for (SessionId id = 1; id <= kSessions; ++id) {
    bench.join_with(id, static_cast<std::uint8_t>(id));
    bench.view(id, kSmall);
  }
  const auto served = [&] {
    std::size_t count = 0;
    for (SessionId id = 1; id <= kSessions; ++id) count += bench.known(id).empty() ? 0 : 1;
    return count;
  };
  bench.tick();
  CHECK(served() < kSessions);
  CHECK(served() * 1000 >= kGroundBoxesPerTick);
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(served() == kSessions);
}

TEST_CASE("a session that looks at the past gets boxes when it is back", "[world][rights]") {
  GroundBench bench;
  bench.join_with(1, 1);
  bench.view(1, kSmall);
  bench.tick();
  bench.server.received(1, HistoryRequest{1, HistoryTarget::sequence, 0, 0}, bench.now());
  bench.server.ground().history_opened(1, 1, OpenedHistory{0, 0}, bench.now());
  bench.change(Protect{box_named("spawn", kNear)});
  bench.tick();
  CHECK(bench.known(1).empty());
  bench.server.received(1, HistoryRequest{2, HistoryTarget::live, 0, 0}, bench.now());
  bench.tick(1'000'000);
  bench.tick();
  CHECK(bench.known(1).size() == 1);
}

}  // namespace runstone::test
