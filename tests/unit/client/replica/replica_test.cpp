// Views, snapshots, commits and digest checks.
#include "tests/unit/client/replica/replica_bench.hpp"

using namespace runstone;
using runstone::test::chunks_of;
using runstone::test::ReplicaBench;

TEST_CASE_METHOD(ReplicaBench,
                 "a commit that follows the snapshot is applied and reported with its layers",
                 "[replica]") {
  load(kHere);
  take(world.commit(other(1), set({3, 4, 5}, 2)));
  require_in_step(kHere);
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.chunks.size() == 1);
  CHECK(changes.chunks[0].key == kHere);
  CHECK(changes.chunks[0].layers.here.layer[0].count() == 1);
  CHECK(changes.chunks[0].layers.here.layer[0].test(3));
  CHECK(changes.chunks[0].layers.here.layer[1].test(4));
  CHECK(changes.chunks[0].layers.here.layer[2].test(5));
  CHECK(changes.chunks[0].edits == std::vector{other(1)});
  REQUIRE(changes.edits.size() == 1);
  CHECK(changes.edits[0].op == other(1));
  CHECK_FALSE(changes.edits[0].is_local);
  CHECK(changes.edits[0].seq == 1);
  CHECK(changes.edits[0].received_us == 1000);
  CHECK(changes.edits[0].unpacked_us == 1100);
  CHECK(changes.edits[0].applied_us == 1200);
  CHECK(changes.edits[0].chunks == std::vector{kHere});
}

TEST_CASE_METHOD(ReplicaBench, "an edit at the border changes the mesh of the neighbour",
                 "[replica]") {
  load(kHere);
  load(kRight);
  take(world.commit(other(1), set({15, 4, 5}, 2)));
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.chunks.size() == 2);
  CHECK(changes.chunks[1].key == kRight);
  CHECK_FALSE(changes.chunks[1].layers.here.any());
  ChangedLayers beside;
  beside.beyond[static_cast<std::size_t>(Direction::neg_x)] = changes.chunks[0].layers.here;
  CHECK(changes.chunks[1].layers == beside);
  CHECK(changes.chunks[0].layers.beyond == ChangedLayers{}.beyond);
  CHECK(changes.edits[0].chunks == std::vector{kHere, kRight});
}

TEST_CASE_METHOD(ReplicaBench,
                 "commits that overtake their snapshot are held back and then applied",
                 "[replica]") {
  const ChunkSnapshot early = world.snapshot(kHere.at);
  take(world.commit(other(1), set({1, 2, 3}, 2)));
  take(world.commit(other(2), set({2, 2, 3}, 4)));
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK(replica.counters().chunk_edits_buffered == 2);
  replica.receive(chunks_of(early), kNow);
  require_in_step(kHere);
  CHECK(replica.counters().chunk_edits_applied == 2);
  CHECK(replica.drain_changes().edits.size() == 2);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a snapshot that contains held back commits replaces them and reports them",
                 "[replica]") {
  take(world.commit(other(1), set({1, 2, 3}, 2)));
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  require_in_step(kHere);
  CHECK(replica.counters().chunk_edits_contained == 1);
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.edits.size() == 1);
  CHECK(changes.edits[0].in_snapshot);
  CHECK(changes.edits[0].chunks == std::vector{kHere});
}

TEST_CASE_METHOD(ReplicaBench, "chunks of one material are taken like snapshots, with their digest",
                 "[replica]") {
  const ChunkKey above{0, {kHere.at.x, kHere.at.y + 1, kHere.at.z}};
  const Version old{1, 4}, newer{1, 9};
  replica.receive(UniformChunks{1, {{kHere, 3, newer}, {above, 3, {}}}}, kNow);
  for (const ChunkKey& key : {kHere, above}) {
    const ChunkPtr chunk = replica.confirmed(key);
    REQUIRE(chunk != nullptr);
    CHECK(chunk->voxels.is_uniform());
    CHECK(material_at(chunk->voxels, {1, 2, 3}) == 3);
    CHECK(chunk->digest == digest_of(chunk->voxels));
  }
  CHECK(replica.confirmed(kHere)->version == newer);
  replica.receive(UniformChunks{1, {{kHere, 2, old}}}, kNow);  // stale
  CHECK(material_at(replica.confirmed(kHere)->voxels, {1, 2, 3}) == 3);
  replica.receive(UniformChunks{1, {{{0, {1'000, 0, 0}}, 2, {}}}}, kNow);  // outside of the view
  CHECK(replica.confirmed({0, {1'000, 0, 0}}) == nullptr);
}

TEST_CASE_METHOD(ReplicaBench, "a stale snapshot never erases a newer edit", "[replica]") {
  const ChunkSnapshot stale = world.snapshot(kHere.at);
  load(kHere);
  take(world.commit(other(1), set({1, 2, 3}, 2)));
  replica.receive(chunks_of(stale), kNow);
  require_in_step(kHere);
  CHECK(replica.counters().snapshots_stale == 1);
  CHECK(replica.shown_at({1, 2, 3}) == Material{2});
}

TEST_CASE_METHOD(ReplicaBench, "a chunk with a gap requests a snapshot until it arrives",
                 "[replica]") {
  load(kHere);
  static_cast<void>(world.commit(other(1), set({1, 2, 3}, 2)));  // lost
  take(world.commit(other(2), set({2, 2, 3}, 4)));
  CHECK(replica.counters().gaps == 1);
  CHECK(replica.awaiting_count() == 1);
  CHECK(replica.take_requests() == std::vector{kHere});
  CHECK(replica.shown_at({2, 2, 3}) == kEmpty);
  take(world.commit(other(3), set({3, 2, 3}, 4)));  // held back meanwhile
  CHECK(replica.take_requests().empty());

  replica.tick(kNow.now_us + kRequestAgainUs - 1);
  CHECK(replica.take_requests().empty());
  replica.tick(kNow.now_us + kRequestAgainUs);
  CHECK(replica.take_requests() == std::vector{kHere});

  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  require_in_step(kHere);
  CHECK(replica.awaiting_count() == 0);
}

TEST_CASE_METHOD(ReplicaBench, "a snapshot that still leaves a gap is followed by another request",
                 "[replica]") {
  load(kHere);
  static_cast<void>(world.commit(other(1), set({1, 2, 3}, 2)));  // lost
  const ChunkSnapshot between = world.snapshot(kHere.at);
  static_cast<void>(world.commit(other(2), set({1, 3, 3}, 2)));  // lost
  take(world.commit(other(3), set({2, 2, 3}, 4)));
  static_cast<void>(replica.take_requests());
  replica.receive(chunks_of(between), kNow);
  CHECK(replica.awaiting_count() == 1);
  CHECK(replica.take_requests().empty());
  replica.tick(kNow.now_us + kRequestAgainUs);
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  require_in_step(kHere);
}

TEST_CASE_METHOD(ReplicaBench, "the same commit twice is applied once", "[replica]") {
  load(kHere);
  // Not idempotent: the second application would fill what the mask left empty in between.
  take(world.commit(other(1), set({4, 4, 4}, 2)));
  const Commit fill =
      world.commit(other(2), box({4, 4, 4}, {6, 5, 5}, 3, {MaskKind::only_empty, kEmpty}));
  take(fill);
  take(world.commit(other(3), set({5, 4, 4}, kEmpty)));
  take(fill);
  require_in_step(kHere);
  CHECK(replica.shown_at({5, 4, 4}) == kEmpty);
  CHECK(replica.counters().gaps == 0);
}

TEST_CASE_METHOD(ReplicaBench, "a commit in several chunks follows the order of each chunk",
                 "[replica]") {
  load(kHere);
  load(kRight);
  take(world.commit({{other(1), set({1, 1, 1}, 2)},
                     {other(2), box({14, 0, 0}, {18, 2, 2}, 3)},
                     {other(3), set({17, 1, 1}, 4)}}));
  require_in_step(kHere);
  require_in_step(kRight);
  CHECK(replica.confirmed(kHere)->version.seq == 2);
  CHECK(replica.confirmed(kRight)->version.seq == 3);
}

TEST_CASE_METHOD(ReplicaBench, "a commit whose previous list does not fit its edit is refused",
                 "[replica]") {
  load(kHere);
  Commit commit = world.commit(other(1), set({1, 1, 1}, 2));
  commit.edits[0].previous.push_back(0);
  CHECK_FALSE(replica.receive(commit, kNow).has_value());
}

TEST_CASE_METHOD(ReplicaBench, "chunks outside the view are dropped and not accepted",
                 "[replica]") {
  load(kHere);
  replica.set_view({2, {10, 0, 0}, 1, 1});
  CHECK(replica.confirmed(kHere) == nullptr);
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.chunks.size() == 1);
  CHECK(changes.chunks[0].removed);
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK(replica.counters().answers_outside == 1);
  take(world.commit(other(1), set({1, 1, 1}, 2)));
  CHECK(replica.confirmed_count() == 0);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a late answer for a chunk that left the view and came back is ignored",
                 "[replica]") {
  load(kHere);
  const auto late = chunks_of(world.snapshot(kHere.at), 1);
  static_cast<void>(world.commit(other(1), set({1, 1, 1}, 2)));  // not sent: out of view
  replica.set_view({2, {10, 0, 0}, 1, 1});
  replica.set_view({3, {0, 0, 0}, 2, 2});
  static_cast<void>(replica.drain_changes());
  SECTION("a snapshot") { replica.receive(late, kNow); }
  SECTION("missing edits") {
    replica.receive(chunks_of(ChunkEdits{kHere, 0, {3, 1}, {}, {{1, set({1, 1, 1}, 2)}}}, 1), kNow);
  }
  SECTION("one material") { replica.receive(UniformChunks{1, {{kHere, kEmpty, {}}}}, kNow); }
  SECTION("not modified") { replica.receive(ChunksNotModified{1, {{kHere, 0}}}, 2000); }
  SECTION("unavailable") {
    replica.receive(ChunkUnavailable{1, {kHere}, UnavailableReason::damaged});
  }
  CHECK(replica.counters().answers_outside == 1);
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK_FALSE(replica.unavailable(kHere));
  CHECK(replica.current_count() == 0);
  CHECK(replica.take_requests().empty());
  CHECK(replica.drain_changes().chunks.empty());
  replica.receive(chunks_of(world.snapshot(kHere.at), 3), kNow);
  require_in_step(kHere);
  CHECK(replica.counters().answers_outside == 1);
}

TEST_CASE_METHOD(ReplicaBench, "a late answer for a chunk that stayed in the view is taken",
                 "[replica]") {
  replica.set_view({2, {1, 0, 0}, 2, 2});
  replica.set_view({3, {0, 0, 0}, 2, 2});
  replica.receive(chunks_of(world.snapshot(kHere.at), 1), kNow);
  require_in_step(kHere);
}

TEST_CASE_METHOD(ReplicaBench, "one message brings snapshots and missing edits", "[replica]") {
  load(kRight);
  static_cast<void>(world.commit(other(1), set({17, 1, 1}, 2)));
  static_cast<void>(replica.open(parameters()));
  const Chunk& right = world.chunk(kRight.at);
  Chunks chunks{1, {}};
  chunks.chunks.emplace_back(world.snapshot(kHere.at));
  chunks.chunks.emplace_back(
      ChunkEdits{kRight, 0, right.version, right.digest, {{1, set({17, 1, 1}, 2)}}});
  chunks.chunks.emplace_back(world.snapshot({9, 0, 0}));  // out of view
  replica.receive(chunks, kNow);
  require_in_step(kHere);
  require_in_step(kRight);
  CHECK(replica.counters().updates_taken == 1);
  CHECK(replica.confirmed_count() == 2);
  CHECK(replica.current_count() == 2);
}

TEST_CASE_METHOD(ReplicaBench,
                 "a digest check finds a chunk with wrong runs and the next snapshot repairs it",
                 "[replica]") {
  ChunkSnapshot damaged = world.snapshot(kHere.at);
  REQUIRE(fill(damaged.chunk.voxels, 100, 3, 9));  // one run too many; the digest does not follow
  replica.receive(chunks_of(damaged), kNow);
  const Chunk& truth = world.chunk(kHere.at);
  replica.receive(DigestCheck{{{kHere, {3, 99}, truth.digest}}},
                  2000);  // no comparison at another version
  CHECK(replica.counters().digests_checked == 0);
  replica.receive(DigestCheck{{{kHere, truth.version, truth.digest}}}, 2000);
  CHECK(replica.counters().digests_checked == 1);
  CHECK(replica.counters().drifted == 1);
  CHECK(replica.take_requests() == std::vector{kHere});

  // Commits go on meanwhile and overtake the repair.
  const ChunkSnapshot repair = world.snapshot(kHere.at);
  take(world.commit(other(1), set({1, 1, 1}, 2)));
  CHECK(replica.confirmed(kHere)->version == repair.chunk.version);
  replica.receive(chunks_of(repair), kNow);
  require_in_step(kHere);
  replica.receive(
      DigestCheck{{{kHere, world.chunk(kHere.at).version, world.chunk(kHere.at).digest}}}, 3000);
  CHECK(replica.counters().digests_checked == 2);
  CHECK(replica.counters().drifted == 1);
}

TEST_CASE_METHOD(ReplicaBench,
                 "two digest checks find a chunk whose last commit was lost, one does not",
                 "[replica]") {
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  static_cast<void>(world.commit(other(1), set({1, 1, 1}, 2)));  // never arrives
  const auto check_digest = [&] {
    replica.receive(
        DigestCheck{{{kHere, world.chunk(kHere.at).version, world.chunk(kHere.at).digest}}}, 2000);
  };
  check_digest();  // it may have overtaken the commit
  CHECK(replica.take_requests().empty());
  check_digest();
  CHECK(replica.take_requests() == std::vector{kHere});
  CHECK(replica.counters().fell_behind == 1);
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  require_in_step(kHere);
  check_digest();
  CHECK(replica.counters().fell_behind == 1);
  CHECK(replica.counters().drifted == 0);
}

TEST_CASE_METHOD(ReplicaBench, "a chunk that keeps up with its edits is not behind", "[replica]") {
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  for (ClientSequence i = 1; i <= 3; ++i) {
    const auto commit = world.commit(other(i), set({1, 1, 1}, static_cast<Material>(1 + i)));
    replica.receive(
        DigestCheck{{{kHere, world.chunk(kHere.at).version, world.chunk(kHere.at).digest}}}, 2000);
    take(commit);
  }
  CHECK(replica.counters().fell_behind == 0);
  CHECK(replica.take_requests().empty());
}

TEST_CASE_METHOD(ReplicaBench, "a full inbox is dropped and replaced by a newer snapshot",
                 "[replica]") {
  const ChunkSnapshot early = world.snapshot(kHere.at);
  for (ClientSequence i = 1; i <= kInboxEditsMax + 5; ++i) {
    take(world.commit(
        other(i), set({static_cast<std::int32_t>(i % 16), 1, 1}, static_cast<Material>(i % 7))));
  }
  CHECK(replica.counters().buffer_overflows == 1);
  replica.receive(chunks_of(early), kNow);
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  require_in_step(kHere);
  CHECK(replica.awaiting_count() == 0);
}

TEST_CASE_METHOD(ReplicaBench, "an unavailable chunk shows nothing, and edits of it are refused",
                 "[replica]") {
  load(kRight);
  take(world.commit(other(1), set({1, 1, 1}, 2)));  // held back for a snapshot that does not arrive
  replica.receive(ChunkUnavailable{1, {kHere, {0, {9, 0, 0}}}, UnavailableReason::damaged});
  CHECK(replica.unavailable(kHere));
  CHECK_FALSE(replica.unavailable(kRight));
  CHECK(replica.unavailable_count() == 1);  // the other one is out of view
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.unavailable.size() == 1);
  CHECK(changes.unavailable[0].key == kHere);
  CHECK(changes.unavailable[0].reason == UnavailableReason::damaged);
  REQUIRE(changes.chunks.size() == 1);
  CHECK(changes.chunks[0].removed);

  CHECK_FALSE(replica.predict(set({3, 3, 3}, 2), 0, 0).has_value());
  CHECK_FALSE(replica.predict(box({14, 0, 0}, {18, 1, 1}, 2), 0, 0).has_value());  // partly
  CHECK(replica.local_edits().all().empty());
  CHECK(replica.shown_at({17, 0, 0}) == kEmpty);
  predict(set({17, 0, 0}, 2));
  for (ClientSequence i = 2; i < 10; ++i) take(world.commit(other(i), set({2, 1, 1}, 2)));
  CHECK(replica.counters().chunk_edits_buffered == 1);
  CHECK(replica.take_requests().empty());

  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);  // the server can send it now
  CHECK_FALSE(replica.unavailable(kHere));
  CHECK(replica.unavailable_count() == 0);
  require_in_step(kHere);
  predict(set({3, 3, 3}, 2));
}

TEST_CASE_METHOD(ReplicaBench,
                 "commits that arrive while the past is shown are held back in bounds",
                 "[replica]") {
  load(kHere);
  const ChunkSnapshot before = world.snapshot(kHere.at);
  replica.show_moment(PastMoment{0, 0});
  replica.receive(chunks_of(before), kNow);
  for (ClientSequence i = 1; i <= kInboxEditsMax + 1; ++i) {
    take(world.commit(other(i), set({1, 2, 3}, static_cast<Material>(1 + i % 2))));
  }
  CHECK(replica.counters().buffer_overflows == 1);
  CHECK(replica.shown_at({1, 2, 3}) == kEmpty);
  replica.show_moment(std::nullopt);
  replica.receive(chunks_of(before), kNow);  // lacks the commits that were dropped
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(chunks_of(world.snapshot(kHere.at)), kNow);
  require_in_step(kHere);
}
