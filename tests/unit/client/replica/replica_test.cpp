#include "client/replica/replica.hpp"

#include <catch2/catch.hpp>

#include "common/runs/layer_diff.hpp"
#include "tests/support/authority_model.hpp"

using namespace runstone;
using runstone::test::AuthorityModel;

namespace {

constexpr std::int32_t kEdge = 16;
constexpr ClientInstance kInstance = 77;
constexpr AuthorId kMe = 5;
const ChunkKey kHere{0, {0, 0, 0}};
const ChunkKey kRight{0, {1, 0, 0}};
const Arrival kNow{1000, 1100, 1200};

OperationId other(ClientSequence seq) { return {9, 1, seq}; }
OperationId mine(ClientSequence seq) { return {kMe, kInstance, seq}; }
EditDescriptor set(VoxelPos at, Material material) { return {SetVoxel{at}, {}, material}; }
EditDescriptor box(VoxelPos min, VoxelPos max, Material material, Mask mask = {}) {
  return {FillBox{{min, max}}, mask, material};
}

struct Fixture {
  Fixture() {
    replica.set_view({{0, 0, 0}, 2, 2});
    static_cast<void>(replica.open(parameters()));
  }
  SessionParameters parameters(ClientSequence resolved = 0, Sequence durable = 0) const {
    return {kEdge, kMe, kInstance, world.epoch(), durable, world.head(), resolved};
  }
  void load(const ChunkKey& key) {
    replica.receive(world.snapshot(key.at), kNow);
    static_cast<void>(replica.drain_changes());
  }
  void take(const Commit& commit) { REQUIRE(replica.receive(commit, kNow).has_value()); }
  ClientSequence submit(const EditDescriptor& edit) {
    const auto seq = replica.submit(edit, 500, 600);
    REQUIRE(seq.has_value());
    return *seq;
  }
  void require_in_step(const ChunkKey& key) {
    const ChunkPtr held = replica.confirmed(key);
    REQUIRE(held != nullptr);
    CHECK(held->version == world.chunk(key.at).version);
    CHECK(held->digest == world.chunk(key.at).digest);
    CHECK(digest_of(held->voxels) == world.chunk(key.at).digest);
  }
  AuthorityModel world{kEdge, 3};
  Replica replica;
};

}  // namespace

TEST_CASE_METHOD(Fixture,
                 "a commit that follows the snapshot is applied and reported with its layers",
                 "[replica]") {
  load(kHere);
  take(world.commit(other(1), set({3, 4, 5}, 2)));
  require_in_step(kHere);
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.chunks.size() == 1);
  CHECK(changes.chunks[0].key == kHere);
  CHECK(changes.chunks[0].layers.dirty.layer[0].count() == 1);
  CHECK(changes.chunks[0].layers.dirty.layer[0].test(3));
  CHECK(changes.chunks[0].layers.dirty.layer[1].test(4));
  CHECK(changes.chunks[0].layers.dirty.layer[2].test(5));
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

TEST_CASE_METHOD(Fixture, "where nothing is pending the shown runs are the confirmed object itself",
                 "[replica]") {
  load(kHere);
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
  take(world.commit(other(1), set({3, 4, 5}, 2)));
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
  submit(set({1, 1, 1}, 3));
  CHECK(replica.shown(kHere).get() != &replica.confirmed(kHere)->voxels);
  CHECK(material_at(replica.confirmed(kHere)->voxels, {1, 1, 1}) == kEmpty);
}

TEST_CASE_METHOD(Fixture, "an edit at the border changes the mesh of the neighbour", "[replica]") {
  load(kHere);
  load(kRight);
  take(world.commit(other(1), set({15, 4, 5}, 2)));
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.chunks.size() == 2);
  CHECK(changes.chunks[1].key == kRight);
  CHECK_FALSE(changes.chunks[1].layers.dirty.any());
  VisibleLayers beside;
  beside.beyond[static_cast<std::size_t>(Direction::neg_x)] = changes.chunks[0].layers.dirty;
  CHECK(changes.chunks[1].layers == beside);
  CHECK(changes.chunks[0].layers.beyond == VisibleLayers{}.beyond);
  CHECK(changes.edits[0].chunks == std::vector{kHere, kRight});
}

TEST_CASE_METHOD(Fixture, "commits that overtake their snapshot are held back and then applied",
                 "[replica]") {
  const ChunkSnapshot early = world.snapshot(kHere.at);
  take(world.commit(other(1), set({1, 2, 3}, 2)));
  take(world.commit(other(2), set({2, 2, 3}, 4)));
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK(replica.counters().chunk_edits_buffered == 2);
  replica.receive(early, kNow);
  require_in_step(kHere);
  CHECK(replica.counters().chunk_edits_applied == 2);
  CHECK(replica.drain_changes().edits.size() == 2);
}

TEST_CASE_METHOD(Fixture,
                 "a snapshot that contains held back commits replaces them and reports them",
                 "[replica]") {
  take(world.commit(other(1), set({1, 2, 3}, 2)));
  replica.receive(world.snapshot(kHere.at), kNow);
  require_in_step(kHere);
  CHECK(replica.counters().chunk_edits_contained == 1);
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.edits.size() == 1);
  CHECK(changes.edits[0].in_snapshot);
  CHECK(changes.edits[0].chunks == std::vector{kHere});
}

TEST_CASE_METHOD(Fixture, "chunks of one material are taken like snapshots, with their digest",
                 "[replica]") {
  const ChunkKey above{0, {kHere.at.x, kHere.at.y + 1, kHere.at.z}};
  const Version old{1, 4}, newer{1, 9};
  replica.receive(UniformChunks{{{kHere, 3, newer}, {above, 3, {}}}}, kNow);
  for (const ChunkKey& key : {kHere, above}) {
    const ChunkPtr chunk = replica.confirmed(key);
    REQUIRE(chunk != nullptr);
    CHECK(chunk->voxels.is_uniform());
    CHECK(material_at(chunk->voxels, {1, 2, 3}) == 3);
    CHECK(chunk->digest == digest_of(chunk->voxels));
  }
  CHECK(replica.confirmed(kHere)->version == newer);
  replica.receive(UniformChunks{{{kHere, 2, old}}}, kNow);  // stale
  CHECK(material_at(replica.confirmed(kHere)->voxels, {1, 2, 3}) == 3);
  replica.receive(UniformChunks{{{{0, {1'000, 0, 0}}, 2, {}}}}, kNow);  // outside of the view
  CHECK(replica.confirmed({0, {1'000, 0, 0}}) == nullptr);
}

TEST_CASE_METHOD(Fixture, "a stale snapshot never erases a newer edit", "[replica]") {
  const ChunkSnapshot stale = world.snapshot(kHere.at);
  load(kHere);
  take(world.commit(other(1), set({1, 2, 3}, 2)));
  replica.receive(stale, kNow);
  require_in_step(kHere);
  CHECK(replica.counters().snapshots_stale == 1);
  CHECK(replica.shown_at({1, 2, 3}) == Material{2});
}

TEST_CASE_METHOD(Fixture, "a chunk with a gap requests a snapshot until it arrives", "[replica]") {
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

  replica.receive(world.snapshot(kHere.at), kNow);
  require_in_step(kHere);
  CHECK(replica.awaiting_count() == 0);
}

TEST_CASE_METHOD(Fixture, "a snapshot that still leaves a gap is followed by another request",
                 "[replica]") {
  load(kHere);
  static_cast<void>(world.commit(other(1), set({1, 2, 3}, 2)));  // lost
  const ChunkSnapshot between = world.snapshot(kHere.at);
  static_cast<void>(world.commit(other(2), set({1, 3, 3}, 2)));  // lost
  take(world.commit(other(3), set({2, 2, 3}, 4)));
  static_cast<void>(replica.take_requests());
  replica.receive(between, kNow);
  CHECK(replica.awaiting_count() == 1);
  CHECK(replica.take_requests().empty());
  replica.tick(kNow.now_us + kRequestAgainUs);
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(world.snapshot(kHere.at), kNow);
  require_in_step(kHere);
}

TEST_CASE_METHOD(Fixture, "the same commit twice is applied once", "[replica]") {
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

TEST_CASE_METHOD(Fixture, "a commit in several chunks follows the order of each chunk",
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

TEST_CASE_METHOD(Fixture, "a commit whose previous list does not fit its edit is refused",
                 "[replica]") {
  load(kHere);
  Commit commit = world.commit(other(1), set({1, 1, 1}, 2));
  commit.edits[0].previous.push_back(0);
  CHECK_FALSE(replica.receive(commit, kNow).has_value());
}

TEST_CASE_METHOD(Fixture, "chunks outside the view are dropped and not accepted", "[replica]") {
  load(kHere);
  replica.set_view({{10, 0, 0}, 1, 1});
  CHECK(replica.confirmed(kHere) == nullptr);
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.chunks.size() == 1);
  CHECK(changes.chunks[0].removed);
  replica.receive(world.snapshot(kHere.at), kNow);
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK(replica.counters().snapshots_outside == 1);
  take(world.commit(other(1), set({1, 1, 1}, 2)));
  CHECK(replica.confirmed_count() == 0);
}

TEST_CASE_METHOD(Fixture, "a local edit shows at once and is not meshed again when it is confirmed",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = submit(set({3, 4, 5}, 2));
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

TEST_CASE_METHOD(Fixture,
                 "a local edit leaves when the durable watermark reaches it, and not before",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = submit(set({3, 4, 5}, 2));
  take(world.commit(mine(seq), set({3, 4, 5}, 2)));
  CHECK(replica.local_edits().all().size() == 1);
  CHECK(replica.local_edits().pending_count() == 0);
  replica.receive(Durable{world.epoch(), 0});
  CHECK(replica.local_edits().all().size() == 1);
  replica.receive(Durable{world.epoch(), 1});
  CHECK(replica.local_edits().all().empty());
  CHECK(replica.drain_changes().durable == std::vector{seq});
}

TEST_CASE_METHOD(Fixture, "a watermark that overtakes the commit retires the local edit",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = submit(set({3, 4, 5}, 2));
  const Commit commit = world.commit(mine(seq), set({3, 4, 5}, 2));
  replica.receive(Durable{world.epoch(), 1});
  CHECK(replica.local_edits().all().size() == 1);
  take(commit);
  CHECK(replica.local_edits().all().empty());
}

TEST_CASE_METHOD(Fixture, "a reject removes its prediction and no other", "[replica]") {
  load(kHere);
  const ClientSequence first = submit(set({3, 4, 5}, 2));
  submit(box({3, 4, 5}, {5, 5, 6}, 6, {MaskKind::only_empty, kEmpty}));
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
  CHECK(changes.chunks[0].layers.dirty.layer[0].count() == 1);
  CHECK(replica.local_edits().all().size() == 1);
}

TEST_CASE_METHOD(Fixture, "pending edits stay on top of commits that arrive in between",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = submit(set({3, 4, 5}, 2));
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

TEST_CASE_METHOD(Fixture, "a local edit in a chunk that has not arrived shows with its snapshot",
                 "[replica]") {
  submit(set({3, 4, 5}, 2));
  CHECK_FALSE(replica.shown_at({3, 4, 5}).has_value());
  load(kHere);
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(material_at(replica.confirmed(kHere)->voxels, {3, 4, 5}) == kEmpty);
}

TEST_CASE_METHOD(Fixture,
                 "a local edit confirmed by a snapshot that overtook its commit is not shown twice",
                 "[replica]") {
  load(kHere);
  const EditDescriptor fill = box({4, 4, 4}, {6, 5, 5}, 3, {MaskKind::only_empty, kEmpty});
  const ClientSequence seq = submit(fill);
  const Commit own = world.commit(mine(seq), fill);
  const Commit dig = world.commit(other(1), set({5, 4, 4}, kEmpty));
  replica.receive(world.snapshot(kHere.at), kNow);  // contains both
  take(own);
  CHECK(replica.shown_at({5, 4, 4}) == kEmpty);
  take(dig);
  require_in_step(kHere);
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
}

TEST_CASE_METHOD(
    Fixture, "after a restart chunks that may be lost are dropped and local edits offered again",
    "[replica]") {
  load(kHere);
  load(kRight);
  std::vector<std::pair<OperationId, EditDescriptor>> kept;
  const ClientSequence first = submit(set({3, 4, 5}, 2));
  kept.emplace_back(mine(first), set({3, 4, 5}, 2));
  take(world.commit(mine(first), set({3, 4, 5}, 2)));  // sequence 1, durable
  const ClientSequence second = submit(set({20, 1, 1}, 3));
  take(world.commit(mine(second), set({20, 1, 1}, 3)));     // sequence 2, lost in the crash
  const ClientSequence third = submit(set({21, 1, 1}, 4));  // never answered
  replica.receive(Durable{world.epoch(), 1});

  world.restart(kept);
  const auto offers = replica.open(parameters(first, 1));
  CHECK(offers == std::vector{second, third});
  CHECK(replica.confirmed(kHere) != nullptr);
  CHECK(replica.confirmed(kRight) == nullptr);
  CHECK(replica.counters().dropped_by_epoch == 1);
  CHECK(replica.shown_at({20, 1, 1}) == Material{3});  // shown until the snapshot
  replica.receive(world.snapshot(kRight.at), kNow);
  CHECK(replica.shown_at({20, 1, 1}) == Material{3});  // predicted again
  CHECK(material_at(replica.confirmed(kRight)->voxels, {4, 1, 1}) == kEmpty);

  take(world.commit(mine(second), set({20, 1, 1}, 3)));
  take(world.commit(mine(third), set({21, 1, 1}, 4)));
  require_in_step(kRight);
  replica.receive(Durable{world.epoch(), world.head()});
  CHECK(replica.local_edits().all().empty());
}

TEST_CASE_METHOD(Fixture,
                 "after a reconnection an edit that the server has resolved is not offered again",
                 "[replica]") {
  load(kHere);
  const EditDescriptor fill = box({4, 4, 4}, {6, 5, 5}, 3, {MaskKind::only_empty, kEmpty});
  const ClientSequence seq = submit(fill);
  static_cast<void>(world.commit(mine(seq), fill));  // applied, but the commit did not arrive
  static_cast<void>(world.commit(other(1), set({5, 4, 4}, kEmpty)));
  CHECK(replica.open(parameters(seq)) == std::vector{seq});  // to get the answer
  CHECK(replica.local_edits().counters().offered_again == 0);
  CHECK(replica.shown_at({5, 4, 4}) == Material{3});  // until the snapshot
  CHECK(replica.local_edits().all().size() == 1);     // and it is kept until durable
  replica.receive(Reject{seq, RejectReason::already_resolved, "", world.head()}, 2000);
  CHECK(replica.drain_changes().rejects.empty());
  replica.receive(world.snapshot(kHere.at), kNow);
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

TEST_CASE_METHOD(Fixture,
                 "a prediction rejected while disconnected is removed by an equal snapshot",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = submit(set({3, 4, 5}, 2));
  CHECK(replica.open(parameters(seq)) == std::vector{seq});
  replica.receive(world.snapshot(kHere.at), kNow);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
  replica.receive(Reject{seq, RejectReason::rate_limited, "", 0},
                  2000);  // the late answer
  CHECK(replica.drain_changes().rejects.size() == 1);
  CHECK(replica.local_edits().all().empty());
}

TEST_CASE_METHOD(Fixture, "an edit that was resolved unseen makes its chunk be requested",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = submit(set({3, 4, 5}, 2));
  static_cast<void>(world.commit(mine(seq), set({3, 4, 5}, 2)));
  replica.receive(Reject{seq, RejectReason::already_resolved, ""}, 2000);
  CHECK(replica.take_requests() == std::vector{kHere});
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(replica.drain_changes().rejects.empty());
  replica.receive(world.snapshot(kHere.at), kNow);
  require_in_step(kHere);
  CHECK(replica.shown_at({3, 4, 5}) == Material{2});
  CHECK(replica.shown(kHere).get() == &replica.confirmed(kHere)->voxels);
}

TEST_CASE_METHOD(Fixture,
                 "a digest check finds a chunk with wrong runs and the next snapshot repairs it",
                 "[replica]") {
  ChunkSnapshot damaged = world.snapshot(kHere.at);
  REQUIRE(fill(damaged.chunk.voxels, 100, 3, 9));  // one run too many; the digest does not follow
  replica.receive(damaged, kNow);
  const Chunk& truth = world.chunk(kHere.at);
  replica.receive(DigestCheck{{{kHere, {3, 99}, truth.digest}}},
                  2000);  // no comparison at another version
  CHECK(replica.counters().audited == 0);
  replica.receive(DigestCheck{{{kHere, truth.version, truth.digest}}}, 2000);
  CHECK(replica.counters().audited == 1);
  CHECK(replica.counters().drifted == 1);
  CHECK(replica.take_requests() == std::vector{kHere});

  // Commits go on meanwhile and overtake the repair.
  const ChunkSnapshot repair = world.snapshot(kHere.at);
  take(world.commit(other(1), set({1, 1, 1}, 2)));
  CHECK(replica.confirmed(kHere)->version == repair.chunk.version);
  replica.receive(repair, kNow);
  require_in_step(kHere);
  replica.receive(
      DigestCheck{{{kHere, world.chunk(kHere.at).version, world.chunk(kHere.at).digest}}}, 3000);
  CHECK(replica.counters().audited == 2);
  CHECK(replica.counters().drifted == 1);
}

TEST_CASE_METHOD(Fixture, "two digest checks find a chunk whose last commit was lost, one does not",
                 "[replica]") {
  replica.receive(world.snapshot(kHere.at), kNow);
  static_cast<void>(world.commit(other(1), set({1, 1, 1}, 2)));  // never arrives
  const auto audit = [&] {
    replica.receive(
        DigestCheck{{{kHere, world.chunk(kHere.at).version, world.chunk(kHere.at).digest}}}, 2000);
  };
  audit();  // it may have overtaken the commit
  CHECK(replica.take_requests().empty());
  audit();
  CHECK(replica.take_requests() == std::vector{kHere});
  CHECK(replica.counters().fell_behind == 1);
  replica.receive(world.snapshot(kHere.at), kNow);
  require_in_step(kHere);
  audit();
  CHECK(replica.counters().fell_behind == 1);
  CHECK(replica.counters().drifted == 0);
}

TEST_CASE_METHOD(Fixture, "a chunk that keeps up with its edits is not behind", "[replica]") {
  replica.receive(world.snapshot(kHere.at), kNow);
  for (ClientSequence i = 1; i <= 3; ++i) {
    const auto commit = world.commit(other(i), set({1, 1, 1}, static_cast<Material>(1 + i)));
    replica.receive(
        DigestCheck{{{kHere, world.chunk(kHere.at).version, world.chunk(kHere.at).digest}}}, 2000);
    take(commit);
  }
  CHECK(replica.counters().fell_behind == 0);
  CHECK(replica.take_requests().empty());
}

TEST_CASE_METHOD(Fixture, "a full inbox is dropped and replaced by a newer snapshot", "[replica]") {
  const ChunkSnapshot early = world.snapshot(kHere.at);
  for (ClientSequence i = 1; i <= kInboxEditsMax + 5; ++i) {
    take(world.commit(
        other(i), set({static_cast<std::int32_t>(i % 16), 1, 1}, static_cast<Material>(i % 7))));
  }
  CHECK(replica.counters().buffer_overflows == 1);
  replica.receive(early, kNow);
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(world.snapshot(kHere.at), kNow);
  require_in_step(kHere);
  CHECK(replica.awaiting_count() == 0);
}

TEST_CASE("local edits beyond the bound are refused before anything is shown", "[replica]") {
  Replica replica;
  CHECK_FALSE(replica.submit(set({0, 0, 0}, 1), 0, 0).has_value());  // no world yet
  static_cast<void>(replica.open({kEdge, kMe, kInstance, 1, 0, 0, 0}));
  CHECK_FALSE(replica.submit(box({0, 0, 0}, {0, 1, 1}, 1), 0, 0).has_value());
  for (std::size_t i = 0; i < kLocalEditsMax; ++i)
    REQUIRE(replica.submit(set({0, 0, 0}, 1), 0, 0).has_value());
  CHECK_FALSE(replica.submit(set({0, 0, 0}, 1), 0, 0).has_value());
  CHECK(replica.local_edits().all().size() == kLocalEditsMax);
}

TEST_CASE_METHOD(
    Fixture,
    "a stale snapshot after a reconnection removes predictions that were answered meanwhile",
    "[replica]") {
  load(kHere);
  const ClientSequence seq = submit(set({3, 4, 5}, 2));
  static_cast<void>(replica.open(parameters(seq)));  // rejected, but the answer was lost
  const ChunkSnapshot overtaken = world.snapshot(kHere.at);
  take(world.commit(other(1), set({1, 1, 1}, 2)));
  replica.receive(overtaken, kNow);
  CHECK(replica.counters().snapshots_stale == 1);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
}

TEST_CASE_METHOD(Fixture,
                 "a prediction whose edit is gone does not survive a restart that lost the reject",
                 "[replica]") {
  load(kHere);
  const ClientSequence seq = submit(set({3, 4, 5}, 2));
  static_cast<void>(replica.open(parameters(seq)));
  replica.receive(Reject{seq, RejectReason::already_resolved, "", 0},
                  2000);  // the server has lost the outcome
  CHECK(replica.local_edits().all().empty());
  world.restart({});
  CHECK(replica.open(parameters(0)).empty());
  replica.receive(world.snapshot(kHere.at), kNow);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
}

TEST_CASE_METHOD(Fixture,
                 "a log that grew past its old end with other edits makes old versions untrusted",
                 "[replica]") {
  load(kHere);
  take(world.commit(other(1), set({3, 4, 5}, 2)));  // sequence 1, seen, lost in the crash
  world.restart({});
  static_cast<void>(
      world.commit(other(2), set({30, 4, 5}, 2)));  // sequence 1 again, elsewhere, and durable
  static_cast<void>(replica.open(parameters(0, 1)));
  CHECK(replica.confirmed(kHere) == nullptr);
  replica.receive(world.snapshot(kHere.at), kNow);
  CHECK(replica.shown_at({3, 4, 5}) == kEmpty);
  require_in_step(kHere);
}

TEST_CASE_METHOD(Fixture,
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
  replica.receive(overtaken, kNow);
  require_in_step(kHere);
  CHECK(replica.current_count() == 1);
  CHECK(replica.counters().gaps == 0);
}

TEST_CASE_METHOD(Fixture, "a gap that the first snapshot after a reconnection leaves is requested",
                 "[replica]") {
  load(kHere);
  CHECK(replica.open(parameters()).empty());
  const ChunkSnapshot equal = world.snapshot(kHere.at);
  static_cast<void>(world.commit(other(1), set({1, 1, 1}, 2)));  // not sent to this client
  take(world.commit(other(2), set({2, 1, 1}, 2)));
  CHECK(replica.take_requests().empty());
  replica.receive(equal, kNow);
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(world.snapshot(kHere.at), kNow);
  require_in_step(kHere);
}

TEST_CASE_METHOD(Fixture, "an unavailable chunk shows nothing, and edits of it are refused",
                 "[replica]") {
  load(kRight);
  take(world.commit(other(1), set({1, 1, 1}, 2)));  // held back for a snapshot that does not arrive
  replica.receive(ChunkUnavailable{{kHere, {0, {9, 0, 0}}}, UnavailableReason::damaged});
  CHECK(replica.unavailable(kHere));
  CHECK_FALSE(replica.unavailable(kRight));
  CHECK(replica.unavailable_count() == 1);  // the other one is out of view
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.unavailable.size() == 1);
  CHECK(changes.unavailable[0].key == kHere);
  CHECK(changes.unavailable[0].reason == UnavailableReason::damaged);
  REQUIRE(changes.chunks.size() == 1);
  CHECK(changes.chunks[0].removed);

  CHECK_FALSE(replica.submit(set({3, 3, 3}, 2), 0, 0).has_value());
  CHECK_FALSE(replica.submit(box({14, 0, 0}, {18, 1, 1}, 2), 0, 0).has_value());  // partly
  CHECK(replica.local_edits().all().empty());
  CHECK(replica.shown_at({17, 0, 0}) == kEmpty);
  submit(set({17, 0, 0}, 2));
  for (ClientSequence i = 2; i < 10; ++i) take(world.commit(other(i), set({2, 1, 1}, 2)));
  CHECK(replica.counters().chunk_edits_buffered == 1);
  CHECK(replica.take_requests().empty());

  replica.receive(world.snapshot(kHere.at), kNow);  // the server can send it now
  CHECK_FALSE(replica.unavailable(kHere));
  CHECK(replica.unavailable_count() == 0);
  require_in_step(kHere);
  submit(set({3, 3, 3}, 2));
}

TEST_CASE_METHOD(Fixture, "a chunk of an earlier connection that became unavailable is hidden",
                 "[replica]") {
  load(kHere);
  load(kRight);
  CHECK(replica.open(parameters()).empty());
  replica.receive(ChunkUnavailable{{kHere}, UnavailableReason::damaged});
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK(replica.shown(kHere) == nullptr);
  CHECK(replica.confirmed_count() == 1);
  const ReplicaChanges changes = replica.drain_changes();
  REQUIRE(changes.chunks.size() == 2);
  CHECK(changes.chunks[0].removed);
  VisibleLayers beside;
  beside.beyond[static_cast<std::size_t>(Direction::neg_x)] = all_layers(Extent::cube(kEdge));
  CHECK(changes.chunks[1].layers == beside);
  static_cast<void>(replica.open(parameters()));  // it may have been repaired
  CHECK(replica.unavailable_count() == 0);
  replica.receive(ChunkUnavailable{{kHere}, UnavailableReason::damaged});
  replica.set_view({{3, 0, 0}, 2, 2});
  CHECK(replica.unavailable_count() == 0);
}

TEST_CASE_METHOD(Fixture, "an edit beyond the world's heights is refused before it is shown",
                 "[replica]") {
  SessionParameters low = parameters();
  low.heights = {-16, 8};
  static_cast<void>(replica.open(low));
  load(kHere);
  CHECK(replica.submit(set({1, 7, 1}, 2), 0, 0).has_value());
  CHECK_FALSE(replica.submit(set({1, 8, 1}, 2), 0, 0).has_value());
  CHECK_FALSE(replica.submit({FillSphere{{4, 4, 4}, 4}, {}, 2}, 0, 0).has_value());
  CHECK(replica.shown_at({4, 4, 4}) == kEmpty);
  CHECK(replica.local_edits().all().size() == 1);
}

TEST_CASE_METHOD(Fixture, "an edit larger than the server allows is refused before it is shown",
                 "[replica]") {
  SessionParameters small = parameters();
  small.edit_volume_max = 8;
  static_cast<void>(replica.open(small));
  load(kHere);
  CHECK(replica.submit({FillBox{{{1, 1, 1}, {3, 3, 3}}}, {}, 2}, 0, 0).has_value());
  const auto refused = replica.submit({FillBox{{{4, 1, 1}, {7, 4, 2}}}, {}, 2}, 0, 0);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(replica.shown_at({4, 1, 1}) == kEmpty);
  CHECK(replica.local_edits().all().size() == 1);
}

TEST_CASE_METHOD(Fixture, "after a restored backup no edited chunk is trusted", "[replica]") {
  load(kRight);
  take(world.commit(other(1), set({3, 4, 5}, 2)));
  replica.receive(world.snapshot(kHere.at), kNow);
  const ClientSequence seq = submit(set({20, 1, 1}, 3));
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
  CHECK(replica.open(restored).empty());  // the local edit was durable and is not offered again
  CHECK(replica.confirmed(kHere) == nullptr);
  CHECK(replica.confirmed(kRight) == nullptr);
}

TEST_CASE_METHOD(Fixture, "an edit change names the earlier edit that it refers to", "[replica]") {
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

TEST_CASE_METHOD(Fixture, "commits that arrive while the past is shown are held back in bounds",
                 "[replica]") {
  load(kHere);
  const ChunkSnapshot before = world.snapshot(kHere.at);
  replica.show_moment(PastMoment{0, 0});
  replica.receive(before, kNow);
  for (ClientSequence i = 1; i <= kInboxEditsMax + 1; ++i) {
    take(world.commit(other(i), set({1, 2, 3}, static_cast<Material>(1 + i % 2))));
  }
  CHECK(replica.counters().buffer_overflows == 1);
  CHECK(replica.shown_at({1, 2, 3}) == kEmpty);
  replica.show_moment(std::nullopt);
  replica.receive(before, kNow);  // lacks the commits that were dropped
  CHECK(replica.take_requests() == std::vector{kHere});
  replica.receive(world.snapshot(kHere.at), kNow);
  require_in_step(kHere);
}

TEST_CASE_METHOD(Fixture, "a claim that is answered with an unavailable chunk waits no longer",
                 "[replica]") {
  load(kHere);
  static_cast<void>(replica.open(parameters()));
  CHECK(replica.take_claims().size() == 1);
  replica.receive(ChunkUnavailable{{kHere}, UnavailableReason::damaged});
  CHECK(replica.take_claims().empty());
  CHECK(replica.missing().size() == 64);  // of 65 chunks in view
}
