// A world's log, exported to an .rlog file and imported again: by the program, and with damaged
// files.
#include "server/replay/rlog_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "server/replay/replay_program.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/rlog/rlog_bytes.hpp"
#include "tests/support/sql/crash_image.hpp"
#include "tests/support/store/compact_by_hand.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// Returns the line with the world's digest from the table that verify prints.
std::string digest_of_world(const std::string& folder) {
  const ReplayOutcome replay = run_replay({"verify", "--world", folder});
  INFO(replay.out << replay.err);
  REQUIRE(replay.code == 0);
  const std::size_t at = replay.out.find("digest ");
  return replay.out.substr(at, replay.out.find('\n', at) - at);
}

std::unique_ptr<Store> opened(const std::string& folder,
                              StoreAccess access = StoreAccess::read_only) {
  auto store = open_world(folder, access);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

/// Makes a world of generated terrain with two epochs of `count` edits each.
void make_logged_world(const std::string& folder, std::size_t count) {
  WorldMeta meta = sample_meta();
  meta.generator = {"terrain", 1, 77, ""};
  auto store = *create_world(folder, meta);
  SplitMix64 rng(count);
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->append(players, sample_records(rng, 1, 1, count)).has_value());
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->append({}, sample_records(rng, 2, count + 1, count)).has_value());
}

std::vector<EditRecord> log_of(const std::string& folder) {
  std::vector<EditRecord> records;
  auto store = opened(folder);
  REQUIRE(store
              ->read_log(1, kSequenceMax,
                         [&](const EditRecord& record) {
                           records.push_back(record);
                           return true;
                         })
              .has_value());
  return records;
}

Bytes bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::string& file, const Bytes& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

void export_small_blocks(const std::string& folder, const std::string& file) {
  auto store = opened(folder);
  REQUIRE(export_rlog(*store, file, kSequenceMax, {3, 16}).has_value());
}

}  // namespace

TEST_CASE("a world made from the exported log of a corrected world gives each time the same moment",
          "[store][rlog][clock]") {
  const TempFolder folder;
  const std::string world = folder / "world", copy = folder / "copy", file = folder / "log.rlog";
  constexpr TimeUs kStep = 60'000'000;
  constexpr TimeUs kAhead = TimeUs{730} * 86'400'000'000;
  SplitMix64 rng(3);
  auto records = sample_records(rng, 1, 1, 40);
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].time_us = static_cast<TimeUs>(1'000'000 + i) * kStep;
    if (i >= 10 && i < 20) records[i].time_us += kAhead;
    if (i >= 21) records[i].time_us -= 5 * kStep;
  }
  // Two corrections in a row.
  for (const auto& [i, step_us] : {std::pair<std::size_t, TimeUs>{20, -kAhead}, {21, -5 * kStep}}) {
    records[i].cause = Cause::rights;
    records[i].subject = 0;
    records[i].edit = rights_edit(CorrectTime{step_us, 11});
  }
  {
    auto store = *create_world(world, sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append({}, records).has_value());
  }
  export_small_blocks(world, file);
  std::ostringstream out;
  const auto imported = import_rlog({copy, file}, out);
  if (!imported) FAIL(imported.error());
  CHECK(imported->stopped.empty());
  CHECK(log_of(copy) == records);
  auto a = opened(world), b = opened(copy);
  for (const EditRecord& record : records) {
    for (const TimeUs near_us : {TimeUs{-1}, TimeUs{0}}) {
      const TimeUs time_us = record.time_us + near_us;
      CAPTURE(record.version.seq, near_us);
      Sequence newest = 0;
      for (const EditRecord& other : records)
        if (other.time_us <= time_us) newest = other.version.seq;
      CHECK(*a->sequence_at(time_us) == newest);
      CHECK(*b->sequence_at(time_us) == newest);
    }
  }
  CHECK(b->check().has_value());
}

TEST_CASE("a world made from its exported log is the same world", "[store][rlog]") {
  const TempFolder folder;
  const std::string world = folder / "world", copy = folder / "copy", file = folder / "log.rlog";
  make_logged_world(world, 60);
  const ReplayOutcome written = run_replay({"export", file, "--world", world});
  INFO(written.out << written.err);
  REQUIRE(written.code == 0);
  CHECK(written.out.find("edits       120, sequences 1 to 120") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(file + ".exporting"));

  const ReplayOutcome made = run_replay({"import", file, "--world", copy});
  INFO(made.out << made.err);
  REQUIRE(made.code == 0);
  CHECK(made.out.find("edits       120 added, 0 known, 0 compacted") != std::string::npos);
  CHECK(log_of(copy) == log_of(world));
  CHECK(digest_of_world(copy) == digest_of_world(world));
  auto a = opened(world), b = opened(copy);
  CHECK(a->meta().world_id == b->meta().world_id);
  CHECK(a->meta().server_key_seed !=
        b->meta().server_key_seed);  // the file does not hold the secret key
  CHECK(a->epoch() == b->epoch());
  CHECK(*a->log_range() == *b->log_range());
  const auto players = *b->players();
  REQUIRE(players.size() == 2);
  CHECK((players[1].key == sample_player(2).key && players[1].name == "builder 2"));
  const auto marks = *a->high_waters(), marks_again = *b->high_waters();
  REQUIRE(marks.size() == marks_again.size());
  for (std::size_t i = 0; i < marks.size(); ++i)
    CHECK(marks[i].resolved == marks_again[i].resolved);
  b.reset();

  const ReplayOutcome again = run_replay({"import", file, "--world", copy});
  CHECK(again.code == 0);
  CHECK(again.out.find("edits       0 added, 120 known, 0 compacted") != std::string::npos);
  const std::string second = folder / "second.rlog";
  REQUIRE(run_replay({"export", second, "--world", copy}).code == 0);
  CHECK(bytes_of(second) == bytes_of(file));
}

TEST_CASE("a log exported up to a sequence gives the world of that moment, and the rest can follow",
          "[store][rlog]") {
  const TempFolder folder;
  const std::string world = folder / "world", copy = folder / "copy", file = folder / "log.rlog";
  make_logged_world(world, 40);
  REQUIRE(run_replay({"export", file, "--world", world, "--at", "30"}).code == 0);
  REQUIRE(run_replay({"import", file, "--world", copy}).code == 0);
  CHECK(log_of(copy).size() == 30);
  CHECK(opened(copy)->epoch() == 1);
  REQUIRE(run_replay({"export", file, "--world", world}).code == 0);
  const ReplayOutcome rest = run_replay({"import", file, "--world", copy});
  CHECK(rest.out.find("edits       50 added, 30 known") != std::string::npos);
  CHECK(digest_of_world(copy) == digest_of_world(world));
}

TEST_CASE(
    "an import stops at the first bad block and names it, and the edits before it are in the world",
    "[store][rlog]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "log.rlog";
  make_logged_world(world, 40);
  export_small_blocks(world, file);
  const Bytes sound = bytes_of(file);
  const auto begins = blocks_of(sound);  // world, players, five times 16 edits, end
  REQUIRE(begins.size() == 9);
  const auto log = log_of(world);
  struct Damage {
    const char* what;
    std::function<void(Bytes&)> make;
    std::size_t edits, block;
  };
  const std::vector<Damage> damages = {
      {"checksum of the block is wrong",
       [&](Bytes& b) { b[begins[4] + kRlogHeaderBytes + 3] ^= 8; }, 32, 4},
      {"checksum of the block header is wrong", [&](Bytes& b) { b[begins[5] + 20] ^= 1; }, 48, 5},
      {"file ends inside a block", [&](Bytes& b) { b.resize(begins[4] - 5); }, 16, 3},
      {"file ends inside a block header", [&](Bytes& b) { b.resize(begins[6] + 9); }, 64, 6},
      {"file ends without its end block", [&](Bytes& b) { b.resize(begins[7]); }, 80, 7},
      {"checksum of the block header is wrong",
       [&](Bytes& b) {
         b.erase(b.begin() + static_cast<std::ptrdiff_t>(begins[3]),
                 b.begin() + static_cast<std::ptrdiff_t>(begins[4]));
       },
       16, 3},
  };
  for (std::size_t i = 0; i < damages.size(); ++i) {
    const Damage& damage = damages[i];
    const std::string copy = folder / ("copy" + std::to_string(i)), torn = folder / "torn.rlog";
    Bytes bytes = sound;
    damage.make(bytes);
    write_bytes(torn, bytes);
    const std::string what = "runstone-replay: " + torn + ": edit " +
                             std::to_string(damage.edits + 1) + " at byte " +
                             std::to_string(begins[damage.block]) + ": " + damage.what;
    // A new world that lacks edits looks finished, so it is made on request only.
    const ReplayOutcome refused = run_replay({"import", torn, "--world", copy});
    CAPTURE(i, refused.out);
    CHECK(refused.code == 2);
    CHECK(refused.err == what + ". No world was made: --until-damage makes one of the " +
                             std::to_string(damage.edits) + " edits before it\n");
    CHECK_FALSE(std::filesystem::exists(copy));
    CHECK_FALSE(std::filesystem::exists(copy + ".partial"));
    const ReplayOutcome imported = run_replay({"import", torn, "--world", copy, "--until-damage"});
    CAPTURE(imported.out);
    CHECK(imported.code == 2);
    CHECK(imported.err == what + "\n");
    const auto stands = log_of(copy);
    CHECK(stands == std::vector<EditRecord>(
                        log.begin(), log.begin() + static_cast<std::ptrdiff_t>(damage.edits)));
    // An import of the sound file completes the world.
    CHECK(run_replay({"import", file, "--world", copy}).code == 0);
    CHECK(log_of(copy) == log);
  }
}

TEST_CASE("an import makes a new world under the rule of new folders", "[store][rlog]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "log.rlog", torn = folder / "torn";
  make_logged_world(world, 40);
  export_small_blocks(world, file);
  Bytes bytes = bytes_of(file);
  bytes.resize(blocks_of(bytes)[4] - 5);
  write_bytes(torn, bytes);
  SECTION("an empty folder stays and is filled, and stays empty after an error") {
    const std::string empty = folder / "empty";
    std::filesystem::create_directory(empty);
    CHECK(run_replay({"import", torn, "--world", empty}).code == 2);
    CHECK(std::filesystem::is_empty(empty));
    CHECK(run_replay({"import", file, "--world", empty}).code == 0);
    CHECK(log_of(empty) == log_of(world));
    CHECK_FALSE(std::filesystem::exists(empty + "/.partial"));
  }
  SECTION("a folder with other files is left alone") {
    const std::string full = folder / "full";
    std::filesystem::create_directory(full);
    write_bytes(full + "/notes.txt", {'n'});
    const ReplayOutcome refused = run_replay({"import", file, "--world", full});
    CHECK(refused.code == 2);
    CHECK(refused.err.find("full: is not empty") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(full + "/world.sqlite"));
  }
  SECTION("an import that was interrupted is removed by the next one") {
    const std::string copy = folder / "copy";
    std::filesystem::create_directory(copy + ".partial");
    write_bytes(copy + ".partial/partial.lock", {});
    write_bytes(copy + ".partial/world.sqlite", {'n'});
    const ReplayOutcome made = run_replay({"import", file, "--world", copy});
    CHECK(made.code == 0);
    CHECK(made.out.find("copy.partial, which was interrupted\n") != std::string::npos);
    CHECK(log_of(copy) == log_of(world));
    CHECK_FALSE(std::filesystem::exists(copy + ".partial"));
    CHECK_FALSE(std::filesystem::exists(copy + "/partial.lock"));
  }
}

TEST_CASE("a log is not imported into another world or another history of it", "[store][rlog]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "log.rlog";
  make_logged_world(world, 20);
  export_small_blocks(world, file);
  const auto refused = [&](const std::string& into) {
    const auto before = log_of(into);
    const ReplayOutcome imported = run_replay({"import", file, "--world", into});
    CHECK(imported.code == 2);
    CHECK(log_of(into) == before);
    return imported.err;
  };
  WorldMeta other = sample_meta();
  other.world_id[0] ^= 1;
  REQUIRE(create_world(folder / "other", other).has_value());
  CHECK(refused(folder / "other").find("is of another world") != std::string::npos);

  REQUIRE(run_replay({"export", file, "--world", world, "--at", "25"}).code == 0);
  REQUIRE(run_replay({"import", file, "--world", folder / "fork"}).code == 0);
  {
    auto fork = opened(folder / "fork", StoreAccess::read_write);
    REQUIRE(fork->raise_epoch().has_value());
    SplitMix64 rng(5);
    REQUIRE(fork->append({}, sample_records(rng, fork->epoch(), 26, 30)).has_value());
  }
  export_small_blocks(world, file);
  CHECK(refused(folder / "fork").find("edit 26 is another one than in") != std::string::npos);

  auto writer = opened(world, StoreAccess::read_write);
  CHECK(run_replay({"import", file, "--world", world}).code == 2);  // a server runs it
}

TEST_CASE("the log of a world with base chunks can be imported into a copy of its folder",
          "[store][rlog]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "log.rlog";
  SplitMix64 rng(8);
  std::vector<EditRecord> records;
  {
    auto store = *create_world(world, sample_meta());
    const std::vector<std::pair<ChunkKey, ChunkPtr>> base = {
        {{0, {0, 0, 0}}, sample_chunk(rng, {})}};
    REQUIRE(store->save_base(base).has_value());
    REQUIRE(store->raise_epoch().has_value());
    records = sample_records(rng, 1, 1, 40);
    REQUIRE(store->append({}, std::span(records).first(10)).has_value());
  }
  std::filesystem::copy(world, folder / "copy");
  REQUIRE(opened(world, StoreAccess::read_write)
              ->append({}, std::span(records).subspan(10))
              .has_value());
  export_small_blocks(world, file);
  const ReplayOutcome alone = run_replay({"import", file, "--world", folder / "new"});
  CHECK(alone.code == 2);
  CHECK(alone.err.find("does not hold its whole world") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "new"));
  const ReplayOutcome onto = run_replay({"import", file, "--world", folder / "copy"});
  CHECK(onto.out.find("edits       30 added, 10 known") != std::string::npos);
  CHECK(digest_of_world(folder / "copy") == digest_of_world(world));

  // The log of a compacted world begins later. It can be imported into copies that reach that far.
  compact_by_hand(world + "/world.sqlite", {records[19].version, records[19].time_us}, {});
  export_small_blocks(world, file);
  CHECK(read_rlog(bytes_of(file)).records.size() == 20);
  CHECK(run_replay({"import", file, "--world", folder / "copy"}).code == 0);
}

TEST_CASE("an import gives back the edits that a world has lost", "[store][rlog]") {
  const TempFolder folder;
  const std::string live = folder / "live", world = folder / "world", file = folder / "log.rlog";
  make_logged_world(live, 20);
  {
    SplitMix64 rng(9);
    const auto store = opened(live, StoreAccess::read_write);
    REQUIRE(*store->raise_epoch() == 3);
    REQUIRE(store->append({}, sample_records(rng, 3, 41, 10)).has_value());
    copy_crash_image(live, world);
  }
  std::filesystem::remove(world + "/world.sqlite-wal");
  REQUIRE(run_replay({"export", "--world", live, "--at", "45", file}).code == 0);
  const ReplayOutcome part = run_replay({"import", "--world", world, file});
  CHECK(part.code == 0);
  CHECK(part.out.find("edits       5 added, 40 known") != std::string::npos);
  CHECK(part.out.find("LOST        ") != std::string::npos);
  CHECK(part.out.find("the edits seq=46 to seq=50 are lost") != std::string::npos);
  CHECK_FALSE(open_world(world, StoreAccess::read_write).has_value());

  REQUIRE(run_replay({"export", "--world", live, file}).code == 0);
  const ReplayOutcome rest = run_replay({"import", "--world", world, file});
  CHECK(rest.code == 0);
  CHECK(rest.out.find("LOST") == std::string::npos);
  CHECK(digest_of_world(world) == digest_of_world(live));
  CHECK(*opened(world, StoreAccess::read_write)->raise_epoch() == 4);
}

TEST_CASE("files that cannot be read or written are named", "[store][rlog]") {
  const TempFolder folder;
  make_logged_world(folder / "world", 3);
  CHECK(run_replay({"import", folder / "none.rlog", "--world", folder / "new"}).code == 2);
  CHECK(run_replay({"export", folder / "no/such/log.rlog", "--world", folder / "world"}).code == 2);
  write_bytes(folder / "text", {'n', 'o'});
  CHECK(run_replay({"import", folder / "text", "--world", folder / "new"}).err ==
        "runstone-replay: " + folder / "text" + ": edit 1 at byte 0: is not an .rlog file\n");
  const std::string pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& file : {pipe, std::string("/dev/zero")}) {
    CHECK(run_replay({"import", file, "--world", folder / "new"}).err ==
          "runstone-replay: " + file + ": is a device, a pipe or a socket, and no file\n");
  }
  CHECK(run_replay({"import", folder.path(), "--world", folder / "new"}).err ==
        "runstone-replay: " + folder.path() + ": is a folder\n");
}
