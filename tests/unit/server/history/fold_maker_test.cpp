// Retention moves the beginning of a log into the base in parts. No data is lost, also if power or
// disk fail in a part or between two parts.
#include "server/history/fold_maker.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <limits>
#include <tuple>

#include "server/history/moments.hpp"
#include "server/history/retention_plan.hpp"
#include "server/rollback/rollback_preview.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/builder_session.hpp"
#include "tests/support/sql/power_loss_vfs.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/history/retention_world.hpp"

namespace runstone::test {
namespace {

constexpr Sequence kCutOff = 90;

/// The data that a retention must never remove.
struct KeptRows {
  std::vector<Sequence> rights;
  MaterialTable materials;
  std::vector<std::tuple<AuthorId, ClientInstance, ClientSequence, TimeUs>> marks;
  std::vector<std::pair<AuthorId, std::string>> players;
};

KeptRows kept_rows(Store& store) {
  KeptRows kept;
  REQUIRE(store
              .read_rights([&](const EditRecord& record) {
                kept.rights.push_back(record.version.seq);
                return true;
              })
              .has_value());
  kept.materials = *store.materials();
  const auto marks = *store.high_waters();
  for (const HighWater& mark : marks)
    kept.marks.emplace_back(mark.author, mark.instance, mark.resolved, mark.last_us);
  const auto players = *store.players();
  for (const PlayerRow& player : players) kept.players.emplace_back(player.author, player.name);
  return kept;
}

void check_same_rows(const KeptRows& found, const KeptRows& expected) {
  CHECK(found.rights == expected.rights);
  CHECK((found.materials == expected.materials));
  CHECK((found.marks == expected.marks));
  CHECK((found.players == expected.players));
}

/// Checks the world, and that its present and the moments from the head on are as they were.
void check_folded(Store& store, const std::map<Sequence, MomentChunks>& before) {
  const auto sound = store.check();
  if (!sound) FAIL(sound.error().message());
  const Sequence head = store.log_head()->version.seq;
  CHECK(store.log_range()->first == head + 1);
  for (const auto& [at, chunks] : before) {
    if (at < head) continue;
    CAPTURE(head, at);
    CHECK(moment_chunks(store, at) == chunks);
  }
}

/// Folds up to `until`, in parts, until it is done or fails. Returns the last error.
StoreResult<void> fold_up_to(Store& store, Sequence until, const FoldSize& size) {
  const auto generator = retention_generator(store);
  FoldMaker maker(store, *generator);
  for (;;) {
    auto fold = maker.next(until, size);
    if (!fold) return failure(fold.error());
    if (!fold->has_value()) return {};
    if (auto folded = store.fold_log(**fold); !folded) return folded;
  }
}

}  // namespace

TEST_CASE("a log that is folded in parts leaves the present and every later moment as they were",
          "[store][retention][property]") {
  for (std::uint64_t run = 0; run < 3; ++run) {
    SplitMix64 rng(Catch::rngSeed() + run);
    CAPTURE(Catch::rngSeed(), run);
    const TempFolder folder;
    const std::vector<Sequence> keyframes{40, 95};
    make_retention_world(folder.path(), rng, run == 0 ? std::vector<Sequence>{} : keyframes);
    auto store = opened_retention_world(folder.path(), StoreAccess::read_write);
    const auto reader = opened_retention_world(folder.path(), StoreAccess::read_only);
    std::map<Sequence, MomentChunks> before;
    for (const Sequence at : {Sequence{0}, Sequence{20}, Sequence{41}, Sequence{60}, Sequence{95},
                              Sequence{100}, kRetentionEdits})
      before[at] = moment_chunks(*store, at);
    const KeptRows kept = kept_rows(*store);
    const Sequence cut = 30 + rng.below(80);
    const auto generator = retention_generator(*store);
    FoldMaker maker(*reader, *generator);
    Sequence head = 0;
    for (;;) {
      const auto fold = maker.next(cut, {1 + rng.below(20), 1 + rng.below(12)});
      REQUIRE(fold.has_value());
      if (!fold->has_value()) break;
      REQUIRE((*fold)->from == head);
      const auto folded = store->fold_log(**fold);
      if (!folded) FAIL(folded.error().message());
      head = (*fold)->to.version.seq;
      if (rng.below(4) == 0) check_folded(*store, before);
    }
    CHECK(head == cut);
    check_folded(*store, before);
    check_same_rows(kept_rows(*store), kept);
    store.reset();
    store = opened_retention_world(folder.path(), StoreAccess::read_write);
    check_folded(*store, before);
    // The log goes on.
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(
        store
            ->append({}, retention_records(rng, store->meta().materials, 2, kRetentionEdits + 1, 5))
            .has_value());
    CHECK(store->check().has_value());
    CHECK(kept_rows(*store).rights.size() == kept.rights.size());
  }
}

TEST_CASE("a fold that does not fit the log is refused and changes nothing", "[store][retention]") {
  SplitMix64 rng(5);
  const TempFolder folder;
  make_retention_world(folder.path(), rng, {40});
  const auto store = opened_retention_world(folder.path(), StoreAccess::read_write);
  const auto generator = retention_generator(*store);
  FoldMaker maker(*store, *generator);
  const LogFold good = **maker.next(30, {30, 100});
  REQUIRE(good.to.version.seq == 30);
  LogFold other_head = good;
  other_head.from = 3;
  LogFold without_chunk = good;
  without_chunk.chunks.pop_back();
  LogFold old_chunk = good;
  Chunk chunk = *old_chunk.chunks.front().second;
  chunk.version = {1, 31};
  old_chunk.chunks.front().second = std::make_shared<const Chunk>(chunk);
  LogFold other_time = good;
  other_time.to.time_us += 1;
  LogFold nothing = good;
  nothing.to = *store->log_head();
  LogFold other_voxels = good;
  Chunk damaged = *other_voxels.chunks.front().second;
  damaged.digest = digest_of(sample_chunk(rng, {})->voxels);
  other_voxels.chunks.front().second = std::make_shared<const Chunk>(damaged);
  for (const LogFold& wrong :
       {other_head, without_chunk, old_chunk, other_time, nothing, other_voxels}) {
    const auto refused = store->fold_log(wrong);
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().kind == StoreError::Kind::bad_request);
    CHECK(store->log_range()->first == 1);
  }
  CHECK(store->check().has_value());
  REQUIRE(store->fold_log(good).has_value());
  CHECK(store->fold_log(good).error().kind == StoreError::Kind::bad_request);  // not twice
}

TEST_CASE("nothing behind the checkpoint is folded", "[store][retention]") {
  const TempFolder folder;
  SplitMix64 rng(6);
  WorldMeta meta = sample_meta();
  const auto store = *create_world(folder.path(), meta);
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->append({}, retention_records(rng, meta.materials, 1, 1, 20)).has_value());
  const auto done = fold_up_to(*store, 10, {});
  REQUIRE_FALSE(done.has_value());
  CHECK(done.error().what == "lies outside the log, or behind the checkpoint seq=0");
}

TEST_CASE("a log does not begin with an edit that is lost", "[store][retention]") {
  SplitMix64 rng(8);
  const TempFolder folder;
  make_retention_world(folder.path(), rng, {});
  const auto store = opened_retention_world(folder.path(), StoreAccess::read_write);
  REQUIRE(raw_sql(folder / "world.sqlite",
                  "DELETE FROM edit_log WHERE seq = 51; SELECT changes()") == "1");
  const auto folded = fold_up_to(*store, 50, {});
  REQUIRE_FALSE(folded.has_value());
  CHECK(folded.error().where == "edit_log seq=51");
  REQUIRE(store->log_range().has_value());
  CHECK(store->log_head()->version.seq < 50);
}

TEST_CASE("what reads the past says that retention removed it", "[store][retention]") {
  SplitMix64 rng(7);
  const TempFolder folder;
  make_retention_world(folder.path(), rng, {});
  const auto store = opened_retention_world(folder.path(), StoreAccess::read_write);
  REQUIRE(fold_up_to(*store, 50, {}).has_value());
  CHECK(store->stored_moment(49).error().what ==
        "begins at seq=51: the world at seq=49 was removed by retention up to seq=50 "
        "(2023-11-17T00:13:20Z), which is the earliest one left");
  CHECK(store->sequence_at(retention_time(49)).error().what ==
        "begins at seq=51: what was before that time was removed by retention up to seq=50 "
        "(2023-11-17T00:13:20Z)");
  CHECK(*store->sequence_at(retention_time(50)) == 50);
}

TEST_CASE("a preview of a rollback says which edits retention removed", "[rollback][retention]") {
  const TempFolder folder;
  SplitMix64 rng(5);
  make_retention_world(folder.path(), rng, {40});
  const auto store = opened_retention_world(folder.path(), StoreAccess::read_write);
  REQUIRE(fold_up_to(*store, 50, {}).has_value());
  const auto generator = retention_generator(*store);
  const auto removed_in = [&](const SelectionFilter& filter) {
    RollbackPreview preview;
    preview.compute(*store, *generator, filter, kRetentionEdits, {}, {});
    CHECK(preview.error.empty());
    CHECK((preview.is_empty() ? preview.text_of_nothing() : preview.text()).find(preview.removed) !=
          std::string::npos);
    return preview.removed;
  };
  SelectionFilter filter;
  CHECK(removed_in(filter).find("older edits were removed by retention up to seq=50 (") == 0);
  filter.from_us = retention_time(51);
  CHECK(removed_in(filter).empty());
}

TEST_CASE("a moment that was opened before goes on while the log is folded", "[store][retention]") {
  SplitMix64 rng(8);
  const TempFolder folder;
  make_retention_world(folder.path(), rng, {60});
  const auto store = opened_retention_world(folder.path(), StoreAccess::read_write);
  const auto generator = retention_generator(*store);
  const MomentChunks expected = moment_chunks(*store, 80);
  // Its stored moment is the keyframe, whose rows a fold up to there moves into the base.
  const auto reader = opened_retention_world(folder.path(), StoreAccess::read_only);
  auto world = WorldAt::open(*reader, *generator, 80);
  REQUIRE(world.has_value());
  REQUIRE(world->stored_at() == 60);
  // This cache has only read the log from its beginning.
  Moments moments(folder.path(), *generator);
  REQUIRE(moments.open(55).has_value());
  const MomentChunks earlier = moment_chunks(*store, 55);
  REQUIRE(fold_up_to(*store, 55, {}).has_value());
  for (const auto& [key, chunk] : expected) CHECK(*world->chunk(key) == chunk);
  for (const auto& [key, chunk] : earlier) {
    const auto made = moments.chunk(55, key);
    if (!made) FAIL(made.error().message());
    CHECK(*made == chunk);
  }
}

TEST_CASE("a retention that a power failure interrupts loses nothing and goes on",
          "[store][retention][power-loss]") {
  std::size_t partly = 0;
  for (std::uint64_t cut = 1; cut < 400; cut += 1 + cut / 3) {
    CAPTURE(cut);
    SplitMix64 rng(9);
    const TempFolder folder;
    PowerLossVfs vfs;
    const SqliteOptions options{vfs.name(), true};
    make_retention_world(folder.path(), rng, {40}, options);
    std::map<Sequence, MomentChunks> before;
    {
      auto store = opened_retention_world(folder.path(), StoreAccess::read_write, options);
      for (const Sequence at : {kCutOff, kRetentionEdits}) before[at] = moment_chunks(*store, at);
      vfs.cut_after(cut);
      static_cast<void>(fold_up_to(*store, kCutOff, {12, 8}).has_value());
    }
    vfs.power_loss(rng);
    auto store = opened_retention_world(folder.path(), StoreAccess::read_write, options);
    const Sequence head = store->log_head()->version.seq;
    if (head > 0 && head < kCutOff) ++partly;
    check_folded(*store, before);
    const auto rest = fold_up_to(*store, kCutOff, {12, 8});
    if (!rest) FAIL(rest.error().message());
    CHECK(store->log_head()->version.seq == kCutOff);
    check_folded(*store, before);
  }
  CHECK(partly > 2);
}

TEST_CASE("a retention that fills the disk ends with words, loses nothing and goes on",
          "[store][retention][power-loss]") {
  std::size_t partly = 0;
  for (std::uint64_t room = 1; room < 200; room += 1 + room / 3) {
    CAPTURE(room);
    SplitMix64 rng(10);
    const TempFolder folder;
    PowerLossVfs vfs;
    const SqliteOptions options{vfs.name(), true};
    make_retention_world(folder.path(), rng, {40}, options);
    auto store = opened_retention_world(folder.path(), StoreAccess::read_write, options);
    std::map<Sequence, MomentChunks> before;
    for (const Sequence at : {kCutOff, kRetentionEdits}) before[at] = moment_chunks(*store, at);
    vfs.full_after(room);
    const auto stopped = fold_up_to(*store, kCutOff, {12, 8});
    vfs.make_room();
    if (!stopped) CHECK(stopped.error().kind == StoreError::Kind::full);
    const Sequence head = store->log_head()->version.seq;
    if (head > 0 && head < kCutOff) ++partly;
    check_folded(*store, before);
    REQUIRE(fold_up_to(*store, kCutOff, {12, 8}).has_value());
    check_folded(*store, before);
  }
  CHECK(partly > 1);
}

TEST_CASE("space goes back to the disk in parts, and an older file gets that by a shrink",
          "[store][retention]") {
  SplitMix64 rng(11);
  const TempFolder folder;
  make_retention_world(folder.path(), rng, {20, 40, 60, 80});
  const std::string file = folder / "world.sqlite";
  const auto give_all_back = [](Store& store) {
    int parts = 1;
    for (auto more = store.give_back_space(2); *more; more = store.give_back_space(2)) ++parts;
    return parts;
  };
  {
    const auto store = opened_retention_world(folder.path(), StoreAccess::read_write);
    REQUIRE(fold_up_to(*store, 115, {}).has_value());
    REQUIRE(store->free_space()->can_be_given_back);
    REQUIRE(store->free_space()->bytes > 4 * 2'048);
    REQUIRE(store->complete_file().has_value());
    const auto bytes = std::filesystem::file_size(file);
    CHECK(give_all_back(*store) > 2);
    CHECK(store->free_space()->bytes == 0);
    REQUIRE(store->complete_file().has_value());
    CHECK(std::filesystem::file_size(file) < bytes);
    CHECK(store->check().has_value());
  }
  // The file is as a program without retention made it.
  REQUIRE(raw_sql(file, "PRAGMA auto_vacuum = NONE; VACUUM; PRAGMA auto_vacuum") == "0");
  const auto store = opened_retention_world(folder.path(), StoreAccess::read_write);
  REQUIRE(fold_up_to(*store, kRetentionEdits - 1, {}).has_value());
  CHECK_FALSE(store->free_space()->can_be_given_back);
  CHECK(give_all_back(*store) == 1);
  REQUIRE(store->shrink().has_value());
  CHECK(store->free_space()->can_be_given_back);
  CHECK(store->check().has_value());
}

TEST_CASE("the size of a part follows the time of the log writer", "[server][retention]") {
  using std::chrono::microseconds;
  const FoldSize size{256, 32};
  CHECK(next_fold_size(size, microseconds(25'000)).edits_max == 128);
  CHECK(next_fold_size(size, microseconds(25'000)).chunks_max == 16);
  CHECK(next_fold_size(size, microseconds(15'000)).edits_max == 256);
  CHECK(next_fold_size(size, microseconds(1'000)).edits_max == 320);
  CHECK(next_fold_size({128, 16}, microseconds(90'000)).edits_max == 128);
  CHECK(next_fold_size({4'096, 128}, microseconds(1)).chunks_max == 128);
}

// This case prints the sizes and the times of the parts. It takes a minute.
TEST_CASE("the size of a world after a retention of 30 of 365 days", "[.][retention-size]") {
  constexpr Sequence kAll = 100'000, kBatch = 4'096;
  constexpr TimeUs kYear = 365 * 24 * kRetentionHour;
  const TempFolder folder;
  WorldMeta meta = sample_meta();
  meta.generator.name = "flat";
  meta.chunk_edge = 32;
  const auto store = *create_sqlite_world(folder.path(), meta, {"", false});
  REQUIRE(store->raise_epoch().has_value());
  std::vector<PlayerRow> players;
  for (AuthorId author = 1; author <= 8; ++author) players.push_back(sample_player(author));
  BuilderSession session(1);
  std::vector<EditRecord> batch;
  for (Sequence seq = 1; seq <= kAll; ++seq) {
    batch.push_back(session.next());
    batch.back().time_us = kRetentionStart + static_cast<TimeUs>(seq) * (kYear / kAll);
    if (batch.size() < kBatch && seq < kAll) continue;
    REQUIRE(store->append(std::exchange(players, {}), std::exchange(batch, {})).has_value());
  }
  const auto generator = retention_generator(*store);
  KeyframeMaker keyframes(*store, *generator, {});
  REQUIRE(keyframes
              .make_due([&](const KeyframeMaker::Chunks& chunks,
                            const std::optional<Keyframe>& keyframe) {
                return store->save_keyframe(chunks, keyframe);
              })
              .has_value());
  std::vector<std::pair<ChunkKey, ChunkPtr>> snapshots;
  for (const auto& [key, chunk] : moment_chunks(*store, kAll))
    snapshots.emplace_back(key, std::make_shared<const Chunk>(chunk));
  REQUIRE(store->save_snapshots(snapshots, kAll).has_value());
  const auto file_bytes = [&] {
    REQUIRE(store->complete_file().has_value());
    return std::filesystem::file_size(folder / "world.sqlite");
  };
  const auto before = file_bytes();
  const auto plan = plan_retention(*store, 30, std::numeric_limits<TimeUs>::max());
  REQUIRE(plan.has_value());
  FoldMaker maker(*store, *generator);
  // The size of a part does not change the size of the world.
  const FoldSize size{1'024, 64};
  std::vector<std::int64_t> parts_us;
  for (;;) {
    const auto fold = maker.next(plan->cut.version.seq, size);
    REQUIRE(fold.has_value());
    if (!fold->has_value()) break;
    const auto begun = std::chrono::steady_clock::now();
    REQUIRE(store->fold_log(**fold).has_value());
    const auto taken = std::chrono::duration_cast<std::chrono::microseconds>(
        std::chrono::steady_clock::now() - begun);
    parts_us.push_back(taken.count());
  }
  for (auto more = store->give_back_space(256); *more;) more = store->give_back_space(256);
  const auto after = file_bytes();
  std::sort(parts_us.begin(), parts_us.end());
  WARN("bytes before " << before << ", after " << after << ", percent "
                       << 100.0 * static_cast<double>(after) / static_cast<double>(before)
                       << "; chunks " << snapshots.size() << "; planned bytes "
                       << plan->volume.log_bytes + plan->volume.keyframe_bytes << " less "
                       << plan->volume.base_bytes_max << "; parts " << parts_us.size()
                       << ", median us " << parts_us[parts_us.size() / 2] << ", longest us "
                       << parts_us.back());
  CHECK(store->check().has_value());
}

}  // namespace runstone::test
