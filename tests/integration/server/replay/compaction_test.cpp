// A compaction moves the beginning of the log into the base and loses nothing, also if power or
// disk fail meanwhile.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/admin/compact_program.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/history/named_moment.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/sql/power_loss_vfs.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr Sequence kEdits = 160, kCut = 100;
constexpr TimeUs kDay = 86'400'000'000;
constexpr TimeUs kCutTime =
    1'700'000'000'000'000 + TimeUs{kCut} * 1000;  // of edit kCut, as sample_record() stamps it

std::unique_ptr<Store> compacted_store(const std::string& folder,
                                       const SqliteOptions& options = {}) {
  auto store = open_sqlite_world(folder, StoreAccess::read_write, options);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

std::unique_ptr<Generator> generator_of(const Store& store) {
  return *make_generator(store.meta().generator, store.meta().materials);
}

using ChunkMap = std::map<ChunkKey, Chunk>;
ChunkMap moment_of(Store& store, Sequence at) {
  const auto generator = generator_of(store);
  auto world = WorldAt::open(store, *generator, at);
  if (!world) FAIL(world.error().message());
  ChunkMap moment;
  for (const ChunkKey& key : world->edited()) {
    auto chunk = world->chunk(key);
    if (!chunk) FAIL(chunk.error().message());
    moment.emplace(key, *std::move(chunk));
  }
  return moment;
}

void make_keyframe(Store& store, Sequence at) {
  const auto generator = generator_of(store);
  KeyframeMaker maker(store, *generator, {});
  const auto made = maker.make_at(
      at, [&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
        return store.save_keyframe(chunks, keyframe);
      });
  if (!made) FAIL(made.error().message());
}

/// A closed world of kEdits edits with keyframes at 70 and 130, snapshots of some chunks and the
/// checkpoint at 60.
void make_compaction_world(const std::string& folder, const SqliteOptions& options = {}) {
  SplitMix64 rng(1);
  WorldMeta meta = sample_meta();
  meta.generator.name = "flat";
  auto created = create_sqlite_world(folder, meta, options);
  REQUIRE(created.has_value());
  Store& store = **created;
  REQUIRE(store.raise_epoch().has_value());
  auto records = sample_records(rng, 1, 1, kEdits);
  for (EditRecord& record : records) {
    do {
      record.edit = random_edit_near(rng, {}, Extent::cube(kSampleEdge));
    } while (touched_chunks(record.edit, kSampleEdge).size() > 4);
  }
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store.append(players, records).has_value());
  std::vector<std::pair<ChunkKey, ChunkPtr>> snapshots;
  for (const auto& [key, chunk] : moment_of(store, 60)) {
    snapshots.emplace_back(key, std::make_shared<const Chunk>(chunk));
  }
  REQUIRE(store.save_snapshots(snapshots, 60).has_value());
  make_keyframe(store, 70);
  make_keyframe(store, 130);
}

/// Checks what must hold for the world before and after the compaction.
void check_whole(Store& store, const ChunkMap& at_end) {
  const auto checked = store.check();
  if (!checked) FAIL(checked.error().message());
  REQUIRE(*store.last_sequence() == kEdits);
  CHECK(moment_of(store, kEdits) == at_end);
  // A server would load the snapshots and the records above the checkpoint.
  const Sequence checkpoint = *store.checkpoint();
  const auto snapshot_keys = *store.snapshot_keys();
  const std::map<ChunkKey, Version> snapshots(snapshot_keys.begin(), snapshot_keys.end());
  for (const auto& [key, chunk] : moment_of(store, checkpoint)) {
    const auto found = snapshots.find(key);
    REQUIRE(found != snapshots.end());
    CHECK(found->second == chunk.version);
  }
}

std::vector<std::tuple<AuthorId, ClientInstance, ClientSequence, TimeUs>> marks_of(Store& store) {
  std::vector<std::tuple<AuthorId, ClientInstance, ClientSequence, TimeUs>> marks;
  const auto rows = *store.high_waters();
  for (const HighWater& mark : rows)
    marks.emplace_back(mark.author, mark.instance, mark.resolved, mark.last_us);
  return marks;
}

struct Outcome {
  bool done;
  std::string said;
};
Outcome compact(const std::string& folder, TimeUs now_us, std::uint64_t keep_days,
                const SqliteOptions& options = {}) {
  std::ostringstream out;
  const auto compacted =
      compact_world({folder, keep_days, true, false, true}, now_us, out, options);
  return {compacted.has_value(), compacted ? out.str() : compacted.error()};
}

}  // namespace

TEST_CASE("a compacted world is unchanged from its new beginning on", "[store][compact]") {
  const TempFolder folder;
  make_compaction_world(folder.path());
  std::map<Sequence, ChunkMap> before;
  std::vector<std::tuple<AuthorId, ClientInstance, ClientSequence, TimeUs>> marks;
  {
    auto store = compacted_store(folder.path());
    for (const Sequence at : {kCut, kCut + 1, Sequence{130}, Sequence{145}, kEdits})
      before[at] = moment_of(*store, at);
    marks = marks_of(*store);
  }
  const std::string json = folder / "report.json";
  REQUIRE(run_replay({"verify", "--quick", "--world", folder.path(), "--json", json}).code == 0);
  const auto digest = [&] {
    return nlohmann::json::parse(std::ifstream(json)).at("report").at("world_digest");
  };
  const auto digest_before = digest();

  const auto done = compact(folder.path(), kCutTime + 3 * kDay, 3);
  INFO(done.said);
  REQUIRE(done.done);
  CHECK(done.said.find("compacted   edits 1 to 100 into the base, 60 edits stay\n") == 0);
  {
    auto store = compacted_store(folder.path());
    CHECK(store->log_range()->first == kCut + 1);
    CHECK(*store->checkpoint() == kCut);
    check_whole(*store, before[kEdits]);
    for (const auto& [at, moment] : before) {
      CAPTURE(at);
      CHECK(moment_of(*store, at) == moment);
    }
    const auto keyframes = *store->keyframes();
    REQUIRE(keyframes.size() == 1);
    CHECK(keyframes.front().at.version.seq == 130);
    CHECK(marks_of(*store) == marks);
    const auto generator = generator_of(*store);
    CHECK(WorldAt::open(*store, *generator, kCut - 1).error().what ==
          "begins at seq=101: the world at seq=99 was removed by retention up to seq=100 "
          "(2023-11-14T22:13:20Z), which is the earliest one left");
    CHECK(*sequence_of(*store, AtTime{kCutTime}) == kCut);
    REQUIRE(store->raise_epoch().has_value());
    SplitMix64 rng(2);
    CHECK(store->append({}, sample_records(rng, 2, kEdits + 1, 3)).has_value());
    CHECK(store->check().has_value());
  }
  CHECK(run_replay(
            {"verify", "--world", folder.path(), "--at", std::to_string(kEdits), "--json", json})
            .code == 0);
  CHECK(digest() == digest_before);
  // A second compaction reaches the end of the log and leaves no edit in it.
  CHECK(compact(folder.path(), kCutTime + 3 * kDay, 3).said ==
        "nothing to compact: no edit of the log is older than 3 days\n");
  REQUIRE(compact(folder.path(), kCutTime + kDay, 0).done);
  auto store = compacted_store(folder.path());
  CHECK(store->log_range()->first == kEdits + 4);
  CHECK(store->check().has_value());
  CHECK(store->keyframes()->empty());
}

TEST_CASE("a compaction that keeps no day says what it would do and asks for --anyway",
          "[store][compact]") {
  const TempFolder folder;
  make_compaction_world(folder.path());
  std::ostringstream out;
  const TimeUs later = kCutTime + 30 * kDay;
  const auto asked = compact_world({folder.path(), 0}, later, out);
  REQUIRE_FALSE(asked.has_value());
  CHECK(asked.error() ==
        folder / "world.sqlite" +
            ": nothing has changed: --keep 0 would move 160 of 160 edits of the log into the base, "
            "and they could not be seen in the past, rolled back or undone any more. To do it all "
            "the same, add --anyway");
  CHECK(out.str().empty());
  CHECK(compacted_store(folder.path())->log_range()->first == 1);
  REQUIRE(compact(folder.path(), later, 0).done);
  // No edit is left that could be lost.
  CHECK(compact_world({folder.path(), 0}, later, out).has_value());
  CHECK(out.str() == "nothing to compact: no edit of the log is older than 0 days\n");
}

TEST_CASE("a compaction leaves a world without old edits unchanged", "[store][compact]") {
  const TempFolder folder;
  make_compaction_world(folder.path());
  const std::string nothing = "nothing to compact: no edit of the log is older than 30 days\n";
  CHECK(compact(folder.path(), kCutTime + kDay, 30).said == nothing);
  CHECK(compacted_store(folder.path())->log_range()->first == 1);
  const TempFolder fresh;
  REQUIRE(create_world(fresh.path(), sample_meta()).has_value());
  CHECK(compact(fresh.path(), kCutTime, 30).said == nothing);
  const auto held = compacted_store(folder.path());
  CHECK(compact(folder.path(), kCutTime, 0).said.find("another program is writing this world") !=
        std::string::npos);
  CHECK(held->compact(99).error().what == "is not there");  // no keyframe
  CHECK(held->compact(0).error().what == "is not there");
}

TEST_CASE("a compaction that a power failure interrupts loses nothing and can be repeated",
          "[store][compact][power-loss]") {
  std::size_t before = 0, after = 0;
  for (std::uint64_t cut = 1; cut < 400; cut += 1 + cut / 8) {
    CAPTURE(cut);
    SplitMix64 rng(cut);
    const TempFolder folder;
    PowerLossVfs vfs;
    const SqliteOptions options{vfs.name(), true};
    make_compaction_world(folder.path(), options);
    const ChunkMap at_end = moment_of(*compacted_store(folder.path(), options), kEdits);
    vfs.cut_after(cut);
    const auto outcome = compact(folder.path(), kCutTime, 0, options);
    vfs.power_loss(rng);
    {
      auto store = compacted_store(folder.path(), options);
      const Sequence first = store->log_range()->first;
      CHECK((first == 1 || first == kCut + 1));
      if (outcome.done) CHECK(first == kCut + 1);
      ++(first == 1 ? before : after);
      check_whole(*store, at_end);
    }
    compact(folder.path(), kCutTime, 0, options);
    auto store = compacted_store(folder.path(), options);
    CHECK(store->log_range()->first == kCut + 1);
    check_whole(*store, at_end);
  }
  CHECK(before > 3);
  CHECK(after > 3);
}

TEST_CASE("a compaction that fills the disk reports it and loses nothing",
          "[store][compact][power-loss]") {
  std::size_t full = 0, shrunk_too_late = 0;
  for (std::uint64_t room = 1; room < 300; room += 1 + room / 6) {
    CAPTURE(room);
    const TempFolder folder;
    PowerLossVfs vfs;
    const SqliteOptions options{vfs.name(), true};
    make_compaction_world(folder.path(), options);
    const ChunkMap at_end = moment_of(*compacted_store(folder.path(), options), kEdits);
    vfs.full_after(room);
    const auto outcome = compact(folder.path(), kCutTime, 0, options);
    vfs.make_room();
    INFO(outcome.said);
    auto store = compacted_store(folder.path(), options);
    const Sequence first = store->log_range()->first;
    check_whole(*store, at_end);
    if (outcome.done) continue;
    const bool says_full = outcome.said.find("full") != std::string::npos;
    CHECK(says_full);
    if (first == 1) {
      ++full;
      CHECK(outcome.said.find("nothing was lost, and the world stands as before") !=
            std::string::npos);
    } else {
      ++shrunk_too_late;
      CHECK(outcome.said.find("is compacted and sound") != std::string::npos);
    }
    store.reset();
    CHECK(compact(folder.path(), kCutTime, 0, options).done);
    check_whole(*compacted_store(folder.path(), options), at_end);
  }
  CHECK(full > 3);
  CHECK(shrunk_too_late > 0);
}
