#include "client/replica/known_ground.hpp"

#include <catch2/catch.hpp>

#include "common/rights/right.hpp"
#include "protocol/limits.hpp"
#include "tests/unit/client/replica/replica_bench.hpp"

namespace runstone::test {
namespace {

const Permissions kBuilds{"builder", RightSet{Right::build}.bits(), 0, ""};
const Permissions kLooks{"visitor", RightSet{Right::see}.bits(), 0, ""};

GroundBox ground_box(Sequence seq, const VoxelBox& where, bool admits, const char* name,
                     std::int32_t priority = 0) {
  return {seq, where, priority, admits, name, ""};
}
constexpr VoxelBox kTown = {{0, 0, 0}, {10, 10, 10}}, kPlaza = {{4, 0, 4}, {6, 10, 6}};
const EditDescriptor kInTown = ReplicaBench::set({1, 1, 1}, 1),
                     kInPlaza = ReplicaBench::set({5, 5, 5}, 1),
                     kOutside = ReplicaBench::set({11, 1, 1}, 1);

KnownGround ground_with(const Permissions& permissions, std::vector<GroundBox> boxes) {
  KnownGround ground;
  ground.receive(permissions);
  REQUIRE(ground.receive(ProtectedGround{{}, std::move(boxes)}).has_value());
  return ground;
}

}  // namespace

TEST_CASE("without a word of the server every edit is allowed", "[replica][rights]") {
  const KnownGround ground;
  CHECK_FALSE(ground.refusal(kInTown));
}

TEST_CASE("the role, its volume and a restriction refuse edits", "[replica][rights]") {
  KnownGround ground;
  ground.receive(kLooks);
  CHECK(ground.refusal(kInTown) == "your role does not allow it: visitor");
  ground.receive(kBuilds);
  CHECK_FALSE(ground.refusal(kInTown));
  Permissions limited = kBuilds;
  limited.edit_volume_max = 8;
  ground.receive(limited);
  CHECK_FALSE(ground.refusal(ReplicaBench::box({0, 0, 0}, {2, 2, 2}, 1)));
  CHECK(ground.refusal(ReplicaBench::box({0, 0, 0}, {3, 3, 1}, 1)) ==
        "edits of your role have at most 8 voxels");
  Permissions frozen = kBuilds;
  frozen.edits_refused = "you may not edit: griefing";
  ground.receive(frozen);
  CHECK(ground.refusal(kInTown) == "you may not edit: griefing");
  ground.clear();
  CHECK_FALSE(ground.refusal(kInTown));
}

TEST_CASE("the box that decides first refuses an edit by its name", "[replica][rights]") {
  const KnownGround town = ground_with(
      kBuilds, {ground_box(1, kTown, false, "town"), ground_box(2, kPlaza, true, "plaza")});
  CHECK(town.refusal(kInTown) == "the ground is protected: town");
  CHECK_FALSE(town.refusal(kInPlaza));  // among equal priorities the newer one decides
  CHECK_FALSE(town.refusal(kOutside));
  CHECK(town.refusal(ReplicaBench::box({4, 0, 4}, {7, 2, 6}, 1)) ==
        "the ground is protected: town");
  CHECK_FALSE(town.refusal(ReplicaBench::box({4, 0, 4}, {6, 2, 6}, 1)));
  const KnownGround high = ground_with(
      kBuilds, {ground_box(1, kTown, false, "town", 1), ground_box(2, kPlaza, true, "plaza")});
  CHECK(high.refusal(kInPlaza) == "the ground is protected: town");
  const KnownGround guest = ground_with(kLooks, {ground_box(1, kTown, true, "town")});
  CHECK_FALSE(guest.refusal(kInTown));
  CHECK(guest.refusal(kOutside) == "your role does not allow it: visitor");
}

TEST_CASE("changes of the ground replace and remove boxes, within a bound", "[replica][rights]") {
  KnownGround ground = ground_with(kBuilds, {ground_box(1, kTown, false, "town")});
  REQUIRE(ground.receive(ProtectedGround{{}, {ground_box(1, kTown, true, "town")}}).has_value());
  CHECK_FALSE(ground.refusal(kInTown));
  REQUIRE(
      ground.receive(ProtectedGround{{1, 7}, {ground_box(3, kPlaza, false, "town")}}).has_value());
  CHECK(ground.boxes().size() == 1);
  CHECK(ground.refusal(kInPlaza) == "the ground is protected: town");
  ProtectedGround most;
  for (Sequence seq = 10; seq < 10 + kGroundBoxesMax - 1; ++seq)
    most.boxes.push_back(ground_box(seq, kTown, true, "b"));
  REQUIRE(ground.receive(most).has_value());
  CHECK_FALSE(ground.receive(ProtectedGround{{}, {ground_box(9, kTown, true, "b")}}).has_value());
}

TEST_CASE_METHOD(ReplicaBench, "a refused edit is neither shown nor kept", "[replica][rights]") {
  load(kHere);
  replica.receive(kBuilds);
  REQUIRE(replica.receive(ProtectedGround{{}, {ground_box(1, kTown, false, "town")}}).has_value());
  const auto refused = replica.predict(kInTown, 500, 600);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::not_permitted);
  CHECK(replica.local_edits().all().empty());
  CHECK(replica.shown_at({1, 1, 1}) != Material{1});
  CHECK(replica.drain_changes().edits.empty());
  predict(kOutside);
  static_cast<void>(replica.open(parameters()));  // another session begins without rules
  CHECK(replica.ground().boxes().empty());
  predict(kInTown);
}

}  // namespace runstone::test
