// Local edits and their predictions.
#include "tests/unit/client/replica/replica_bench.hpp"

using namespace runstone;
using runstone::test::chunks_of;
using runstone::test::ReplicaBench;

TEST_CASE_METHOD(ReplicaBench,
                 "where nothing is pending the shown runs are the confirmed object itself",
                 "[replica]") {
  load(kHere);
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
  take(world.commit(other(1), set({3, 4, 5}, 2)));
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
  predict(set({1, 1, 1}, 3));
  CHECK(replica.shown(kHere).get() != &replica.confirmed(kHere)->voxels);
  CHECK(material_at(replica.confirmed(kHere)->voxels, {1, 1, 1}) == kEmpty);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a local edit shows at once and is not meshed again when it is confirmed",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = predict(set({3, 4, 5}, 2));
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.edits.size() == 1);
  CHECK(changes.edits[0].predicted);
  CHECK(changes.edits[0].chunks == std::vector{kHere});
  const std::uint64_t serial = replica.shown_serial(kHere);

  take(world.commit(mine(seq), set({3, 4, 5}, 2)));
  require_in_step(kHere);
  CHECK(replica.shown_serial(kHere) == serial);
  changes = replica.drain_changes();
  CHECK(changes.chunks.empty());
  REQUIRE(changes.edits.size() == 1);
  CHECK(changes.edits[0].is_local);
  CHECK_FALSE(changes.edits[0].predicted);
  CHECK(changes.edits[0].chunks.empty());
}

TEST_CASE_METHOD(ReplicaBench,
                 "a local edit leaves when the durable watermark reaches it, and not before",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = predict(set({3, 4, 5}, 2));
  take(world.commit(mine(seq), set({3, 4, 5}, 2)));
  CHECK(replica.local_edits().all().size() == 1);
  CHECK(replica.local_edits().pending_count() == 0);
  replica.receive(Durable{world.epoch(), 0});
  CHECK(replica.local_edits().all().size() == 1);
  replica.receive(Durable{world.epoch(), 1});
  CHECK(replica.local_edits().all().empty());
  CHECK(replica.drain_changes().durable == std::vector{seq});
}

TEST_CASE_METHOD(ReplicaBench, "a watermark that overtakes the commit retires the local edit",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = predict(set({3, 4, 5}, 2));
  const Commit commit = world.commit(mine(seq), set({3, 4, 5}, 2));
  replica.receive(Durable{world.epoch(), 1});
  CHECK(replica.local_edits().all().size() == 1);
  take(commit);
  CHECK(replica.local_edits().all().empty());
}

TEST_CASE_METHOD(ReplicaBench, "a reject removes its prediction and no other", "[replica]") {
  load(kHere);
  const ClientSequence first = predict(set({3, 4, 5}, 2));
  predict(box({3, 4, 5}, {5, 5, 6}, 6, {MaskKind::only_empty, kEmpty}));
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(replica.shown_at({4, 4, 5}) == Material{6});
  static_cast<void>(replica.drain_changes());
  replica.receive(Reject{first, RejectReason::rate_limited, "slow down"}, 2000);
  // The second edit is applied again: it finds empty what the first one had filled.
  CHECK(replica.shown_at({3, 4, 5}) == Material{6});
  CHECK(replica.shown_at({4, 4, 5}) == Material{6});
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.rejects.size() == 1);
  CHECK(changes.rejects[0].seq == first);
  CHECK(changes.rejects[0].reason == RejectReason::rate_limited);
  REQUIRE(changes.chunks.size() == 1);
  CHECK(changes.chunks[0].layers.here.layer[0].count() == 1);
  CHECK(replica.local_edits().all().size() == 1);
}

TEST_CASE_METHOD(ReplicaBench, "pending edits stay on top of commits that arrive in between",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = predict(set({3, 4, 5}, 2));
  take(world.commit(other(1), set({3, 4, 5}, 7)));
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(material_at(replica.confirmed(kHere)->voxels, {3, 4, 5}) == Material{7});
  take(world.commit(other(2), set({9, 9, 9}, 7)));
  CHECK(replica.shown_at({9, 9, 9}) == Material{7});
  take(world.commit(mine(seq), set({3, 4, 5}, 2)));
  require_in_step(kHere);
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a local edit in a chunk that has not arrived shows with its snapshot",
                 "[replica]") {
  predict(set({3, 4, 5}, 2));
  CHECK_FALSE(replica.shown_at({3, 4, 5}).has_value());
  load(kHere);
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(material_at(replica.confirmed(kHere)->voxels, {3, 4, 5}) == kEmpty);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a local edit confirmed by a snapshot that overtook its commit is not shown twice",
                 "[replica]") {
  load(kHere);
  const EditDescriptor fill = box({4, 4, 4}, {6, 5, 5}, 3, {MaskKind::only_empty, kEmpty});
  const ClientSequence seq = predict(fill);
  const Commit own = world.commit(mine(seq), fill);
  const Commit dig = world.commit(other(1), set({5, 4, 4}, kEmpty));
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);  // contains both
  take(own);
  CHECK(replica.shown_at({5, 4, 4}) == kEmpty);
  take(dig);
  require_in_step(kHere);
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
}

TEST_CASE_METHOD(
    ReplicaBench,
    "after a restart chunks that may be lost are dropped and local edits offered again",
    "[replica]") {
  load(kHere);
  load(kRight);
  std::vector<std::pair<OperationId, EditDescriptor>> kept;
  const ClientSequence first = predict(set({3, 4, 5}, 2));
  kept.emplace_back(mine(first), set({3, 4, 5}, 2));
  take(world.commit(mine(first), set({3, 4, 5}, 2)));  // sequence 1, durable
  const ClientSequence second = predict(set({20, 1, 1}, 3));
  take(world.commit(mine(second), set({20, 1, 1}, 3)));      // sequence 2, lost in the crash
  const ClientSequence third = predict(set({21, 1, 1}, 4));  // never answered
  replica.receive(Durable{world.epoch(), 1});

  world.restart(kept);
  const auto offers = replica.open(parameters(first, 1));
  CHECK(offers == std::vector{second, third});
  CHECK(replica.confirmed(kHere) != nullptr);
  CHECK(replica.confirmed(kRight) == nullptr);
  CHECK(replica.counters().dropped_by_epoch == 1);
  CHECK(replica.shown_at({20, 1, 1}) == Material{3});  // shown until the snapshot
  replica.receive(chunks_of(world.snapshot(kRight.at)), kNow);
  CHECK(replica.shown_at({20, 1, 1}) == Material{3});  // predicted again
  CHECK(material_at(replica.confirmed(kRight)->voxels, {4, 1, 1}) == kEmpty);

  take(world.commit(mine(second), set({20, 1, 1}, 3)));
  take(world.commit(mine(third), set({21, 1, 1}, 4)));
  require_in_step(kRight);
  replica.receive(Durable{world.epoch(), world.head()});
  CHECK(replica.local_edits().all().empty());
}

TEST_CASE_METHOD(ReplicaBench,
                 "after a reconnection an edit that the server has resolved is not offered again",
                 "[replica]") {
  load(kHere);
  const EditDescriptor fill = box({4, 4, 4}, {6, 5, 5}, 3, {MaskKind::only_empty, kEmpty});
  const ClientSequence seq = predict(fill);
  static_cast<void>(world.commit(mine(seq), fill));  // applied, but the commit did not arrive
  static_cast<void>(world.commit(other(1), set({5, 4, 4}, kEmpty)));
  CHECK(replica.open(parameters(seq)) == std::vector{seq});  // to get the answer
  CHECK(replica.local_edits().counters().offered_again == 0);
  CHECK(replica.shown_at({5, 4, 4}) == Material{3});  // until the snapshot
  CHECK(replica.local_edits().all().size() == 1);     // and it is kept until durable
  replica.receive(Reject{seq, RejectReason::already_resolved, "", world.head()}, 2000);
  CHECK(replica.drain_changes().rejects.empty());
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  CHECK(replica.shown_at({5, 4, 4}) == kEmpty);
  require_in_step(kHere);
  replica.receive(Durable{world.epoch(), world.head() - 1});
  CHECK(replica.local_edits().all().size() == 1);
  replica.receive(Durable{world.epoch(), world.head()});
  CHECK(replica.local_edits().all().empty());
  const ReplicaChanges changes = replica.drain_changes();
  CHECK(changes.unseen == std::vector{seq});
  CHECK(changes.durable.empty());
}

TEST_CASE_METHOD(ReplicaBench,
                 "a prediction rejected while disconnected is removed by an equal snapshot",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = predict(set({3, 4, 5}, 2));
  CHECK(replica.open(parameters(seq)) == std::vector{seq});
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
  replica.receive(Reject{seq, RejectReason::rate_limited, "", 0},
                  2000);  // the late answer
  CHECK(replica.drain_changes().rejects.size() == 1);
  CHECK(replica.local_edits().all().empty());
}

TEST_CASE_METHOD(ReplicaBench, "an edit that was resolved unseen makes its chunk be requested",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = predict(set({3, 4, 5}, 2));
  static_cast<void>(world.commit(mine(seq), set({3, 4, 5}, 2)));
  replica.receive(Reject{seq, RejectReason::already_resolved, ""}, 2000);
  CHECK(replica.take_requests() == std::vector{kHere});
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(replica.drain_changes().rejects.empty());
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  require_in_step(kHere);
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
}

TEST_CASE_METHOD(
    ReplicaBench,
    "a prediction is removed when another server orders, and the reject was lost with the first one",
    "[replica]") {
  load(kHere);
  const ClientSequence rejected = predict(set({3, 4, 5}, 2));
  CHECK(replica.resume(rejected) == std::vector{rejected});
  replica.receive(Reject{rejected, RejectReason::already_resolved, ""}, 2000);
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
  CHECK(replica.local_edits().all().empty());
  require_in_step(kHere);
}

TEST_CASE_METHOD(ReplicaBench, "local edits beyond the bound are refused before anything is shown",
                 "[replica]") {
  Replica fresh;
  CHECK_FALSE(fresh.predict(set({0, 0, 0}, 1), 0, 0).has_value());  // no world yet
  static_cast<void>(fresh.open({kEdge, kMe, kInstance, 1, 0, 0, 0}));
  CHECK_FALSE(fresh.predict(box({0, 0, 0}, {0, 1, 1}, 1), 0, 0).has_value());
  for (std::size_t i = 0; i < kLocalEditsMax; ++i)
    REQUIRE(fresh.predict(set({0, 0, 0}, 1), 0, 0).has_value());
  CHECK_FALSE(fresh.predict(set({0, 0, 0}, 1), 0, 0).has_value());
  CHECK(fresh.local_edits().all().size() == kLocalEditsMax);
}

TEST_CASE_METHOD(
    ReplicaBench,
    "a stale snapshot after a reconnection removes predictions that were answered meanwhile",
    "[replica]") {
  load(kHere);
  const ClientSequence seq = predict(set({3, 4, 5}, 2));
  static_cast<void>(replica.open(parameters(seq)));  // rejected, but the answer was lost
  const ChunkSnapshot overtaken = world.snapshot(kHere.at);
  take(world.commit(other(1), set({1, 1, 1}, 2)));
  replica.receive(chunks_of(overtaken), kNow);
  CHECK(replica.counters().snapshots_stale == 1);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a prediction whose edit is gone does not survive a restart that lost the reject",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = predict(set({3, 4, 5}, 2));
  static_cast<void>(replica.open(parameters(seq)));
  replica.receive(Reject{seq, RejectReason::already_resolved, "", 0},
                  2000);  // the server has lost the outcome
  CHECK(replica.local_edits().all().empty());
  world.restart({});
  CHECK(replica.open(parameters(0)).empty());
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
}

TEST_CASE_METHOD(ReplicaBench, "an edit beyond the world's heights is refused before it is shown",
                 "[replica]") {
  SessionParameters low = parameters();
  low.heights = {-16, 8};
  static_cast<void>(replica.open(low));
  load(kHere);
  CHECK(replica.predict(set({1, 7, 1}, 2), 0, 0).has_value());
  CHECK_FALSE(replica.predict(set({1, 8, 1}, 2), 0, 0).has_value());
  CHECK_FALSE(replica.predict({FillSphere{{4, 4, 4}, 4}, {}, 2}, 0, 0).has_value());
  CHECK(replica.shown_at({4, 4, 4}) == kEmpty);
  CHECK(replica.local_edits().all().size() == 1);
}

TEST_CASE_METHOD(ReplicaBench,
                 "an edit larger than the server allows is refused before it is shown",
                 "[replica]") {
  SessionParameters small = parameters();
  small.edit_volume_max = 8;
  static_cast<void>(replica.open(small));
  load(kHere);
  CHECK(replica.predict({FillBox{{{1, 1, 1}, {3, 3, 3}}}, {}, 2}, 0, 0).has_value());
  const auto refused = replica.predict({FillBox{{{4, 1, 1}, {7, 4, 2}}}, {}, 2}, 0, 0);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(replica.shown_at({4, 1, 1}) == kEmpty);
  CHECK(replica.local_edits().all().size() == 1);
}

TEST_CASE_METHOD(ReplicaBench, "an edit change names the earlier edit that it refers to",
                 "[replica]") {
  load(kHere);
  take(world.commit(other(1), set({3, 4, 5}, 2)));
  Commit undo = world.commit(other(2), set({3, 4, 5}, kEmpty));
  undo.edits[0].cause = Cause::undo;
  undo.edits[0].subject = 1;
  take(undo);
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.edits.size() == 2);
  CHECK(changes.edits[0].subject == 0);
  CHECK(changes.edits[1].subject == 1);
}

TEST_CASE_METHOD(ReplicaBench, "the memory of edits that wait counts until they are applied",
                 "[replica]") {
  load(kHere);
  const std::size_t loaded = replica.chunk_bytes();
  const ClientSequence seq = predict(box({0, 0, 0}, {9, 9, 9}, 2));
  CHECK(replica.chunk_bytes() > loaded);  // the shown runs are no longer the confirmed ones
  replica.receive(Reject{seq, RejectReason::busy, "", 0}, 700);
  CHECK(replica.chunk_bytes() == loaded);

  static_cast<void>(world.commit(other(1), set({1, 1, 1}, 3)));  // is lost
  take(world.commit(other(2), set({2, 1, 1}, 3)));               // does not follow
  take(world.commit(other(3), set({3, 1, 1}, 3)));
  CHECK(replica.chunk_bytes() > loaded + 2 * sizeof(OrderedInfo));
  load(kHere);
  require_in_step(kHere);
  CHECK(replica.chunk_bytes() < loaded + 2 * sizeof(OrderedInfo));
  replica.set_view({2, {50, 0, 0}, 2, 2});
  CHECK(replica.chunk_bytes() == 0);
}
