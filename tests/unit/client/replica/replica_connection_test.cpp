// What a replica keeps, trusts and claims when another connection opens.
#include "common/runs/layer_diff.hpp"
#include "tests/unit/client/replica/replica_bench.hpp"

using namespace runstone;
using runstone::test::chunks_of;
using runstone::test::ReplicaBench;

TEST_CASE_METHOD(ReplicaBench, "answers on a new connection count although their numbers are low",
                 "[replica]") {
  replica.set_view({2, {10, 0, 0}, 1, 1});
  replica.set_view({3, {0, 0, 0}, 2, 2});
  static_cast<void>(replica.open(parameters()));
  replica.receive(chunks_of(world.snapshot(kHere.at), 1), kNow);
  require_in_step(kHere);
}

TEST_CASE_METHOD(ReplicaBench, "a late answer to a claim does not answer the next claim",
                 "[replica]") {
  load(kHere);
  const ChunkPtr held = replica.confirmed(kHere);
  static_cast<void>(replica.open(parameters()));
  REQUIRE(replica.take_claims().size() == 1);
  replica.set_view({2, {10, 0, 0}, 1, 1});
  replica.set_view({3, {0, 0, 0}, 2, 2});
  replica.adopt(kHere, held, 2000);
  REQUIRE(replica.take_claims().size() == 1);
  replica.receive(ChunksNotModified{1, {{kHere, 0}}}, 2000);
  CHECK(replica.current_count() == 0);
  replica.receive(ChunksNotModified{3, {{kHere, 0}}}, 2000);
  CHECK(replica.current_count() == 1);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a log that grew past its old end with other edits makes old versions untrusted",
                 "[replica]") {
  load(kHere);
  take(world.commit(other(1), set({3, 4, 5}, 2)));  // sequence 1, seen, lost in the crash
  world.restart({});
  static_cast<void>(
      world.commit(other(2), set({30, 4, 5}, 2)));  // sequence 1 again, elsewhere, and durable
  static_cast<void>(replica.open(parameters(0, 1)));
  CHECK(replica.confirmed(kHere) == nullptr);
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
  require_in_step(kHere);
}

TEST_CASE_METHOD(ReplicaBench,
                 "after a reconnection a commit before its snapshot waits and requests nothing",
                 "[replica]") {
  load(kHere);
  static_cast<void>(world.commit(other(1), set({1, 1, 1}, 2)));  // while disconnected
  CHECK(replica.open(parameters()).empty());
  CHECK(replica.current_count() == 0);
  const ChunkSnapshot overtaken = world.snapshot(kHere.at);
  take(world.commit(other(2), set({2, 1, 1}, 2)));
  CHECK(replica.take_requests().empty());
  CHECK(replica.confirmed(kHere)->version.seq == 0);
  replica.receive(chunks_of(overtaken), kNow);
  require_in_step(kHere);
  CHECK(replica.current_count() == 1);
  CHECK(replica.counters().gaps == 0);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a gap that the first snapshot after a reconnection leaves is requested",
                 "[replica]") {
  load(kHere);
  CHECK(replica.open(parameters()).empty());
  const ChunkSnapshot equal = world.snapshot(kHere.at);
  static_cast<void>(world.commit(other(1), set({1, 1, 1}, 2)));  // not sent to this client
  take(world.commit(other(2), set({2, 1, 1}, 2)));
  CHECK(replica.take_requests().empty());
  replica.receive(chunks_of(equal), kNow);
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  require_in_step(kHere);
}

TEST_CASE_METHOD(ReplicaBench, "a chunk of an earlier connection that became unavailable is hidden",
                 "[replica]") {
  load(kHere);
  load(kRight);
  CHECK(replica.open(parameters()).empty());
  replica.receive(ChunkUnavailable{1, {kHere}, UnavailableReason::damaged});
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK(replica.shown(kHere) == nullptr);
  CHECK(replica.confirmed_count() == 1);
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.chunks.size() == 2);
  CHECK(changes.chunks[0].removed);
  ChangedLayers beside;
  beside.beyond[static_cast<std::size_t>(Direction::neg_x)] = all_layers(Extent::cube(kEdge));
  CHECK(changes.chunks[1].layers == beside);
  static_cast<void>(replica.open(parameters()));  // it may have been repaired
  CHECK(replica.unavailable_count() == 0);
  replica.receive(ChunkUnavailable{1, {kHere}, UnavailableReason::damaged});
  replica.set_view({2, {3, 0, 0}, 2, 2});
  CHECK(replica.unavailable_count() == 0);
}

TEST_CASE_METHOD(ReplicaBench, "after a restored backup no edited chunk is trusted", "[replica]") {
  load(kRight);
  take(world.commit(other(1), set({3, 4, 5}, 2)));
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  const ClientSequence seq = predict(set({20, 1, 1}, 3));
  take(world.commit(mine(seq), set({20, 1, 1}, 3)));
  replica.receive(Durable{world.epoch(), 2});
  REQUIRE(replica.confirmed(kHere) != nullptr);
  REQUIRE(replica.confirmed(kRight) != nullptr);
  SessionParameters restored = parameters();
  SECTION("an older epoch") { restored.epoch = 0; }
  SECTION("a log that is shorter than what was durable here") {
    restored.epoch += 3;
    restored.durable = restored.head = 1;
  }
  SECTION("the same epoch, and an end of the log before one that we saw") {
    static_cast<void>(world.commit(other(2), set({3, 4, 5}, 4)));
    replica.receive(Durable{world.epoch(), 0});
    restored.head = 1;
    restored.durable = 2;
  }
  SECTION("another branch, whose log is longer than what we saw") {
    restored.epoch += kEpochsPerBranch;
    restored.durable = restored.head = 1000;
  }
  CHECK(replica.open(restored).empty());  // the local edit was durable and is not offered again
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK(replica.confirmed(kRight) == nullptr);
}

TEST_CASE_METHOD(ReplicaBench, "a claim that is answered with an unavailable chunk waits no longer",
                 "[replica]") {
  load(kHere);
  static_cast<void>(replica.open(parameters()));
  CHECK(replica.take_claims().size() == 1);
  replica.receive(ChunkUnavailable{1, {kHere}, UnavailableReason::damaged});
  CHECK(replica.take_claims().empty());
  CHECK(replica.missing().size() == 64);  // of 65 chunks in view
}
