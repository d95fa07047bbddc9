#include "server/world/order/authority.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/codec/messages.hpp"
#include "tests/support/runs/dense_chunk.hpp"

namespace runstone {
namespace {

EditLimits limits() {
  EditLimits l;
  l.chunk_edge = 16;
  l.material_count = 8;
  l.volume_max = 50'000;
  return l;
}

EditOffer offer(ClientSequence seq, const EditShape& shape, Material material,
                AuthorId author = 1) {
  return {{author, 77, seq}, Cause::player, 0, {shape, {}, material}};
}

EditShape box(std::int32_t x0, std::int32_t x1) { return FillBox{{{x0, 0, 0}, {x1, 4, 4}}}; }

Chunk base_chunk(Material material = kEmpty) {
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(16), material);
  chunk.digest = digest_of(chunk.voxels);
  return chunk;
}

void load(Authority& authority, const ChunkKey& key, const Chunk& chunk) {
  REQUIRE(authority.chunks().begin_load(key));
  REQUIRE(authority.chunks().loaded(key, chunk).has_value());
}

/// Queues an edit. Returns why it was rejected, or nullopt if it was queued.
std::optional<RejectReason> why_rejected(Authority& authority, const EditOffer& offer) {
  const auto queued = authority.enqueue(offer);
  return queued ? std::nullopt : std::optional(queued.error());
}

constexpr ChunkKey kOrigin{0, {0, 0, 0}};
constexpr ChunkKey kEast{0, {1, 0, 0}};
constexpr Clocks kNow{1000, 5000};

TEST_CASE("edits of one action name its first edit in commit and record", "[world][undo]") {
  Authority authority(limits(), {3, 40, 0});
  const auto enqueue = [&](ClientSequence seq, ClientSequence action) {
    EditOffer o = offer(seq, box(0, 4), 1);
    o.action = action;
    return authority.enqueue(o);
  };
  CHECK(enqueue(1, 1).has_value());
  CHECK(authority.enqueue(offer(1, box(0, 4), 2, 2)).has_value());
  CHECK(enqueue(2, 1).has_value());
  auto batch = authority.commit(kNow);
  REQUIRE(batch.has_value());
  REQUIRE(batch->records.size() == 3);
  Sequence first = 0, second = 0;
  for (const EditRecord& record : batch->records) {
    if (record.op.author == 1) (record.op.seq == 1 ? first : second) = record.version.seq;
    CHECK(record.subject == (record.op == OperationId{1, 77, 2} ? first : 0));
  }
  CHECK(enqueue(3, 1).has_value());  // in the next commit
  batch = authority.commit(kNow);
  REQUIRE(batch.has_value());
  CHECK(batch->records[0].subject == first);
  CHECK(batch->commit.edits[0].subject == first);
  CHECK(second > first);
}

TEST_CASE("queued edits get consecutive sequences, and the previous sequence of each touched chunk",
          "[world]") {
  Authority authority(limits(), {3, 40, 0});
  load(authority, kOrigin, base_chunk());
  CHECK(authority.enqueue(offer(1, box(0, 4), 1)).has_value());
  CHECK(authority.enqueue(offer(2, box(10, 20), 2)).has_value());  // two chunks
  CHECK(authority.enqueue(offer(3, box(16, 18), 3)).has_value());  // east only
  const auto batch = authority.commit(kNow);
  REQUIRE(batch.has_value());
  CHECK(batch->commit.epoch == 3);
  CHECK(batch->commit.edits.at(0).seq == 41);
  REQUIRE(batch->commit.edits.size() == 3);
  CHECK(batch->commit.edits[0].previous == std::vector<Sequence>{0});
  CHECK(batch->commit.edits[1].previous == std::vector<Sequence>{41, 0});
  CHECK(batch->commit.edits[2].previous == std::vector<Sequence>{42});
  CHECK(batch->commit.edits[1].ordered_us == 1000);
  CHECK(batch->all_touched == std::vector<ChunkKey>{kOrigin, kEast});
  CHECK(authority.head() == 43);
  CHECK_FALSE(authority.commit(kNow).has_value());

  const ChunkPtr chunk = authority.chunks().find(kOrigin);
  CHECK(chunk->version == Version{3, 42});
  CHECK(material_at(chunk->voxels, {0, 0, 0}) == 1);
  CHECK(material_at(chunk->voxels, {12, 0, 0}) == 2);
  CHECK(chunk->digest == digest_of(chunk->voxels));
  CHECK(authority.chunks().find(kEast) == nullptr);
  CHECK(authority.chunks().version(kEast) == Version{3, 43});
}

TEST_CASE("records have version, operation and a time that never decreases", "[world]") {
  Authority authority(limits(), {2, 0, 0, 9000});
  (void)authority.enqueue(offer(1, SetVoxel{{1, 1, 1}}, 1));
  const auto first = authority.commit({0, 5000});
  CHECK(first->records[0].time_us == 9000);  // the wall clock was behind the log
  CHECK(first->records[0].version == Version{2, 1});
  CHECK(first->records[0].op == OperationId{1, 77, 1});
  (void)authority.enqueue(offer(2, SetVoxel{{1, 1, 1}}, 2));
  CHECK(authority.commit({5000, 10'000})->records[0].time_us == 10'000);
}

TEST_CASE("an edit that changes no voxel still moves the version", "[world]") {
  Authority authority(limits(), {1, 0, 0});
  load(authority, kOrigin, base_chunk(5));
  const ChunkPtr before = authority.chunks().find(kOrigin);
  (void)authority.enqueue(offer(1, box(0, 4), 5));
  (void)authority.commit(kNow);
  const ChunkPtr after = authority.chunks().find(kOrigin);
  CHECK(after->voxels == before->voxels);
  CHECK(after->version == Version{1, 1});
  CHECK(before->version == Version{});  // the chunk that was published before is unchanged
}

TEST_CASE("an operation is resolved once, by a commit or by a final rejection", "[world]") {
  Authority authority(limits(), {1, 0, 0});
  authority.resolved().raise({1, 77, 10});  // from the store
  CHECK(why_rejected(authority, offer(10, box(0, 1), 1)) == RejectReason::already_resolved);
  CHECK(why_rejected(authority, offer(9, box(0, 1), 1)) == RejectReason::already_resolved);
  CHECK(authority.enqueue(offer(20, box(0, 1), 1)).has_value());  // gaps are allowed
  CHECK(why_rejected(authority, offer(20, box(0, 1), 1)) ==
        RejectReason::already_resolved);  // not yet committed
  CHECK(why_rejected(authority, offer(15, box(0, 1), 1)) == RejectReason::already_resolved);
  CHECK(why_rejected(authority, offer(21, box(0, 1), 99)) == RejectReason::unknown_material);
  CHECK(why_rejected(authority, offer(21, box(0, 1), 1)) ==
        RejectReason::unknown_material);  // the same reason as before
  // Another instance of the same author, and another author, have their own watermarks.
  EditOffer other = offer(1, box(0, 1), 1);
  other.op.instance = 78;
  CHECK(authority.enqueue(other).has_value());
  CHECK(authority.enqueue(offer(1, box(0, 1), 1, 2)).has_value());
  CHECK(authority.commit(kNow)->records.size() == 3);
}

TEST_CASE("every rejection is final, also busy, and is repeated when the edit is offered again",
          "[world]") {
  Authority authority(limits(), {1, 0, 0});
  authority.reject(offer(1, box(0, 1), 1).op, RejectReason::busy);
  CHECK(authority.resolved().of(1, 77) == 1);
  CHECK(authority.queue().size() == 0);
  CHECK(why_rejected(authority, offer(1, box(0, 1), 1)) == RejectReason::busy);
  CHECK(authority.enqueue(offer(2, box(0, 1), 1)).has_value());
  CHECK(why_rejected(authority, offer(1, box(0, 1), 1)) == RejectReason::busy);
  CHECK(why_rejected(authority, offer(2, box(0, 1), 1)) == RejectReason::already_resolved);
  CHECK(why_rejected(authority, offer(3, box(0, 1), 99)) == RejectReason::unknown_material);
}

TEST_CASE("the oldest rejections of an instance are dropped beyond the bound", "[world]") {
  OperationWatermarks marks;
  for (ClientSequence seq = 1; seq <= OperationWatermarks::kRejectionsMax + 1; ++seq) {
    marks.reject({1, 7, seq}, RejectReason::busy);
  }
  CHECK(marks.answer_to({1, 7, 1}) == RejectReason::already_resolved);
  CHECK(marks.answer_to({1, 7, 2}) == RejectReason::busy);
  CHECK(marks.answer_to({1, 8, 2}) == RejectReason::already_resolved);
}

TEST_CASE(
    "edits of the server may be larger and higher than those of players, within the commit's limit",
    "[world]") {
  EditLimits narrow = limits();
  narrow.heights = {0, 8};
  Authority authority(narrow, {1, 0, 0});
  EditOffer large = offer(1, FillBox{{{0, -4, 0}, {64, 60, 64}}}, 2);
  CHECK(why_rejected(authority, large) == RejectReason::outside_world);
  large.op.seq = 2;
  large.cause = Cause::rollback;
  CHECK(authority.enqueue(large).has_value());
  EditOffer endless = offer(3, FillBox{{{0, 0, 0}, {4000, 4000, 4000}}}, 2);
  endless.cause = Cause::undo;
  CHECK(why_rejected(authority, endless) == RejectReason::too_large);
  EditOffer unknown = offer(4, box(0, 4), 8);
  unknown.cause = Cause::redo;
  CHECK(why_rejected(authority, unknown) == RejectReason::unknown_material);
}

TEST_CASE("a commit ends before its message is too long, whatever the size of the edits",
          "[world]") {
  EditLimits l = limits();
  l.chunk_edge = 128;
  l.volume_max = 100'000;
  Authority authority(l, {1, 0, 0});
  std::vector<Run> runs;  // a byte each
  for (std::uint32_t i = 1; i <= 48'000; ++i) runs.push_back({i, static_cast<Material>(1 + i % 2)});
  const Extent extent{128, 125, 3};
  RunChunk cells{extent, AxisOrder::xyz, RunList(extent.volume())};
  for (const Run& run : runs) cells.runs.push_back(run);
  const auto clipboard = *Clipboard::of({1, 2}, cells);
  CHECK(clipboard->byte_size() > 48'000);
  for (ClientSequence seq = 1; seq <= 40; ++seq) {
    CHECK(authority.enqueue(offer(seq, Paste{{0, 0, 0}, clipboard, {}}, kEmpty)).has_value());
  }
  std::size_t edits = 0, commits = 0;
  while (const auto batch = authority.commit(kNow)) {
    const EncodedMessage message = encode_message(batch->commit);
    CHECK(message.bytes->size() <= kServerEditBytesMax);
    edits += batch->records.size();
    ++commits;
  }
  CHECK(edits == 40);
  CHECK(commits == 40);  // such a paste is alone in its commit

  for (ClientSequence seq = 41; seq <= 40 + 500; ++seq) {
    CHECK(authority.enqueue(offer(seq, SetVoxel{{1, 1, 1}}, 1)).has_value());
  }
  CHECK(authority.commit(kNow)->records.size() == 500);
}

TEST_CASE("the subject of an edit is in its commit and its record", "[world]") {
  Authority authority(limits(), {2, 30, 0});
  EditOffer undo = offer(1, SetVoxel{{1, 1, 1}}, 1);
  undo.cause = Cause::undo;
  undo.subject = 17;
  CHECK(authority.enqueue(undo).has_value());
  CHECK(authority.enqueue(offer(2, SetVoxel{{1, 1, 1}}, 2)).has_value());
  const auto batch = authority.commit(kNow);
  CHECK(batch->commit.edits[0].subject == 17);
  CHECK(batch->records[0].subject == 17);
  CHECK(batch->commit.edits[1].subject == 0);
  CHECK(batch->records[1].subject == 0);
}

TEST_CASE("a chunk that is not in memory keeps its stack and applies it when loaded", "[world]") {
  Authority authority(limits(), {1, 0, 0});
  Authority resident(limits(), {1, 0, 0});
  load(resident, kOrigin, base_chunk(3));
  SplitMix64 rng(Catch::rngSeed());
  for (ClientSequence seq = 1; seq <= 60; ++seq) {
    const VoxelPos at{rng.between(0, 15), rng.between(0, 15), rng.between(0, 15)};
    EditShape shape = FillSphere{at, static_cast<std::uint16_t>(rng.below(5))};
    if (seq % 3 == 0) shape = FillStroke{{at, {15 - at.x, at.y, at.z}, {at.x, 15 - at.y, 20}}, 1};
    const EditOffer edit = offer(seq, shape, static_cast<Material>(rng.below(8)));
    (void)authority.enqueue(edit);
    (void)resident.enqueue(edit);
    if (rng.below(3) == 0) {
      (void)authority.commit(kNow);
      (void)resident.commit(kNow);
    }
    if (seq == 30)
      REQUIRE(
          authority.chunks().begin_load(kOrigin));  // edits are ordered while the chunk is loading
  }
  (void)authority.commit(kNow);
  (void)resident.commit(kNow);
  CHECK(authority.chunks().stack_size(kOrigin) > 0);
  REQUIRE(authority.chunks().loaded(kOrigin, base_chunk(3)).has_value());
  CHECK(authority.chunks().stack_size(kOrigin) == 0);
  const ChunkPtr late = authority.chunks().find(kOrigin);
  const ChunkPtr early = resident.chunks().find(kOrigin);
  CHECK(late->version == early->version);
  CHECK(late->digest == early->digest);
  CHECK(test::DenseChunk::of(late->voxels) == test::DenseChunk::of(early->voxels));
}

TEST_CASE("times fall at a record that corrects the time, and never elsewhere", "[world][clock]") {
  constexpr TimeUs kAhead = 1'000'000'000'000;
  Authority authority(limits(), {1, 7, 1, kNow.utc_us + kAhead});
  (void)authority.enqueue(offer(1, box(0, 4), 1));
  std::vector<EditRecord> records = authority.commit(kNow)->records;
  const EditOffer correction{{0, 9, 1}, Cause::rights, 0, rights_edit(CorrectTime{-kAhead, 9}), 0};
  CHECK(authority.timed_from() == 8);
  REQUIRE(authority.enqueue(correction).has_value());
  (void)authority.enqueue(offer(2, box(0, 4), 1));
  while (const auto batch = authority.commit(kNow))
    records.insert(records.end(), batch->records.begin(), batch->records.end());
  REQUIRE(records.size() == 3);
  CHECK(records[0].time_us == kNow.utc_us + kAhead);
  bool is_corrected = false;
  for (const EditRecord& record : records) {
    is_corrected = is_corrected || corrects_time(record);
    CHECK(record.time_us == (is_corrected ? kNow.utc_us : kNow.utc_us + kAhead));
  }
  CHECK(is_corrected);
  // A server that follows has the same times.
  Authority follower(limits(), {1, 7, 1, kNow.utc_us + kAhead});
  (void)follower.commit(kNow);
  std::vector<LogPartRecord> parts;
  for (const EditRecord& record : records) parts.push_back({record, 0});
  (void)follower.apply_ordered(parts, kNow);
  CHECK(follower.log_clock().time() == kNow.utc_us);
  for (const EditRecord& record : records) {
    if (!corrects_time(record)) continue;
    CHECK(authority.timed_from() == record.version.seq);
    CHECK(follower.timed_from() == record.version.seq);
  }
}

TEST_CASE("recovery puts records back on the stacks and skips those that a snapshot contains",
          "[world]") {
  // First run: five edits; the snapshot was taken after the second.
  Authority first(limits(), {1, 0, 0});
  load(first, kOrigin, base_chunk());
  std::vector<EditRecord> log;
  ChunkPtr snapshot;
  for (ClientSequence seq = 1; seq <= 5; ++seq) {
    const auto x = static_cast<std::int32_t>(seq);
    (void)first.enqueue(offer(seq, box(x, x + 3), static_cast<Material>(seq)));
    const auto batch = first.commit(kNow);
    log.insert(log.end(), batch->records.begin(), batch->records.end());
    if (seq == 2) snapshot = first.chunks().find(kOrigin);
  }
  // Second run: the checkpoint lags behind the snapshot, as after a crash between two of a round's
  // slices.
  Authority second(limits(), {2, 5, kNow.utc_us});
  second.chunks().set_saved(kOrigin, snapshot->version);
  for (const EditRecord& record : log) second.replay_onto_stack(record);
  CHECK(second.head() == 5);
  CHECK(second.chunks().version(kOrigin) == Version{1, 5});
  CHECK(second.chunks().stack_size(kOrigin) == 3);
  load(second, kOrigin, *snapshot);
  CHECK(second.chunks().find(kOrigin)->voxels == first.chunks().find(kOrigin)->voxels);
  CHECK(second.chunks().find(kOrigin)->version == Version{1, 5});
  (void)second.enqueue(offer(6, box(0, 1), 1));
  const auto batch = second.commit(kNow);
  CHECK(batch->commit.edits.at(0).seq == 6);
  CHECK(batch->commit.edits[0].previous == std::vector<Sequence>{5});
  CHECK(second.chunks().find(kOrigin)->version == Version{2, 6});
}

TEST_CASE(
    "a loaded chunk that does not fit the log is quarantined, and its edits go on in the log alone",
    "[world]") {
  Authority authority(limits(), {2, 9, 0});
  authority.chunks().set_saved(kOrigin, {1, 7});
  SECTION("older than its snapshot") {
    REQUIRE(authority.chunks().begin_load(kOrigin));
    CHECK_FALSE(authority.chunks().loaded(kOrigin, base_chunk()).has_value());
  }
  SECTION("newer than the order") {
    Chunk newer = base_chunk();
    newer.version = {1, 8};
    REQUIRE(authority.chunks().begin_load(kOrigin));
    CHECK_FALSE(authority.chunks().loaded(kOrigin, newer).has_value());
  }
  SECTION("of another size") {
    Chunk other;
    other.voxels = uniform_chunk(Extent::cube(32), 1);
    other.version = {1, 7};
    REQUIRE(authority.chunks().begin_load(kOrigin));
    CHECK_FALSE(authority.chunks().loaded(kOrigin, other).has_value());
  }
  CHECK(authority.chunks().residency(kOrigin) == Residency::quarantined);
  CHECK_FALSE(authority.chunks().begin_load(kOrigin));
  CHECK_FALSE(authority.chunks().first_quarantined_edit().has_value());
  (void)authority.enqueue(offer(1, box(0, 4), 1));
  (void)authority.enqueue(offer(2, box(0, 4), 1));
  const auto batch = authority.commit(kNow);
  CHECK(batch->commit.edits[0].previous == std::vector<Sequence>{7});
  CHECK(batch->commit.edits[1].previous == std::vector<Sequence>{10});
  CHECK(authority.chunks().find(kOrigin) == nullptr);
  CHECK(authority.chunks().first_quarantined_edit() == 10);
  CHECK(authority.chunks().dirty().empty());
}

TEST_CASE("a commit never exceeds its limits, and the rest is in the next one", "[world]") {
  Authority authority(limits(), {1, 0, 0});
  for (ClientSequence seq = 1; seq <= kCommitEditsMax + 5; ++seq) {
    REQUIRE(authority.enqueue(offer(seq, SetVoxel{{0, 0, 0}}, 1)).has_value());
  }
  Sequence next = 1;
  std::size_t commits = 0;
  while (const auto batch = authority.commit(kNow)) {
    CHECK(batch->commit.edits.at(0).seq == next);
    CHECK(batch->records.size() <= kCommitEditsMax);
    next += batch->records.size();
    ++commits;
  }
  CHECK(next == kCommitEditsMax + 6);
  CHECK(commits >= 2);
}

TEST_CASE("only clean chunks without users are evicted, longest unused first", "[world]") {
  Authority authority(limits(), {1, 0, 0});
  WorldChunks& chunks = authority.chunks();
  for (std::int32_t x = 0; x < 4; ++x) load(authority, {0, {x, 0, 0}}, base_chunk());
  (void)authority.enqueue(offer(1, box(16, 20), 1));  // chunk 1 becomes dirty
  (void)authority.commit(kNow);
  const auto is_used = [](const ChunkKey& key) { return key.at.x == 2; };
  for (std::int32_t x = 0; x < 4; ++x) chunks.released({0, {x, 0, 0}});
  chunks.evict(0, 100, is_used);
  CHECK(chunks.residency({0, {0, 0, 0}}) == Residency::absent);
  CHECK(chunks.residency(kEast) == Residency::resident);           // it is not in a snapshot yet
  CHECK(chunks.residency({0, {2, 0, 0}}) == Residency::resident);  // used
  CHECK(chunks.residency({0, {3, 0, 0}}) == Residency::absent);
  CHECK(chunks.resident_count() == 2);
  const ChunkPtr east = chunks.find(kEast);
  chunks.mark_saved(kEast, east->version);
  chunks.evict(0, 100, is_used);
  CHECK(chunks.residency(kEast) == Residency::absent);
  CHECK(chunks.version(kEast) == east->version);  // its version is known without its voxels
  load(authority, kEast, *east);
  CHECK(chunks.find(kEast)->voxels == east->voxels);
  CHECK(chunks.dirty().empty());
}

}  // namespace
}  // namespace runstone
