#include "server/rollback/player_action_search.hpp"

#include "server/rollback/chunk_logs.hpp"
#include "tests/unit/server/rollback/rollback_bench.hpp"

namespace runstone::test {
namespace {

/// Ana sets voxels in one chunk. Another player builds over all but the first.
struct BuiltOver : RollbackBench {
  explicit BuiltOver(int edits) {
    ana = join(kBuilder);
    join(kGriefer);
    for (int i = 0; i < edits; ++i) set(kBuilder, {i % 16, i / 16, 0}, 1);
    for (int i = 1; i < edits; ++i) set(kGriefer, {i % 16, i / 16, 0}, 2);
    write_log();
  }
  AuthorId ana = 0;
};

constexpr std::size_t kCalls = 16 + 16 + 31 + 16;

}  // namespace

TEST_CASE("an undo skips sixteen edits with nothing left, and reports if there are more",
          "[rollback][undo]") {
  const int passed = GENERATE(15, 16, 17, 40);
  CAPTURE(passed);
  BuiltOver bench(1 + passed);
  bench.service.undo(bench.ana, bench.bench.now(), bench.reply());
  bench.run_all();
  CHECK(bench.answer().is_ok == (passed < 16));
  CHECK(bench.at({0, 0, 0}) == (passed < 16 ? kEmpty : Material{1}));
  if (passed >= 16) {
    CHECK(bench.answer().text.starts_with("undo: nothing is left of the 16 edits that are next"));
  }
}

TEST_CASE("an undo reads the log of a chunk once for all actions that it considers",
          "[rollback][undo]") {
  BuiltOver bench(16);
  std::size_t calls = 0;
  const auto found =
      next_player_change(*bench.store, *bench.generator, bench.ana, Cause::undo,
                         bench.bench.server.order().durable(), 1, [&] { return ++calls > 0; });
  REQUIRE(found.has_value());
  REQUIRE(found->change.has_value());
  CHECK(found->change->action == 1);
  // should_continue is called for 16 rows of the player, for the edit of each of 16 actions, for 31
  // edits of the chunk, and once for each of 16 plans.
  CHECK(calls == kCalls);
}

TEST_CASE("a cancelled undo ends at once", "[rollback][undo]") {
  BuiltOver bench(16);
  for (std::size_t allowed = 0; allowed < kCalls; ++allowed) {
    std::size_t calls = 0;
    const auto found = next_player_change(*bench.store, *bench.generator, bench.ana, Cause::undo,
                                          bench.bench.server.order().durable(), 1,
                                          [&] { return ++calls <= allowed; });
    REQUIRE_FALSE(found.has_value());
    CHECK(found.error().kind == StoreError::Kind::cancelled);
    CHECK(calls == allowed + 1);
  }
}

TEST_CASE("a stop ends the reading of undos and jobs", "[rollback][undo]") {
  BuiltOver bench(2);
  bench.service.undo(bench.ana, bench.bench.now(), bench.reply());
  SECTION("while it searches for the next action") {
    bench.service.stop();
    REQUIRE(bench.work());
    CHECK(bench.answer().text == "undo: not now: the server stops");
    CHECK(bench.service.running() == 0);
  }
  SECTION("while its chunks are planned") {
    REQUIRE(bench.work());
    bench.tick();
    REQUIRE(bench.works.size() == 1);
    bench.service.stop();
    bench.run_all();
    CHECK_FALSE(bench.answer().is_ok);
    CHECK(bench.answer().text.find("cancelled") != std::string::npos);
    CHECK(bench.at({0, 0, 0}) == 1);
  }
}

TEST_CASE("the log of a chunk is the same read once, in parts, or each time", "[rollback]") {
  BuiltOver bench(12);
  const ChunkKey key{0, {0, 0, 0}};
  std::size_t read = 0, read_to_keep = 0;
  const auto count = [&] { return ++read > 0; };
  const auto visited = [&](ChunkLogs& logs, Sequence first, Sequence last) {
    std::vector<Sequence> out;
    const auto done =
        logs.visit(key, first, last, [&](const EditRecord& r) { out.push_back(r.version.seq); });
    REQUIRE(done.has_value());
    return out;
  };
  ChunkLogs each(*bench.store, count);
  ChunkLogs kept(*bench.store, count, 1 << 20);
  ChunkLogs tight(*bench.store, count, 5 * sizeof(EditRecord));
  const std::vector<std::pair<Sequence, Sequence>> ranges = {{8, 12}, {10, 9},  {10, 11}, {3, 4},
                                                             {1, 23}, {20, 23}, {2, 2}};
  for (const auto& [first, last] : ranges) {
    CAPTURE(first, last);
    std::vector<Sequence> expected;
    for (Sequence seq = first; seq <= last; ++seq) expected.push_back(seq);
    CHECK(visited(each, first, last) == expected);
    CHECK(visited(tight, first, last) == expected);
    const std::size_t before = read;
    CHECK(visited(kept, first, last) == expected);
    read_to_keep += read - before;
  }
  CHECK(read_to_keep == 23);
}

namespace {

/// A world whose log the test writes, with one player.
struct WrittenLog {
  static constexpr AuthorId kAna = 1, kBob = 2;

  WrittenLog() {
    REQUIRE(create_world(folder.path(), sample_meta()).has_value());
    store = *open_world(folder.path(), StoreAccess::read_write);
    epoch = *store->raise_epoch();
    GeneratorPin pin;
    pin.name = "empty";
    generator = *make_generator(pin, sample_meta().materials);
  }
  Sequence add(AuthorId author, VoxelPos at, Material material, Sequence subject = 0,
               Cause cause = Cause::player) {
    EditRecord record;
    record.version = {epoch, ++last};
    record.op = {author, 7, last};
    record.time_us = static_cast<TimeUs>(last);
    record.cause = cause;
    record.edit = {SetVoxel{at}, {}, material};
    record.subject = subject;
    records.push_back(record);
    return last;
  }
  void write() {
    const std::vector<PlayerRow> players = {sample_player(kAna), sample_player(kBob)};
    REQUIRE(store->append(players, records).has_value());
    records.clear();
  }
  PlayerActionSearch find(Cause cause) {
    auto found = next_player_change(*store, *generator, kAna, cause, last, epoch);
    REQUIRE(found.has_value());
    return *std::move(found);
  }
  TempFolder folder;
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;
  Epoch epoch = 0;
  Sequence last = 0;
  std::vector<EditRecord> records;
};

}  // namespace

TEST_CASE("an action of 40,000 edits is found whole, with clicks and others between its edits",
          "[rollback][undo]") {
  WrittenLog log;
  const Sequence first = log.add(log.kAna, {0, 0, 0}, 1);
  Sequence newest = first;
  for (std::int32_t i = 1; i < 40'000; ++i) {
    if (i % 4'000 == 0) {  // nine clicks, which begin later than the action; others build over them
      log.add(log.kAna, {i / 4'000, 100, 0}, 2);
      log.add(log.kBob, {i / 4'000, 100, 0}, 3);
    }
    newest = log.add(log.kAna, {i % 64, i / 64 % 64, i / 4096}, 1, first);
  }
  log.write();
  const auto found = log.find(Cause::undo).change;
  REQUIRE(found.has_value());
  CHECK(found->action == first);
  CHECK(found->selection.edits == 40'000);
  CHECK(found->selection.first == first);
  CHECK(found->selection.last == newest);
  CHECK(found->selection.chunks.size() == 4 * 4);
}

TEST_CASE("an undo that ended with its server is finished by the next undo, and a redo by a redo",
          "[rollback][undo]") {
  WrittenLog log;
  const Sequence before = log.add(log.kAna, {0, 50, 0}, 1);
  const Sequence action = log.add(log.kAna, {0, 0, 0}, 1);
  log.add(log.kAna, {20, 0, 0}, 1, action);  // another chunk
  log.add(log.kAna, {0, 0, 0}, kEmpty, action, Cause::undo);
  log.write();
  CHECK(log.find(Cause::undo).change->action == before);  // this server has not ended
  log.epoch = *log.store->raise_epoch();
  const auto undo = log.find(Cause::undo).change;
  REQUIRE(undo.has_value());
  CHECK(undo->action == action);

  log.add(log.kAna, {20, 0, 0}, kEmpty, action, Cause::undo);
  log.write();
  log.epoch = *log.store->raise_epoch();
  CHECK(log.find(Cause::undo).change->action == before);  // it is complete
  REQUIRE(log.find(Cause::redo).change.has_value());

  log.add(log.kAna, {0, 0, 0}, 1, action, Cause::redo);
  log.write();
  CHECK_FALSE(log.find(Cause::redo).change.has_value());
  log.epoch = *log.store->raise_epoch();
  const auto redo = log.find(Cause::redo).change;
  REQUIRE(redo.has_value());
  CHECK(redo->action == action);
  CHECK(log.find(Cause::undo).change->action == action);
}

}  // namespace runstone::test
