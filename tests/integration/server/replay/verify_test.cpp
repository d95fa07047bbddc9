// runstone-replay verify: exit codes, table and report of sound, tampered and damaged worlds.
#include "server/replay/replay_commands.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "common/runs/run_chunk.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/replay/digest_list.hpp"
#include "server/tiles/tile_source.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/sql/crash_image.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr int kVerifiedEdge = kSampleEdge;

}  // namespace

TEST_CASE("verify answers with an exit code, a table and a list", "[store][replay]") {
  const TempFolder folder;
  const std::string world = folder / "world", json = folder / "out.json",
                    other = folder / "other.json";
  SplitMix64 rng(14);
  {
    const auto store = *create_world(world, sample_meta());  // generator "empty"
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append({}, sample_records(rng, 1, 1, 80)).has_value());
  }
  const ReplayOutcome first = run_replay({"verify", "--world", world, "--json", json});
  INFO(first.out << first.err);
  CHECK(first.code == 0);
  CHECK(first.err.empty());
  CHECK(first.out.find("edits       80, up to sequence 80") != std::string::npos);
  CHECK(first.out.find("result      equal") != std::string::npos);

  const auto list = read_digests_json(json);
  REQUIRE(list.has_value());
  CHECK(list->seq == 80);
  CHECK(list->chunks.size() > 20);
  const ReplayOutcome second =
      run_replay({"verify", "--quick", "--world", world, "--against", json, json});
  CHECK(second.code == 0);
  CHECK(second.out.find("lists       " + std::to_string(2 * list->chunks.size()) +
                        " chunks compared") != std::string::npos);
  CHECK(run_replay({"verify", "--quick", "--world", world, "--at", "40", "--json", other}).code ==
        0);
  CHECK(read_digests_json(other)->seq == 40);
  CHECK(run_replay({"verify", "--quick", "--world", world, "--against", other}).code == 0);

  DigestList wrong = *list;
  wrong.chunks[3].digest.lane[1] ^= 4;
  REQUIRE(write_digests_json(other, wrong).has_value());
  const ReplayOutcome different =
      run_replay({"verify", "--quick", "--world", world, "--against", other});
  CHECK(different.code == 1);
  CHECK(different.out.find("result      1 differences") != std::string::npos);
  CHECK(different.out.find("first       " + other + ": chunk=") != std::string::npos);

  wrong.world_id[0] ^= 1;
  REQUIRE(write_digests_json(other, wrong).has_value());
  const ReplayOutcome foreign =
      run_replay({"verify", "--quick", "--world", world, "--against", other});
  CHECK(foreign.code == 2);
  CHECK(foreign.err == "runstone-replay: " + other + ": is about another world\n");
  CHECK(run_replay({"verify", "--quick", "--world", world, "--against", folder / "missing.json"})
            .code == 2);
  CHECK(
      run_replay({"verify", "--quick", "--world", world, "--json", folder / "no/such/folder.json"})
          .code == 2);
  CHECK(run_replay({"verify", "--quick", "--world", folder / "nothing"}).code == 2);
  CHECK(run_replay({}).code == 2);
  CHECK(run_replay({"verify", "--quick", "--world", world, "--at", "minus one"}).code == 2);
  CHECK(run_replay({"--help"}).code == 0);

  REQUIRE(
      raw_sql(world + "/world.sqlite", "UPDATE edit_log SET client_seq = 0 WHERE seq = 9").empty());
  const ReplayOutcome damaged = run_replay({"verify", "--quick", "--world", world});
  CHECK(damaged.code == 2);
  CHECK(damaged.err ==
        "runstone-replay: " + world + "/world.sqlite: edit_log seq=9: checksum is wrong\n");
}

namespace {

std::string file_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A closed world of the generator "empty" in `folder`: one edit in each of two chunks, with
/// snapshots. `tamper` may change a snapshot's voxels before it is stored, digest and checksums
/// included.
void make_small_world(const std::string& folder,
                      const std::function<void(const ChunkKey&, RunChunk&)>& tamper) {
  const auto store = *create_world(folder, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  std::vector<EditRecord> records;
  std::vector<std::pair<ChunkKey, ChunkPtr>> snapshots;
  for (const std::int32_t cx : {0, 3}) {
    SplitMix64 rng(1);
    EditRecord record = sample_record(rng, 1, records.size() + 1);
    record.cause = Cause::player;
    record.subject = 0;
    record.edit = {SetVoxel{{cx * kVerifiedEdge + 1, 2, 3}}, {}, 4};
    Chunk chunk;
    chunk.voxels = uniform_chunk(Extent::cube(kVerifiedEdge), kEmpty);
    chunk.version = record.version;
    fill(chunk.voxels, index_of({1, 2, 3}, chunk.voxels.extent, chunk.voxels.order), 1, 4);
    const ChunkKey key{0, {cx, 0, 0}};
    tamper(key, chunk.voxels);
    chunk.digest = digest_of(chunk.voxels);
    records.push_back(record);
    snapshots.emplace_back(key, std::make_shared<const Chunk>(std::move(chunk)));
  }
  REQUIRE(store->append({}, records).has_value());
  REQUIRE(store->save_snapshots(snapshots, 2).has_value());
}

}  // namespace

TEST_CASE("a sound snapshot that differs from the log exits with 1 and is named",
          "[store][replay]") {
  const TempFolder folder;
  const std::string honest = folder / "honest", tampered = folder / "tampered";
  make_small_world(honest, [](const ChunkKey&, RunChunk&) {});
  const ReplayOutcome equal = run_replay({"verify", "--world", honest});
  INFO(equal.out << equal.err);
  CHECK(equal.code == 0);
  CHECK(equal.out.find("snapshots   2 compared") != std::string::npos);

  Digest replayed, stored;
  make_small_world(tampered, [&](const ChunkKey& key, RunChunk& voxels) {
    if (key.at.x != 3) return;
    replayed = digest_of(voxels);
    fill(voxels, index_of({7, 7, 7}, voxels.extent, voxels.order), 1,
         2);  // a voxel that no edit set
    stored = digest_of(voxels);
  });
  const ReplayOutcome different = run_replay({"verify", "--world", tampered});
  INFO(different.out << different.err);
  CHECK(different.code == 1);
  CHECK(different.err.empty());
  CHECK(different.out.find("rows        all read and sound\n") != std::string::npos);
  CHECK(different.out.find("result      1 differences\n") != std::string::npos);
  CHECK(
      different.out.find("first       snapshot: chunk=3,0,0 version=1:2 digest=" + to_hex(stored) +
                         ", replay gives digest=" + to_hex(replayed) + "\n") != std::string::npos);
}

namespace {

/// Makes the tile and those below it of the stored chunks of a closed world, and stores them.
void store_tiles(const std::string& folder, const ChunkKey& key) {
  const auto store = *open_world(folder, StoreAccess::read_write);
  const auto generator = *make_generator(store->meta().generator, default_material_table());
  ChunkSource chunks(folder, *generator);
  TileLedger ledger;
  TileSource source(chunks, *generator, kVerifiedEdge, ledger, {});
  const VisibilityTable visibility(visibilities(default_material_table()));
  const auto made = source.make({key, *store->last_sequence(), {}}, visibility);
  REQUIRE(made.has_value());
  std::vector<std::pair<ChunkKey, ChunkPtr>> tiles;
  for (const MadeTile& tile : *made) tiles.emplace_back(tile.key, tile.tile);
  REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
}

}  // namespace

TEST_CASE("verify compares stored tiles with their chunks", "[store][replay][tiles]") {
  const TempFolder folder;
  const std::string world = folder / "world", json = folder / "out.json";
  make_small_world(world, [](const ChunkKey&, RunChunk&) {});
  store_tiles(world, {2, {0, 0, 0}});
  const ReplayOutcome equal = run_replay({"verify", "--world", world});
  INFO(equal.out << equal.err);
  CHECK(equal.code == 0);
  CHECK(equal.out.find("tiles       9 compared, 0 left out") != std::string::npos);
  CHECK(run_replay({"verify", "--quick", "--world", world}).out.find("tiles") == std::string::npos);

  SECTION("a tile with one wrong voxel") {
    Chunk tile;
    Digest sound;
    {
      const auto store = *open_world(world, StoreAccess::read_write);
      tile = **store->load_tile({1, {1, 0, 0}}, kTileRules);
      sound = tile.digest;
      fill(tile.voxels, index_of({7, 7, 7}, tile.voxels.extent, tile.voxels.order), 1, 2);
      tile.digest = digest_of(tile.voxels);
      const std::vector<std::pair<ChunkKey, ChunkPtr>> tiles = {
          {{1, {1, 0, 0}}, std::make_shared<const Chunk>(tile)}};
      REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
    }
    const ReplayOutcome different = run_replay({"verify", "--world", world, "--json", json});
    INFO(different.out << different.err);
    CHECK(different.code == 1);
    CHECK(different.out.find("result      1 differences\n") != std::string::npos);
    CHECK(different.out.find(
              "first       tile: chunk=1,0,0 lod=1 version=1:2 digest=" + to_hex(tile.digest) +
              ", its chunks give version=1:2 digest=" + to_hex(sound) + "\n") != std::string::npos);
    CHECK(file_text(json).find("\"tiles_compared\":9") != std::string::npos);
  }
  SECTION("a damaged tile") {
    REQUIRE(raw_sql(world + "/world.sqlite", "UPDATE tile SET seq = 7 WHERE lod = 2").empty());
    const ReplayOutcome damaged = run_replay({"verify", "--world", world});
    INFO(damaged.out << damaged.err);
    CHECK(damaged.code == 1);
    CHECK(damaged.out.find("rows        all read; rows of tiles may not be sound") !=
          std::string::npos);
    CHECK(damaged.out.find("first       " + world +
                           "/world.sqlite: tile chunk=0,0,0 lod=2: checksum is wrong\n") !=
          std::string::npos);
  }
  SECTION("a tile whose key became that of no tile") {
    for (const char* change : {"lod = -1", "lod = 256", "lod = 258", "x = 4294967296"}) {
      CAPTURE(change);
      REQUIRE(raw_sql(world + "/world.sqlite",
                      std::string("UPDATE tile SET ") + change + " WHERE lod NOT IN (1)")
                  .empty());
      const ReplayOutcome damaged = run_replay({"verify", "--world", world});
      INFO(damaged.out << damaged.err);
      CHECK(damaged.code == 1);
      CHECK(damaged.out.find("tiles       9 compared, 0 left out") != std::string::npos);
      CHECK(damaged.out.find("/world.sqlite: tile lod=") != std::string::npos);
      CHECK(damaged.out.find(": is the key of no tile\n") != std::string::npos);
    }
  }
  SECTION("an edit behind the checkpoint") {
    {
      const auto store = *open_world(world, StoreAccess::read_write);
      SplitMix64 rng(2);
      EditRecord record = sample_record(rng, store->epoch(), 3);
      record.cause = Cause::player;
      record.subject = 0;
      record.edit = {SetVoxel{{5, 5, 5}}, {}, 4};
      REQUIRE(store->append({}, std::vector{record}).has_value());
    }
    const ReplayOutcome later = run_replay({"verify", "--world", world});
    INFO(later.out << later.err);
    CHECK(later.code == 0);
    CHECK(later.out.find("tiles       7 compared, 2 left out") != std::string::npos);
  }
}

TEST_CASE("a damaged log row exits with 2, names file and row, and nothing is overwritten",
          "[store][replay]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = world + "/world.sqlite",
                    json = folder / "out.json";
  make_small_world(world, [](const ChunkKey&, RunChunk&) {});
  REQUIRE(run_replay({"verify", "--world", world, "--json", json}).code == 0);
  // The checkpoint moves the write-ahead log into the file, so that its bytes can be compared.
  REQUIRE(raw_sql(file,
                  "UPDATE edit_log SET descriptor = zeroblob(9) "
                  "WHERE seq = 2; PRAGMA wal_checkpoint(TRUNCATE)") == "0");
  const std::string damaged = file_text(file), report = file_text(json);
  REQUIRE(damaged.size() > 4096);
  // The full check finds the row, and so does the replay itself.
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{"verify"}, {"verify", "--quick", "--at", "2"}}) {
    std::vector<std::string> arguments = how;
    arguments.insert(arguments.end(), {"--world", world, "--json", json});
    const ReplayOutcome outcome = run_replay(arguments);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err == "runstone-replay: " + file + ": edit_log seq=2: checksum is wrong\n");
  }
  // The log before the damaged row is sound.
  CHECK(run_replay({"verify", "--quick", "--world", world, "--at", "1"}).code == 0);
  CHECK(file_text(file) == damaged);
  CHECK(file_text(json) == report);
}

TEST_CASE("a world that lacks durable edits exits with 1 and says which", "[store][replay]") {
  const TempFolder folder;
  const std::string live = folder / "live", world = folder / "world", json = folder / "out.json";
  make_small_world(live, [](const ChunkKey&, RunChunk&) {});
  {
    SplitMix64 rng(2);
    const auto store = *open_world(live, StoreAccess::read_write);
    REQUIRE(store->append({}, sample_records(rng, 1, 3, 4)).has_value());
    copy_crash_image(live, world);
  }
  REQUIRE(run_replay({"verify", "--world", world}).code == 0);
  std::filesystem::remove(world + "/world.sqlite-wal");
  const ReplayOutcome outcome = run_replay({"verify", "--world", world, "--json", json});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.code == 1);
  CHECK(outcome.out.find("LOST        " + world +
                         "/world.sqlite: edit_log: ends at seq=2, but seq=6 was durable: the edits "
                         "seq=3 to seq=6 are lost") != std::string::npos);
  CHECK(outcome.out.find("result      incomplete: 0 differences in what is left; the row LOST says "
                         "what is missing\n") != std::string::npos);
  // "equal" means that everything agrees.
  CHECK(outcome.out.find("result      equal") == std::string::npos);
  CHECK(file_text(json).find("\"lost\":\"" + world) != std::string::npos);
  const ReplayOutcome exported = run_replay(
      {"export", folder / "rest.rlog", "--world", world, "--json", folder / "rest.json"});
  CHECK(exported.code == 1);
  CHECK(exported.out.find("LOST        ") != std::string::npos);
  CHECK(std::filesystem::exists(folder / "rest.rlog"));
  CHECK(file_text(folder / "rest.json").find("\"lost\": \"" + world) != std::string::npos);
  const ReplayOutcome copied =
      run_replay({"copy", folder / "copy", "--world", world, "--json", folder / "copy.json"});
  INFO(copied.out << copied.err);
  CHECK(copied.code == 1);
  CHECK(copied.out.find("LOST        ") != std::string::npos);
  CHECK(file_text(folder / "copy.json").find("\"lost\": \"" + world) != std::string::npos);
  CHECK(open_world(folder / "copy", StoreAccess::read_only).has_value());
}

TEST_CASE("verify cannot read a world whose generator this program lacks", "[store][replay]") {
  const TempFolder folder;
  WorldMeta meta = sample_meta();
  meta.generator.name = "atlantis";
  REQUIRE(create_world(folder.path(), meta).has_value());
  const ReplayOutcome run = run_replay({"verify", "--quick", "--world", folder.path()});
  CHECK(run.code == 2);
  CHECK(run.err.find("generator=atlantis version=1") != std::string::npos);
}
