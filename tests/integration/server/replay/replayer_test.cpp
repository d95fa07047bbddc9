// Replay against a world that was edited live, edit by edit, and against a dense oracle that shares
// no code with it.
#include "server/replay/replayer.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>

#include "server/replay/replay_program.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/compact_by_hand.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr int kEdge = kSampleEdge;
constexpr Sequence kAll = ~Sequence{0};

/// Ground up to y = 3 of material 2, so that chunks without a base row are not all empty.
class GroundGenerator final : public Generator {
 public:
  RunChunk generate(VoxelPos origin, Extent extent) const override {
    RunChunk chunk = uniform_chunk(extent, kEmpty, AxisOrder::xzy);
    for (int y = 0; y < extent.y; ++y) {
      if (origin.y + y >= 4) break;
      fill(chunk, static_cast<VoxelIndex>(y * extent.x * extent.z),
           std::uint32_t{extent.x} * extent.z, 2);
    }
    return chunk;
  }
  std::int32_t y_min() const override { return -1000; }
  std::int32_t y_max() const override { return 4; }
  std::int32_t surface_y(std::int32_t, std::int32_t) const override { return 4; }
};

bool oracle_admits(const Mask& mask, Material present) {
  switch (mask.kind) {
    case MaskKind::everything:
      return true;
    case MaskKind::only_empty:
      return present == 0;
    case MaskKind::only_solid:
      return present != 0;
    default:
      return present == mask.material;
  }
}

/// A world on disk, and its chunks as live editing made them.
struct LiveWorld {
  TempFolder folder;
  GroundGenerator generator;
  std::unique_ptr<Store> store;
  std::map<ChunkKey, Chunk> live;        // one edit at a time, as a server without batching would
  std::map<ChunkKey, DenseChunk> dense;  // the oracle
  std::set<ChunkKey> edited;
  std::vector<EditRecord> log;
  std::vector<std::map<ChunkKey, DigestCheckEntry>>
      history;  // digests after each edit; [0] is the base

  explicit LiveWorld(std::uint64_t seed) {
    SplitMix64 rng(seed);
    store = *create_world(folder.path(), sample_meta());
    std::vector<std::pair<ChunkKey, ChunkPtr>> base;
    for (int i = 0; i < 8; ++i) {
      const ChunkKey key{0, {i % 2 - 1, i / 2 % 2, i / 4 - 1}};
      base.emplace_back(key, sample_chunk(rng, {}));
      live[key] = *base.back().second;
    }
    REQUIRE(store->save_base(base).has_value());
    REQUIRE(store->raise_epoch().has_value());
    history.emplace_back();
  }

  Chunk& chunk(const ChunkKey& key) {
    const auto found = live.find(key);
    if (found != live.end()) return found->second;
    Chunk made;
    made.voxels = generator.generate(origin_of(key.at, kEdge), Extent::cube(kEdge));
    made.digest = digest_of(made.voxels);
    return live.emplace(key, made).first->second;
  }

  void apply(const EditRecord& record) {
    ApplyScratch scratch;
    std::map<ChunkKey, DigestCheckEntry> now = history.back();
    for (int cx = -5; cx < 5; ++cx) {
      for (int cy = -4; cy < 5; ++cy) {
        for (int cz = -5; cz < 5; ++cz) {
          const ChunkKey key{0, {cx, cy, cz}};
          const VoxelPos o = origin_of(key.at, kEdge);
          const VoxelBox box = intersect(box_of(key.at, kEdge), bounding_box(record.edit));
          if (box.empty()) continue;
          Chunk& runs = chunk(key);
          DenseChunk& voxels = dense.try_emplace(key, DenseChunk::of(runs.voxels)).first->second;
          bool touched = false;
          for (int x = box.min.x; x < box.max.x; ++x) {
            for (int y = box.min.y; y < box.max.y; ++y) {
              for (int z = box.min.z; z < box.max.z; ++z) {
                const auto written = oracle_writes(record.edit, {x, y, z});
                if (!written) continue;
                touched = true;
                const Material present = voxels.at(x - o.x, y - o.y, z - o.z);
                if (oracle_admits(record.edit.mask, present)) {
                  voxels.set(x - o.x, y - o.y, z - o.z, *written);
                }
              }
            }
          }
          if (!touched) continue;
          edited.insert(key);
          apply_stack(runs.voxels, runs.digest, o, {&record.edit, 1}, scratch);
          runs.version = record.version;
          now[key] = {key, record.version, runs.digest};
        }
      }
    }
    log.push_back(record);
    history.push_back(std::move(now));
  }

  void edit(SplitMix64& rng, std::size_t count) {
    const auto records = sample_records(rng, store->epoch(), log.size() + 1, count);
    for (const EditRecord& record : records) apply(record);
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    REQUIRE(store->append(players, records).has_value());
  }

  void snapshot(SplitMix64& rng) {
    std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
    for (const ChunkKey& key : edited) {
      if (rng.below(2) == 0) chunks.emplace_back(key, std::make_shared<const Chunk>(live.at(key)));
    }
    REQUIRE(store->save_snapshots(chunks, std::nullopt).has_value());
  }

  /// Returns the digest list that a replica of all chunks would write at `seq`.
  DigestList list_at(Sequence seq) const {
    DigestList list{store->meta().world_id, seq, {}};
    for (const auto& [key, entry] : history[seq]) list.chunks.push_back(entry);
    return list;
  }

  ReplayReport replay(Sequence at = kAll, const DigestList* list = nullptr) const {
    Replayer replayer(*store, generator);
    if (list != nullptr) replayer.expect("list", *list);
    auto report = replayer.run(at);
    if (!report) FAIL(report.error().message());
    return *std::move(report);
  }
};

std::vector<std::pair<ChunkKey, Digest>> pairs_of(const std::vector<DigestCheckEntry>& entries) {
  std::vector<std::pair<ChunkKey, Digest>> pairs;
  for (const DigestCheckEntry& entry : entries) pairs.emplace_back(entry.key, entry.digest);
  return pairs;
}

}  // namespace

TEST_CASE("replay equals live editing and a dense oracle", "[store][replay]") {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    CAPTURE(seed);
    LiveWorld world(seed);
    SplitMix64 rng(seed + 100);
    for (int round = 0; round < 6; ++round) {
      world.edit(rng, 1 + rng.below(120));
      world.snapshot(rng);
    }
    const DigestList list = world.list_at(world.log.size());
    const ReplayReport report = world.replay(kAll, &list);
    if (report.first) FAIL(report.first->message());
    CHECK(report.edits == world.log.size());
    CHECK(report.seq == world.log.size());
    CHECK(report.snapshots_compared == world.store->snapshot_keys()->size());
    CHECK(report.snapshots_compared > 20);
    CHECK(report.listed_compared == list.chunks.size());
    CHECK(report.not_compared == 0);
    CHECK(report.voxels_changed > 1000);
    CHECK(pairs_of(report.digests) == pairs_of(list.chunks));
    CHECK(report.digests.size() == world.edited.size());
    Digest fold;
    for (const DigestCheckEntry& entry : report.digests) {
      CHECK(entry.digest == world.dense.at(entry.key).digest());
      CHECK(entry.version == world.live.at(entry.key).version);
      fold = fold + world_digest_term(entry.key, entry.digest);
    }
    CHECK(report.world_digest == fold);
  }
}

TEST_CASE("replay to an earlier sequence gives the world of that moment", "[store][replay]") {
  LiveWorld world(7);
  SplitMix64 rng(7);
  world.edit(rng, 150);
  world.snapshot(rng);
  for (const Sequence at : {Sequence{0}, Sequence{1}, Sequence{77}, Sequence{150}}) {
    CAPTURE(at);
    const DigestList list = world.list_at(at);
    const ReplayReport report = world.replay(at, &list);
    CHECK(report.differences == 0);
    CHECK(report.seq == at);
    CHECK(pairs_of(report.digests) == pairs_of(list.chunks));
    CHECK(report.listed_compared == list.chunks.size());
    CHECK(report.snapshots_compared + report.not_compared == world.store->snapshot_keys()->size());
  }
  // A list of an earlier moment is compared on the way, chunk by chunk, while the replay goes on to
  // the end.
  const DigestList early = world.list_at(60);
  const ReplayReport report = world.replay(kAll, &early);
  CHECK(report.differences == 0);
  CHECK(report.listed_compared == early.chunks.size());
}

TEST_CASE("chunks that nobody edited are compared with base and generator", "[store][replay]") {
  LiveWorld world(8);
  SplitMix64 rng(8);
  const ChunkKey imported{0, {-1, 0, -1}}, generated{0, {40, 0, 40}};
  DigestList list{world.store->meta().world_id, 0, {}};
  for (const ChunkKey& key : {imported, generated})
    list.chunks.push_back({key, {}, world.chunk(key).digest});
  CHECK(world.replay(kAll, &list).listed_compared == 2);
  CHECK(world.replay(kAll, &list).differences == 0);
  world.edit(rng, 50);  // edits the imported one: its base version is then met on the way
  CHECK(world.replay(kAll, &list).differences == 0);
  list.chunks[1].digest.lane[0] ^= 1;
  const ReplayReport report = world.replay(kAll, &list);
  CHECK(report.differences == 1);
  REQUIRE(report.first.has_value());
  CHECK(report.first->key == generated);
}

TEST_CASE("replay notices a snapshot with other voxels than the log makes", "[store][replay]") {
  LiveWorld world(9);
  SplitMix64 rng(9);
  world.edit(rng, 60);
  const ChunkKey key = *world.edited.begin();
  Chunk tampered = world.live.at(key);
  const Material there = material_at(tampered.voxels, {5, 5, 5});
  fill(tampered.voxels, index_of({5, 5, 5}, tampered.voxels.extent, tampered.voxels.order), 1,
       there == 1 ? 2 : 1);
  tampered.digest = digest_of(tampered.voxels);
  const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {
      {key, std::make_shared<const Chunk>(tampered)}};
  REQUIRE(world.store->save_snapshots(chunks, std::nullopt).has_value());
  REQUIRE(world.store->check().has_value());  // the row is sound, its content is wrong
  const ReplayReport report = world.replay();
  CHECK(report.differences == 1);
  REQUIRE(report.first.has_value());
  CHECK(report.first->source == "snapshot");
  CHECK(report.first->key == key);
  CHECK(report.first->expected == tampered.digest);
  CHECK(report.first->rebuilt == world.live.at(key).digest);
  CHECK(report.first->message().find(to_hex(tampered.digest)) != std::string::npos);
}

TEST_CASE("replay notices one changed edit in the log", "[store][replay]") {
  LiveWorld world(10), forged(10);
  SplitMix64 rng(10);
  world.edit(rng, 40);
  auto records = world.log;
  records[19].edit = {SetVoxel{{3, 3, 3}}, {}, 4};
  // The world equals the first one except for one record, which is valid in itself.
  REQUIRE(forged.store->append({}, records).has_value());
  const DigestList honest = world.list_at(40);
  const ReplayReport report = forged.replay(kAll, &honest);
  CHECK(report.differences > 0);
  CHECK(forged.replay(kAll).differences == 0);
}

TEST_CASE("a version that the log never gave a chunk is a difference", "[store][replay]") {
  LiveWorld world(11);
  SplitMix64 rng(11);
  world.edit(rng, 30);
  DigestList list = world.list_at(30);
  const DigestCheckEntry last = list.chunks.back();
  list.chunks = {last};
  list.chunks[0].version.epoch += 1;  // as if a crash had lost the edit
  const ReplayReport report = world.replay(kAll, &list);
  CHECK(report.differences == 1);
  REQUIRE(report.first.has_value());
  CHECK(report.first->expected_version == list.chunks[0].version);
  CHECK(report.first->rebuilt_version == last.version);
  CHECK(report.first->message().find("is not in the log") != std::string::npos);
  list.chunks[0].version = {1, 31};  // newer than the end of the replay
  CHECK(world.replay(kAll, &list).differences == 0);
  CHECK(world.replay(kAll, &list).not_compared == 1);
}

TEST_CASE("replay reads a world while its server goes on writing", "[store][replay]") {
  LiveWorld world(12);
  SplitMix64 rng(12);
  world.edit(rng, 50);
  const auto reader = *open_world(world.folder.path(), StoreAccess::read_only);
  Replayer replayer(*reader, world.generator);
  world.edit(rng, 50);
  world.snapshot(rng);
  const auto report = replayer.run(kAll);
  REQUIRE(report.has_value());
  CHECK(report->edits == 100);
  CHECK(report->differences == 0);
}

TEST_CASE("a world whose log was compacted replays from its newer base", "[store][replay]") {
  LiveWorld world(15);
  SplitMix64 rng(15);
  world.edit(rng, 60);
  std::vector<std::pair<ChunkKey, ChunkPtr>> base;
  for (const ChunkKey& key : world.edited) {
    base.emplace_back(key, std::make_shared<const Chunk>(world.live.at(key)));
  }
  REQUIRE(world.store->save_snapshots(base, 60).has_value());
  const LogEnd head = world.store->log_range()->last;
  world.edit(rng, 40);
  const DigestList list = world.list_at(100);
  world.store.reset();
  compact_by_hand(world.folder / "world.sqlite", head, base);
  world.store = *open_world(world.folder.path(), StoreAccess::read_write);
  CHECK(world.store->check().has_value());

  const ReplayReport report = world.replay(kAll, &list);
  if (report.first) FAIL(report.first->message());
  CHECK(report.edits == 40);
  CHECK(report.seq == 100);
  CHECK(report.listed_compared == list.chunks.size());  // includes chunks that only the base has
  CHECK(report.snapshots_compared == base.size());
  CHECK(world.replay(60).edits == 0);
  const auto before = Replayer(*world.store, world.generator).run(59);
  REQUIRE_FALSE(before.has_value());
  CHECK(before.error().kind == StoreError::Kind::bad_request);
}

TEST_CASE("a damaged log row stops the replay with its name", "[store][replay]") {
  LiveWorld world(13);
  SplitMix64 rng(13);
  world.edit(rng, 20);
  REQUIRE(raw_sql(world.folder / "world.sqlite", "UPDATE edit_log SET time_us = 0 WHERE seq = 11")
              .empty());
  Replayer replayer(*world.store, world.generator);
  const auto report = replayer.run(kAll);
  REQUIRE_FALSE(report.has_value());
  CHECK(report.error().where == "edit_log seq=11");
}
