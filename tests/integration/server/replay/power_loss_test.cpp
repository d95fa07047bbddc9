// Power loss while the store writes. Every edit for which append() returned is on disk afterwards,
// and the log has no gap, no edit twice and no part of a batch. Each run appends random batches
// until the power fails at a random operation, opens the world again and compares it with the edits
// that were appended.
#include <catch2/catch.hpp>
#include <map>

#include "server/store/durable_mark.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/power_loss_vfs.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// The edits that the test appended to a world, and how many of them append() returned for.
struct Promise {
  std::vector<EditRecord> tried;  // record i has sequence i + 1
  Sequence durable = 0;
  Epoch epoch = 0;
  std::map<ChunkKey, ChunkPtr> snapshots;  // durable ones
  Sequence checkpoint = 0;
};

/// Returns the first broken promise, or "" if all are kept. Removes tried records that were lost.
std::string broken_promise(const std::string& folder, const SqliteOptions& options,
                           Promise& promise) {
  auto opened = open_sqlite_world(folder, StoreAccess::read_only, options);
  if (!opened) return "cannot be opened: " + opened.error().message();
  Store& store = **opened;
  // The disk keeps what was durable, so the mark never claims more than the log holds.
  if (store.loss()) return "the mark is ahead: " + store.loss()->message();
  if (store.epoch() < promise.epoch) return "an epoch was lost";
  const auto last = store.last_sequence();
  if (!last) return last.error().message();
  if (*last < promise.durable) {
    return "ends at " + std::to_string(*last) + ", but " + std::to_string(promise.durable) +
           " was durable";
  }
  if (*last > promise.tried.size()) return "holds more than was ever appended";
  if (*last > promise.durable && *last != promise.tried.size()) return "holds half of a batch";
  if (auto checked = store.check(); !checked) return checked.error().message();
  std::map<std::pair<AuthorId, ClientInstance>, ClientSequence> marks;
  std::string difference;
  const auto read = store.read_log(1, *last, [&](const EditRecord& record) {
    if (record != promise.tried[record.version.seq - 1])
      difference = "holds another edit than was appended";
    // The client sequences of sample records ascend with the log.
    marks[{record.op.author, record.op.instance}] = record.op.seq;
    return difference.empty();
  });
  if (!read) return read.error().message();
  if (!difference.empty()) return difference;
  const auto high_waters = store.high_waters();
  if (!high_waters) return high_waters.error().message();
  if (high_waters->size() != marks.size())
    return "has marks of clients that edited nothing, or lacks some";
  for (const HighWater& mark : *high_waters) {
    if (marks[{mark.author, mark.instance}] != mark.resolved)
      return "has a mark that is not the log's";
  }
  const auto checkpoint = store.checkpoint();
  if (!checkpoint) return checkpoint.error().message();
  if (*checkpoint < promise.checkpoint) return "the checkpoint fell";
  for (const auto& [key, chunk] : promise.snapshots) {
    const auto loaded = store.load_snapshot(key);
    if (!loaded) return loaded.error().message();
    if (!loaded->has_value()) return "a snapshot was lost";
    if ((*loaded)->version < chunk->version) return "a snapshot fell back";
    if ((*loaded)->version == chunk->version && (*loaded)->voxels != chunk->voxels)
      return "a snapshot changed";
  }
  promise.tried.resize(*last);
  promise.durable = *last;
  return "";
}

/// Opens the world and writes until the power fails or the jobs are done. The power may also fail
/// while the store closes.
void write_until_cut(const std::string& folder, const SqliteOptions& options, PowerLossVfs& vfs,
                     SplitMix64& rng, Promise& promise) {
  vfs.cut_after(1 + rng.below(rng.below(4) == 0 ? 20 : 1500));
  auto opened = open_sqlite_world(folder, StoreAccess::read_write, options);
  if (!opened) return;
  Store& store = **opened;
  const auto epoch = store.raise_epoch();
  if (!epoch) return;
  promise.epoch = *epoch;
  const std::uint32_t jobs = rng.below(60);
  for (std::uint32_t job = 0; job < jobs && !vfs.is_cut(); ++job) {
    if (rng.below(5) == 0 && promise.durable > 0) {
      std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
      const Version version = promise.tried[promise.durable - 1].version;
      for (std::uint32_t i = rng.below(30); i > 0; --i) {
        const ChunkKey key{0, {rng.between(-3, 3), 0, rng.between(-3, 3)}};
        // As in a real world, key and version decide the voxels, because an interrupted job may
        // have been written or not.
        SplitMix64 voxels(mix64(version.seq) ^
                          static_cast<std::uint64_t>(16 * key.at.x + key.at.z));
        chunks.emplace_back(key, sample_chunk(voxels, version));
      }
      if (!store.save_snapshots(chunks, promise.durable)) continue;
      for (const auto& [key, chunk] : chunks) promise.snapshots[key] = chunk;
      promise.checkpoint = promise.durable;
    } else {
      const auto batch = sample_records(rng, *epoch, promise.tried.size() + 1,
                                        1 + rng.below(rng.below(4) == 0 ? 400 : 12));
      promise.tried.insert(promise.tried.end(), batch.begin(), batch.end());
      const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
      if (!store.append(players, batch)) break;
      promise.durable = promise.tried.size();
    }
  }
}

struct PowerLossOutcome {
  int worlds_broken = 0;
  int cuts = 0;
  std::uint64_t durable = 0;
  std::string first;  // the first broken promise, with its seed
};

PowerLossOutcome run(bool sync, std::uint64_t seeds, int lives) {
  PowerLossOutcome outcome;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SplitMix64 rng(seed);
    const TempFolder folder;  // holds the lock file only
    PowerLossVfs vfs;
    const SqliteOptions options{vfs.name(), sync};
    REQUIRE(create_sqlite_world(folder.path(), sample_meta(), options).has_value());
    Promise promise;
    for (int life = 0; life < lives; ++life) {
      write_until_cut(folder.path(), options, vfs, rng, promise);
      outcome.cuts += vfs.is_cut() ? 1 : 0;
      vfs.power_loss(rng);
      const std::string broken = broken_promise(folder.path(), options, promise);
      if (broken.empty()) continue;
      ++outcome.worlds_broken;
      if (outcome.first.empty()) outcome.first = "seed " + std::to_string(seed) + ": " + broken;
      break;  // the test no longer knows the content of this world
    }
    outcome.durable += promise.durable;
  }
  return outcome;
}

}  // namespace

TEST_CASE("every edit that append returned for survives power loss, and batches are atomic",
          "[store][power-loss]") {
  const PowerLossOutcome outcome = run(true, 30, 6);
  INFO(outcome.first);
  CHECK(outcome.worlds_broken == 0);
  CHECK(outcome.cuts > 50);  // the power really failed in the middle of work
  CHECK(outcome.durable > 30 * 100);
}

TEST_CASE("a mark that was synced survives power loss and is never ahead of the log",
          "[store][power-loss]") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    SplitMix64 rng(seed);
    const TempFolder folder;
    PowerLossVfs vfs;
    const SqliteOptions options{vfs.name(), true};
    auto store = *create_sqlite_world(folder.path(), sample_meta(), options);
    REQUIRE(store->raise_epoch().has_value());
    const std::uint32_t synced = 1 + rng.below(6), unsynced = rng.below(6);
    for (Sequence seq = 1; seq <= synced; ++seq)
      REQUIRE(store->append({}, sample_records(rng, 1, seq, 1)).has_value());
    REQUIRE(store->save_snapshots({}, synced).has_value());  // a checkpoint
    for (Sequence seq = synced + 1; seq <= synced + unsynced; ++seq)
      REQUIRE(store->append({}, sample_records(rng, 1, seq, 1)).has_value());
    vfs.power_loss(rng);
    store.reset();  // the old connection cannot write any more
    DurableMark mark(folder.path(), sample_meta().world_id, vfs.name());
    const auto read = mark.read();
    REQUIRE(read.has_value());
    REQUIRE(read->has_value());
    CHECK((*read)->epoch == 1);
    CHECK((*read)->seq >= synced);
    CHECK((*read)->seq <= synced + unsynced);
    CHECK(open_sqlite_world(folder.path(), StoreAccess::read_write, options).has_value());
  }
}

TEST_CASE("the power-loss test notices a store that does not sync", "[store][power-loss]") {
  const PowerLossOutcome outcome = run(false, 20, 6);
  CHECK(outcome.worlds_broken > 10);
  CHECK_FALSE(outcome.first.empty());
}

TEST_CASE("a world whose creation is interrupted is complete or does not exist",
          "[store][power-loss]") {
  int whole = 0, none = 0;
  for (std::uint64_t cut = 1; cut < 60; ++cut) {
    SplitMix64 rng(cut);
    const TempFolder folder;
    PowerLossVfs vfs;
    const SqliteOptions options{vfs.name(), true};
    vfs.cut_after(cut);
    const bool returned =
        create_sqlite_world(folder.path(), sample_meta(), options).has_value() && !vfs.is_cut();
    vfs.power_loss(rng);
    auto opened = open_sqlite_world(folder.path(), StoreAccess::read_write, options);
    CAPTURE(cut, returned);
    if (opened) {
      ++whole;
      CHECK((*opened)->check().has_value());
      CHECK((*opened)->meta().world_id == sample_meta().world_id);
    } else {
      ++none;
      CHECK_FALSE(returned);
      INFO(opened.error().message());
      CHECK(opened.error().kind == StoreError::Kind::not_a_world);
    }
  }
  CHECK(whole > 5);
  CHECK(none > 5);
}

TEST_CASE("a commit whose sync fails is reported and ends all writing", "[store][power-loss]") {
  SplitMix64 rng(1);
  const TempFolder folder;
  PowerLossVfs vfs;
  const SqliteOptions options{vfs.name(), true};
  auto store = *create_sqlite_world(folder.path(), sample_meta(), options);
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->append({}, sample_records(rng, 1, 1, 3)).has_value());
  vfs.fail_next_sync();
  const auto failed = store->append({}, sample_records(rng, 1, 4, 3));
  REQUIRE_FALSE(failed.has_value());
  CHECK(failed.error().kind == StoreError::Kind::io);
  // The kernel may have dropped the pages that failed, so a second attempt that succeeds would
  // prove nothing.
  const auto after = store->append({}, sample_records(rng, 1, 4, 3));
  REQUIRE_FALSE(after.has_value());
  CHECK(after.error().what == "an earlier commit failed; open the world again");
  store.reset();
  vfs.power_loss(rng);
  auto again = open_sqlite_world(folder.path(), StoreAccess::read_write, options);
  REQUIRE(again.has_value());
  CHECK(*(*again)->last_sequence() >= 3);
  CHECK((*again)->check().has_value());
}

TEST_CASE("one commit costs one sync", "[store][power-loss]") {
  SplitMix64 rng(2);
  const TempFolder folder;
  PowerLossVfs vfs;
  auto store = *create_sqlite_world(folder.path(), sample_meta(), {vfs.name(), true});
  REQUIRE(store->raise_epoch().has_value());
  // The first commit of a run says in the main file that the world is open.
  REQUIRE(store->append({}, sample_records(rng, 1, 1, 50)).has_value());
  Sequence next = 51;
  std::uint64_t syncs = vfs.syncs();
  for (int i = 0; i < 10; ++i, next += 50) {
    REQUIRE(store->append({}, sample_records(rng, 1, next, 50)).has_value());
    CHECK(vfs.syncs() == syncs + 1);
    syncs = vfs.syncs();
  }
}
