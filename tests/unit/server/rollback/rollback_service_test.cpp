#include "server/rollback/rollback_service.hpp"

#include <algorithm>

#include "tests/support/edits/hostile_edits.hpp"
#include "tests/unit/server/rollback/rollback_bench.hpp"

namespace runstone::test {
namespace {

constexpr VoxelBox kHouse = {{0, 0, 0}, {8, 8, 8}};
constexpr VoxelBox kGrief = {{-20, 0, -20}, {20, 4, 20}};

SelectionFilter of_author(AuthorId author) {
  SelectionFilter filter;
  filter.authors = {author};
  return filter;
}

/// A builder makes a house. Then a griefer edits all over it.
struct Night : RollbackBench {
  Night() {
    griefer = join(kGriefer);
    builder = join(kBuilder);
    fill(kBuilder, kHouse, 2);
    before = digests();
    fill(kGriefer, kGrief, 1);
    write_log();
  }
  std::string preview_id() {
    service.preview(of_author(griefer), bench.now(), reply());
    run_all();
    REQUIRE(answer().is_ok);
    const std::string text = answer().text;
    REQUIRE(text.starts_with("preview p"));
    return text.substr(8, text.find(':') - 8);
  }
  AuthorId griefer = 0, builder = 0;
  std::vector<std::pair<ChunkKey, Digest>> before;
};

}  // namespace

TEST_CASE("a rollback restores the world, and its undo restores the edits", "[rollback]") {
  Night night;
  const auto griefed = night.digests();
  const std::string id = night.preview_id();
  CHECK(night.answer().text.find("would take back 1 edit ") != std::string::npos);
  CHECK(night.answer().text.find("6400 voxels in 16 chunks") != std::string::npos);
  CHECK(night.answer().text.find("nothing has changed yet") != std::string::npos);
  CHECK(night.digests() == griefed);
  night.service.apply(id, 0, night.reply());
  night.run_all();
  CHECK(night.answer().is_ok);
  CHECK(night.digests() == night.before);
  const EditRecord first = night.bench.environment.records[2];
  CHECK(first.cause == Cause::rollback);
  CHECK(first.op.author == 0);
  CHECK(first.op.seq == 1);
  CHECK(first.subject == 2);
  CHECK(night.bench.environment.records.back().op.instance == first.op.instance);

  SECTION("by the sequence of its first edit") {
    night.service.undo_rollback("3", 0, night.bench.now(), night.reply());
    night.run_all();
    CHECK(night.answer().is_ok);
    CHECK(night.digests() == griefed);
    const auto& records = night.bench.environment.records;
    CHECK(records.back().cause == Cause::undo);
    const auto undo = std::find_if(records.begin(), records.end(), [](const EditRecord& record) {
      return record.cause == Cause::undo;
    });
    const std::string undone_by = std::to_string(undo->version.seq);
    night.service.list(night.reply());
    night.run_all();
    CHECK(night.answer().text.find("rollback 3 ") == 0);
    CHECK(night.answer().text.find("taken back by " + undone_by) != std::string::npos);
    // The undo is a group too, and can be undone.
    night.service.undo_rollback(undone_by, 0, night.bench.now(), night.reply());
    night.run_all();
    CHECK(night.digests() == night.before);
  }
  SECTION("by the preview's id") {
    night.service.undo_rollback(id, 0, night.bench.now(), night.reply());
    night.run_all();
    CHECK(night.digests() == griefed);
  }
  SECTION("not by an edit within") {
    night.service.undo_rollback("4", 0, night.bench.now(), night.reply());
    night.run_all();
    CHECK_FALSE(night.answer().is_ok);
    CHECK(night.answer().text.find("no rollback begins there") != std::string::npos);
    CHECK(night.digests() == night.before);
  }
  SECTION("a second rollback of the same edits says that nothing is left") {
    night.service.preview(of_author(night.griefer), night.bench.now(), night.reply());
    night.run_all();
    CHECK(night.answer().text.find("nothing to do: 1 edit match, but nothing of them is left") !=
          std::string::npos);
  }
}

TEST_CASE("edits that are there again after an undo of their rollback can be taken back again",
          "[rollback]") {
  Night night;
  const auto griefed = night.digests();
  const auto listed = [&] {
    night.service.list(night.reply());
    night.run_all();
    return night.answer().text;
  };
  const auto undo = [&](const std::string& id) {
    const Sequence first = night.bench.environment.records.back().version.seq + 1;
    night.service.undo_rollback(id, 0, night.bench.now(), night.reply());
    night.run_all();
    CHECK(night.answer().is_ok);
    return std::to_string(first);
  };
  night.service.apply(night.preview_id(), 0, night.reply());
  night.run_all();
  const std::string taken_back = undo("3");
  CHECK(night.digests() == griefed);
  CHECK(listed().find(", taken back by " + taken_back) != std::string::npos);

  // The griefer's edit is there again, voxel by voxel.
  const std::string again = night.preview_id();
  CHECK(night.answer().text.find("6400 voxels in 16 chunks") != std::string::npos);
  night.service.apply(again, 0, night.reply());
  night.run_all();
  CHECK(night.digests() == night.before);
  undo(again);
  CHECK(night.digests() == griefed);

  // The undo is taken back: the rollback is in force, and can be undone once more.
  const std::string redone = undo(taken_back);
  CHECK(night.digests() == night.before);
  CHECK(listed().find("rollback 3 ") == 0);
  const std::string lines = listed();
  CHECK(lines.substr(0, lines.find('\n')).find("taken back") == std::string::npos);
  const std::string last = undo("3");
  CHECK(night.digests() == griefed);
  CHECK(listed().find(", taken back by " + last) != std::string::npos);
  undo(redone);  // nothing is left of it to take back
  CHECK(night.digests() == griefed);
}

TEST_CASE("work of others since a rollback stays theirs when the rollback is undone",
          "[rollback]") {
  Night night;
  night.service.apply(night.preview_id(), 0, night.reply());
  night.run_all();
  night.fill(kBuilder, {{10, 0, 0}, {12, 2, 2}}, 3);
  night.write_log();
  night.service.undo_rollback("3", 0, night.bench.now(), night.reply());
  night.run_all();
  CHECK(night.at({10, 0, 0}) == 3);
  CHECK(night.at({13, 0, 0}) == 1);
  night.service.apply(night.preview_id(), 0, night.reply());
  night.run_all();
  CHECK(night.at({10, 0, 0}) == 3);
  CHECK(night.at({13, 0, 0}) == kEmpty);
}

TEST_CASE("a rollback that matches no edit answers so", "[rollback]") {
  Night night;
  night.service.preview(of_author(99), night.bench.now(), night.reply());
  night.run_all();
  CHECK(night.answer().is_ok);
  CHECK(night.answer().text == "rollback preview: nothing to do: no edit matches");
  night.service.apply("p1", 0, night.reply());
  CHECK_FALSE(night.answer().is_ok);
  CHECK(night.answer().text.find("there is no preview \"p1\"") != std::string::npos);
}

TEST_CASE("a preview that takes long says how far it is, and can be cancelled", "[rollback]") {
  Night night;
  night.service.preview(of_author(night.griefer), night.bench.now(), night.reply());
  night.tick();
  CHECK(night.answers.empty());  // most previews are there at once
  for (int i = 0; i < 40; ++i) night.tick();
  REQUIRE_FALSE(night.answers.empty());
  CHECK_FALSE(night.answers.front().is_done);
  CHECK(night.answers.front().text ==
        "preview p1 is being computed: looking for the edits; `rollback cancel p1` ends it");
  SECTION("cancelled") {
    night.service.cancel("p1", night.reply());
    for (int i = 0; i < 100; ++i) night.tick();
    CHECK(night.answers.back().text == "preview p1 is forgotten");
    night.run_all();
    CHECK_FALSE(night.answer().is_ok);
    CHECK(night.answer().text.find("rollback preview: cancelled") == 0);
  }
  SECTION("done") {
    night.run_all();
    CHECK(night.answer().text.find("would take back 1 edit ") != std::string::npos);
    const std::size_t answers = night.answers.size();
    for (int i = 0; i < 100; ++i) night.tick();
    CHECK(night.answers.size() == answers);
  }
}

TEST_CASE("edits of other players during a rollback stay", "[rollback]") {
  Night night;
  const std::string id = night.preview_id();
  night.service.apply(id, 0, night.reply());
  // The builder builds in every chunk before, between and after plan and slice.
  std::set<VoxelPos> built;
  int step = 0;
  while (night.service.running() > 0 || step < 4) {
    REQUIRE(step < 400);
    const auto build = [&](int salt) {
      const VoxelPos p{-20 + (step * 7 + salt * 3) % 40, (step + salt) % 4,
                       -20 + (step * 11 + salt * 5) % 40};
      night.set(kBuilder, p, 3);
      built.insert(p);
    };
    if (step < 60) build(0);
    night.write_log();
    if (step < 60) build(1);
    while (night.work()) {
    }
    if (step < 60) build(2);
    night.tick();
    ++step;
  }
  night.run_all();
  CHECK(night.answer().is_ok);
  for (int z = -20; z < 20; ++z) {
    for (int y = 0; y < 4; ++y) {
      for (int x = -20; x < 20; ++x) {
        const VoxelPos p{x, y, z};
        const Material house = kHouse.contains(p) ? Material{2} : kEmpty;
        const Material expected = built.contains(p) ? Material{3} : house;
        CAPTURE(x, y, z);
        if (night.at(p) != expected) REQUIRE(night.at(p) == expected);
      }
    }
  }
}

TEST_CASE("a chunk that changes before every slice is restored by masked edits", "[rollback]") {
  Night night;
  const std::string id = night.preview_id();
  night.service.apply(id, 0, night.reply());
  int blinks = 0;
  while (night.service.running() > 0) {
    REQUIRE(++blinks < 200);
    night.write_log();
    while (night.work()) {
    }
    // One voxel of every chunk changes again and again, so that no plan ever fits.
    for (int x = -20; x < 20; x += 13) {
      for (int z = -20; z < 20; z += 13)
        night.set(kBuilder, {x, 0, z}, static_cast<Material>(3 + blinks % 2));
    }
    night.tick();
  }
  CHECK(night.answer().is_ok);
  CHECK(night.at({1, 1, 1}) == 2);
  CHECK(night.at({-3, 2, 5}) == kEmpty);
  CHECK(night.at({-20, 0, -20}) >= 3);
  bool is_masked = false;
  for (const EditRecord& record : night.bench.environment.records) {
    is_masked |=
        record.cause == Cause::rollback && record.edit.mask == Mask{MaskKind::only_material, 1};
  }
  CHECK(is_masked);
}

TEST_CASE("a rollback waits while the log is full, and fails if it cannot be written",
          "[rollback]") {
  Night night;
  const std::string id = night.preview_id();
  const std::size_t ordered = night.bench.environment.records.size();
  night.bench.environment.log_room = false;
  night.service.apply(id, 0, night.reply());
  for (int i = 0; i < 20; ++i) {
    night.tick();
    while (night.work()) {
    }
  }
  CHECK(night.bench.environment.records.size() == ordered);
  CHECK(night.service.running() == 1);
  SECTION("room again") {
    night.bench.environment.log_room = true;
    night.run_all();
    CHECK(night.answer().is_ok);
    CHECK(night.digests() == night.before);
  }
  SECTION("the disk fails") {
    night.bench.server.log_failed();
    night.tick();
    CHECK_FALSE(night.answer().is_ok);
    CHECK(night.answer().text.find("failed after 0 of 16 chunks") != std::string::npos);
    CHECK(night.answer().text.find("its log cannot be written") != std::string::npos);
    CHECK(night.service.running() == 0);
    night.service.undo(night.builder, night.bench.now(), night.reply());
    CHECK_FALSE(night.answer().is_ok);
  }
  SECTION("cancelled") {
    night.service.cancel(id, night.reply());
    night.tick();
    CHECK_FALSE(night.answer().is_ok);
    CHECK(night.answer().text.find("was cancelled after 0 of 16 chunks") != std::string::npos);
  }
}

TEST_CASE(
    "a disk that fails while a worker plans ends the rollback, and the worker's answer is dropped",
    "[rollback]") {
  Night night;
  const std::string id = night.preview_id();
  night.service.apply(id, 0, night.reply());
  night.tick();
  REQUIRE_FALSE(night.works.empty());
  night.bench.server.log_failed();
  night.tick();
  CHECK_FALSE(night.answer().is_ok);
  while (night.work()) {
  }
  night.tick();
  CHECK(night.service.running() == 0);
  CHECK(night.works.empty());
}

TEST_CASE("a rollback that is cancelled midway can be undone", "[rollback]") {
  Night night;
  const auto griefed = night.digests();
  night.fill(kGriefer, {{-60, -9, -60}, {60, 1, 60}}, 1);
  night.write_log();
  const std::string id = night.preview_id();
  // The rollback has more edits than the log has room for.
  night.bench.environment.log_records_max = 3;
  night.service.apply(id, 0, night.reply());
  night.tick();
  while (night.work()) {
  }
  night.tick();
  CHECK(night.bench.environment.records.size() == 6);
  night.service.cancel(id, night.reply());
  night.run_all();
  CHECK_FALSE(night.answer().is_ok);
  const std::string text = night.answer().text;
  CHECK(text.find("was cancelled after ") != std::string::npos);
  CHECK(text.find("after 128 of") == std::string::npos);
  CHECK(text.find(" of 128 chunks; `rollback undo 4` takes it back") != std::string::npos);
  night.service.undo_rollback(id, 0, night.bench.now(), night.reply());
  night.run_all();
  CHECK(night.answer().is_ok);
  CHECK(night.at({-19, 3, -19}) == 1);
  CHECK(night.at({-59, 0, 1}) == 1);
}

TEST_CASE("players undo and redo their own edits, and nobody else's", "[rollback][undo]") {
  RollbackBench bench;
  const AuthorId ana = bench.join(kBuilder);
  const AuthorId ben = bench.join(kGriefer);
  const auto undo = [&](AuthorId who) {
    bench.service.undo(who, bench.bench.now(), bench.reply());
    bench.run_all();
    return bench.answer().is_ok;
  };
  const auto redo = [&](AuthorId who) {
    bench.service.redo(who, bench.bench.now(), bench.reply());
    bench.run_all();
    return bench.answer().is_ok;
  };
  CHECK_FALSE(undo(ana));
  CHECK(bench.answer().text == "nothing to undo");
  bench.fill(kBuilder, {{0, 0, 0}, {4, 4, 4}}, 1);
  bench.fill(kBuilder, {{2, 0, 0}, {6, 4, 4}}, 2);  // overlaps
  bench.set(kGriefer, {5, 0, 0}, 3);                // over ana's second edit
  CHECK(undo(ana));
  CHECK(bench.answer().text == "undo: 63 voxels in 1 chunk");
  CHECK(bench.at({3, 1, 1}) == 1);
  CHECK(bench.at({4, 1, 1}) == kEmpty);
  CHECK(bench.at({5, 0, 0}) == 3);
  CHECK(bench.bench.environment.records.back().op.author == ana);
  CHECK(bench.bench.environment.records.back().subject == 2);
  CHECK(undo(ana));
  CHECK(bench.at({0, 0, 0}) == kEmpty);
  CHECK(bench.at({5, 0, 0}) == 3);
  CHECK_FALSE(undo(ana));
  CHECK(redo(ana));
  CHECK(bench.at({0, 0, 0}) == 1);
  CHECK(bench.at({3, 1, 1}) == 1);
  CHECK(redo(ana));
  CHECK(bench.at({3, 1, 1}) == 2);
  CHECK(bench.at({5, 0, 0}) == 3);
  CHECK_FALSE(redo(ana));
  CHECK(undo(ben));
  CHECK(bench.at({5, 0, 0}) == 2);  // as it was before ben's edit
  CHECK(undo(ana));
  bench.set(kBuilder, {9, 9, 9}, 4);
  CHECK_FALSE(redo(ana));  // there is a newer edit
  CHECK(bench.answer().text == "nothing to redo");
}

TEST_CASE("an action of several edits is undone and redone as one", "[rollback][undo]") {
  RollbackBench bench;
  const AuthorId ana = bench.join(kBuilder);
  bench.join(kGriefer);
  const auto run = [&](Cause cause) {
    if (cause == Cause::undo) bench.service.undo(ana, bench.bench.now(), bench.reply());
    if (cause == Cause::redo) bench.service.redo(ana, bench.bench.now(), bench.reply());
    bench.run_all();
    return bench.answer().is_ok;
  };
  bench.set(kBuilder, {9, 9, 9}, 4);
  // A move: the wall is cleared, and set again in another chunk. Its two places overlap nowhere.
  bench.fill(kBuilder, {{0, 0, 0}, {2, 2, 2}}, 1);
  bench.edit_as_one(kBuilder, {{FillBox{{{0, 0, 0}, {2, 2, 2}}}, {}, kEmpty},
                               {FillBox{{{20, 0, 0}, {22, 2, 2}}}, {}, 1},
                               {FillBox{{{1, 0, 0}, {3, 1, 1}}}, {}, 3}});
  bench.set(kGriefer, {20, 0, 0}, 2);
  CHECK(run(Cause::undo));
  CHECK(bench.at({0, 0, 0}) == 1);
  CHECK(bench.at({1, 0, 0}) == 1);
  CHECK(bench.at({2, 0, 0}) == kEmpty);
  CHECK(bench.at({21, 0, 0}) == kEmpty);
  CHECK(bench.at({20, 0, 0}) == 2);  // of another player
  for (const EditRecord& record : bench.bench.environment.records) {
    if (record.cause == Cause::undo) CHECK(record.subject == 3);
  }
  CHECK(run(Cause::redo));
  CHECK(bench.at({0, 0, 0}) == kEmpty);
  CHECK(bench.at({1, 0, 0}) == 3);
  CHECK(bench.at({21, 0, 0}) == 1);
  CHECK_FALSE(run(Cause::redo));
  CHECK(run(Cause::undo));
  CHECK(run(Cause::undo));  // the wall
  CHECK(bench.at({0, 0, 0}) == kEmpty);
  CHECK(bench.at({9, 9, 9}) == 4);
  CHECK(run(Cause::undo));
  CHECK(bench.at({9, 9, 9}) == kEmpty);
  CHECK_FALSE(run(Cause::undo));
}

TEST_CASE("the slices of an undo leave time for others, if there are others", "[rollback][undo]") {
  RollbackBench bench;
  const AuthorId ana = bench.join(kBuilder);
  const bool is_alone = GENERATE(true, false);
  CAPTURE(is_alone);
  if (!is_alone) bench.join(kGriefer);
  constexpr std::int32_t kChunks = 10, kSide = kChunks * kEdge;
  std::vector<EditDescriptor> fills;
  for (std::int32_t z = 0; z < kSide; z += 2 * kEdge)
    fills.push_back({FillBox{{{0, 0, z}, {kSide, kSide, z + 2 * kEdge}}}, {}, 1});
  bench.edit_as_one(kBuilder, fills);
  bench.write_log();
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  while (bench.work()) bench.service.tick(bench.bench.now());  // no time passes
  std::size_t undone = 0;
  for (const EditRecord& record : bench.bench.environment.records) {
    if (record.cause == Cause::undo)
      undone += volume_of(std::get<FillBox>(record.edit.shape).box) / (kEdge * kEdge * kEdge);
  }
  if (is_alone) {
    CHECK(undone == kChunks * kChunks * kChunks);
  } else {
    CHECK(undone > 0);
    CHECK(undone < kChunks * kChunks * kChunks);
  }
  bench.run_all();
  CHECK(bench.answer().is_ok);
  CHECK(bench.digests().empty());
}

TEST_CASE("an undo skips an edit that others have built over entirely", "[rollback][undo]") {
  RollbackBench bench;
  const AuthorId ana = bench.join(kBuilder);
  bench.join(kGriefer);
  bench.set(kBuilder, {1, 1, 1}, 1);
  bench.set(kBuilder, {2, 2, 2}, 1);
  bench.set(kGriefer, {2, 2, 2}, 2);
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  bench.run_all();
  CHECK(bench.answer().is_ok);
  CHECK(bench.at({1, 1, 1}) == kEmpty);
  CHECK(bench.at({2, 2, 2}) == 2);
}

TEST_CASE("a player has one undo at a time, and it waits until the edit is on disk",
          "[rollback][undo]") {
  RollbackBench bench;
  const AuthorId ana = bench.join(kBuilder);
  bench.set(kBuilder, {1, 1, 1}, 1);
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  bench.tick();
  CHECK(bench.works.empty());  // the edit is not durable yet
  bench.write_log();
  bench.tick();
  CHECK(bench.works.size() == 1);
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  CHECK_FALSE(bench.answer().is_ok);
  CHECK(bench.answer().text == "undo: one of yours is still under way");
  bench.run_all();
  CHECK(bench.answer().is_ok);
  CHECK(bench.at({1, 1, 1}) == kEmpty);
}

TEST_CASE("an undo waits for the edits of the player that wait, and takes back the newest of them",
          "[rollback][undo]") {
  WorldConfig without_budget = config();
  without_budget.edit_budget = {};
  RollbackBench bench(without_budget);
  const AuthorId ana = bench.join(kBuilder);
  bench.set(kBuilder, {1, 1, 1}, 1);
  for (ClientSequence seq = 2; seq <= 100; ++seq)
    bench.bench.edit(kBuilder, seq, Paste{{0, 0, 0}, long_clipboard(), {}}, kEmpty);
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  REQUIRE(bench.bench.server.order().has_waiting_edit(ana));
  bench.write_log();
  bench.tick();
  CHECK(bench.answers.empty());
  CHECK(bench.works.empty());
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  CHECK(bench.answer().text == "undo: one of yours is still under way");
  while (bench.bench.server.order().has_waiting_edit(ana)) bench.tick();
  CHECK(bench.works.empty());
  bench.write_log();
  bench.tick();
  CHECK(bench.works.size() == 1);
  CHECK_FALSE(bench.service.is_idle());
}

TEST_CASE("an undo ends an action under way, and takes back all of it", "[rollback][undo]") {
  RollbackBench bench;
  const AuthorId ana = bench.bench.join(kBuilder, kBuilder, 1, {}, kFeatureLargeActions).author;
  bench.bench.view(kBuilder, View{1, {0, 0, 0}, 4, 1});
  const auto send = [&](ClientSequence seq) {
    EditRequest request{
        seq, 0, {SetVoxel{{static_cast<std::int32_t>(seq) % 64 - 32, 1, 1}}, {}, 1}};
    request.action = 1;
    request.is_optional = true;
    bench.bench.server.received(kBuilder, request, bench.bench.now());
    bench.bench.server.commit(bench.bench.now());
    bench.bench.answer_loads();
  };
  ClientSequence seq = 0;
  while (seq < 300) send(++seq);
  bench.write_log();
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  REQUIRE(bench.works.size() == 1);
  while (seq < 310) send(++seq);  // after the search has begun
  REQUIRE(bench.work());
  while (seq < 320) send(++seq);  // after the action has ended
  const auto rejects = bench.bench.environment.messages<Reject>(kBuilder, kEdge);
  REQUIRE(rejects.size() == 10);
  CHECK(rejects[0].client_seq == 311);
  CHECK(rejects[0].reason == RejectReason::action_ended);
  bench.run_all();
  CHECK(bench.answer().is_ok);
  CHECK(bench.digests().empty());
  bench.service.redo(ana, bench.bench.now(), bench.reply());
  bench.run_all();
  CHECK(bench.answer().is_ok);
  for (ClientSequence i = 247; i <= 310; ++i)
    CHECK(bench.at({static_cast<std::int32_t>(i) % 64 - 32, 1, 1}) == 1);
}

TEST_CASE("a rollback continues if the log has room for fewer edits than a slice", "[rollback]") {
  Night night;
  const std::string id = night.preview_id();
  night.bench.environment.log_records_max = 3;
  night.service.apply(id, 0, night.reply());
  night.run_all();
  CHECK(night.answer().is_ok);
  CHECK(night.digests() == night.before);
}

TEST_CASE("undo and redo are paid from the player's edit budget, and report when they wait for it",
          "[rollback][undo]") {
  WorldConfig slow = config();
  slow.edit_budget = {4, 20};
  RollbackBench bench(slow);
  const AuthorId ana = bench.join(kBuilder);
  bench.join(kGriefer);
  // 16 chunks cost a unit each, also those of the four fills that take them back.
  bench.fill(kBuilder, kGrief, 1);
  bench.write_log();
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  bench.tick();
  while (bench.work()) bench.tick();
  while (bench.work()) bench.tick();
  const std::size_t written = bench.bench.environment.records.size();
  CHECK(written > 1);
  CHECK(written < 17);
  CHECK(bench.answers.back().text ==
        "undo waits: the player's edit budget is used up (builder_budget)");
  CHECK_FALSE(bench.answers.back().is_done);
  bench.set(kBuilder, {0, 9, 0}, 1);
  CHECK(bench.bench.environment.messages<Reject>(kBuilder, kEdge).back().reason ==
        RejectReason::rate_limited);
  bench.set(kGriefer, {0, 9, 0}, 1);
  CHECK(bench.bench.environment.messages<Reject>(kGriefer, kEdge).empty());
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  CHECK(bench.answers.back().text.find(
            "one of yours is still under way, and waits: the player's edit budget") !=
        std::string::npos);
  bench.service.list(bench.reply());
  bench.work();
  CHECK(bench.answers.back().text.find("(waits: the player's edit budget is used up") !=
        std::string::npos);
  const TimeUs began = bench.bench.time_us;
  bench.run_all();
  CHECK(bench.answer().text == "undo: 6400 voxels in 16 chunks");
  const auto answers_with = [&](const std::string& begin) {
    return std::count_if(bench.answers.begin(), bench.answers.end(),
                         [&](const CommandAnswer& a) { return a.text.starts_with(begin); });
  };
  CHECK(answers_with("undo waits") == 1);   // it reports once that it waits
  CHECK(answers_with("undo is at ") >= 1);  // and every two seconds how far it is
  CHECK(bench.bench.time_us - began >= 1'500'000);
  CHECK(bench.at({-1, 0, 0}) == kEmpty);
}

TEST_CASE("a rollback is paid by nobody", "[rollback]") {
  WorldConfig slow = config();
  slow.edit_budget = {1, 17};  // a fill of 16 chunks, and one more edit
  RollbackBench bench(slow);
  const AuthorId ana = bench.join(kBuilder);
  bench.fill(kBuilder, kGrief, 1);
  bench.write_log();
  bench.service.preview(of_author(ana), bench.bench.now(), bench.reply());
  bench.run_all();
  bench.service.apply("p1", ana, bench.reply());
  const TimeUs began = bench.bench.time_us;
  bench.run_all();
  CHECK(bench.answer().is_ok);
  CHECK(bench.bench.time_us - began < 1'000'000);
  bench.set(kBuilder, {0, 9, 0}, 1);
  CHECK(bench.bench.environment.messages<Reject>(kBuilder, kEdge).empty());
}

TEST_CASE("the undos of one run share one client instance for each author, and are no rollbacks",
          "[rollback][undo]") {
  RollbackBench bench;
  const AuthorId ana = bench.join(kBuilder);
  const AuthorId ben = bench.join(kGriefer);
  for (int i = 0; i < 3; ++i) bench.set(kBuilder, {i, 0, 0}, 1);
  bench.set(kGriefer, {0, 5, 0}, 1);
  const auto last = [&] { return bench.bench.environment.records.back(); };
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  bench.run_all();
  const EditRecord first = last();
  CHECK(first.op.seq == 2);
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  bench.run_all();
  CHECK(last().op == OperationId{ana, first.op.instance, 3});
  bench.service.redo(ana, bench.bench.now(), bench.reply());
  bench.run_all();
  CHECK(last().op == OperationId{ana, first.op.instance, 4});
  bench.service.undo(ben, bench.bench.now(), bench.reply());
  bench.run_all();
  CHECK(last().op == OperationId{ben, first.op.instance, 2});

  bench.service.undo_rollback(std::to_string(first.version.seq), 0, bench.bench.now(),
                              bench.reply());
  bench.run_all();
  CHECK_FALSE(bench.answer().is_ok);
  CHECK(bench.answer().text.find("no rollback begins there") != std::string::npos);

  // A client of the same player with the same instance only raises the sequence numbers.
  bench.bench.join(9, static_cast<std::uint8_t>(kBuilder), first.op.instance);
  bench.bench.edit(9, 1000, SetVoxel{{9, 9, 9}});
  bench.service.undo(ana, bench.bench.now(), bench.reply());
  bench.run_all();
  CHECK(bench.answer().is_ok);
  CHECK(last().op == OperationId{ana, first.op.instance, 1001});
}

}  // namespace runstone::test
