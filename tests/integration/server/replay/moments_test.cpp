// The subcommands of runstone-replay that take moments of a world: verify --at, copy, diff;
// keyframes; reports.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "server/history/world_at.hpp"
#include "server/replay/world_copy.hpp"
#include "tests/integration/server/replay/read_json.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr Sequence kMomentEdits = 120;
constexpr ChunkKey kImported{0, {7, 7, 7}};  // no edit touches it

/// A closed world of edits a millisecond apart, with one imported chunk.
void make_moment_world(const std::string& folder) {
  SplitMix64 rng(1);
  WorldMeta meta = sample_meta();
  meta.generator.name = "flat";
  auto store = *create_world(folder, meta);
  REQUIRE(store
              ->save_base(
                  std::vector<std::pair<ChunkKey, ChunkPtr>>{{kImported, sample_chunk(rng, {})}})
              .has_value());
  REQUIRE(store->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, sample_records(rng, 1, 1, kMomentEdits)).has_value());
}

}  // namespace

TEST_CASE("a replay stops at a moment in any spelling", "[store][replay]") {
  const TempFolder folder;
  make_moment_world(folder.path());
  // Edit n is stamped 2023-11-14T22:13:20Z + n ms.
  const std::vector<std::pair<std::string, std::string>> moments = {
      {"40", "edits       40, up to sequence 40\n"},
      {"0", "edits       0, up to sequence 0\n"},
      {"2023-11-14T22:13:20.04Z", "up to sequence 40\n"},
      {"2023-11-14T22:13:20.0409Z", "up to sequence 40\n"},
      {"2023-11-14T22:13:20Z", "up to sequence 0\n"},
      {"2024-01-01T00:00Z", "up to sequence 120\n"},
      {"-1s", "up to sequence 0\n"},
      {"-0s", "up to sequence 120\n"}};
  for (const auto& [moment, said] : moments) {
    CAPTURE(moment);
    const auto outcome =
        run_replay({"verify", "--quick", "--world", folder.path(), "--at", moment});
    CHECK(outcome.err == "");
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.out, said));
  }
  const auto beyond = run_replay({"verify", "--quick", "--world", folder.path(), "--at", "121"});
  CHECK(beyond.code == 2);
  CHECK(contains(beyond.err, "ends at seq=120, before seq=121"));
  const auto wrong =
      run_replay({"verify", "--quick", "--world", folder.path(), "--at", "yesterday"});
  CHECK(wrong.code == 2);
  CHECK(contains(wrong.err, "\"yesterday\" is no moment"));
}

TEST_CASE("copy writes a moment as a new world", "[store][replay]") {
  const TempFolder folder;
  const std::string world = folder / "world", copy = folder / "copy";
  make_moment_world(world);
  const auto outcome =
      run_replay({"copy", copy + "/", "--world", world, "--at", "70", "--json", folder / "w.json"});
  CHECK(outcome.err == "");
  REQUIRE(outcome.code == 0);
  const auto source = *open_world(world, StoreAccess::read_only);
  const auto generator = *make_generator(source->meta().generator, source->meta().materials);
  auto then = *WorldAt::open(*source, *generator, 70);
  const auto made = *open_world(copy, StoreAccess::read_write);
  CHECK(made->check().has_value());
  CHECK(made->meta().world_id != source->meta().world_id);
  CHECK(made->meta().server_key_seed != source->meta().server_key_seed);
  CHECK(made->meta().generator == source->meta().generator);
  CHECK(made->meta().spawn.y == source->meta().spawn.y);
  CHECK(made->meta().materials == source->meta().materials);
  CHECK(*made->last_sequence() == 0);
  CHECK(made->players()->empty());
  auto now = *WorldAt::open(*made, *generator, 0);
  auto keys = then.edited();
  keys.push_back(kImported);
  Digest digest;
  for (const ChunkKey& key : keys) {
    const auto a = *then.chunk(key);
    const auto b = *now.chunk(key);
    CHECK(a.voxels == b.voxels);
    CHECK(b.version == Version{});
    digest = digest + world_digest_term(key, a.digest);
  }
  CHECK(made->base_chunks()->size() == keys.size());
  const auto json = read_json(folder / "w.json");
  CHECK(json.at("seq") == 70);
  CHECK(json.at("chunks") == keys.size());
  CHECK(json.at("world_digest") == to_hex(digest));
  CHECK_FALSE(std::filesystem::exists(copy + ".partial"));
  CHECK(contains(outcome.out, "left out    the log, players, names, rights"));
  // An existing world is never overwritten.
  const auto again = run_replay({"copy", copy, "--world", world});
  CHECK(again.code == 2);
  CHECK(contains(again.err, "is not empty"));
  // A copy that is interrupted leaves nothing behind.
  std::ostringstream out;
  const auto broken = copy_world(*source, *generator, 70, folder / "half", out,
                                 [](std::uint64_t done, std::uint64_t) { return done < 3; });
  REQUIRE_FALSE(broken.has_value());
  CHECK_FALSE(std::filesystem::exists(folder / "half"));
  CHECK_FALSE(std::filesystem::exists(folder / "half.partial"));
}

TEST_CASE("a difference is reported in a table and as JSON", "[store][replay]") {
  const TempFolder folder;
  make_moment_world(folder.path());
  const auto outcome = run_replay({"diff", "--world", folder.path(), "--from", "-100ms", "--to",
                                   "120", "--json", folder / "d.json"});
  CHECK(outcome.code == 2);  // milliseconds are no unit
  const auto table =
      run_replay({"diff", "--world", folder.path(), "--from", "2023-11-14T22:13:20.02Z", "--to",
                  "-0s", "--json", folder / "d.json"});
  CHECK(table.err == "");
  REQUIRE(table.code == 0);
  CHECK(contains(table.out,
                 "moments     after sequence 20 and after sequence 120, 100 edits between\n"));
  CHECK(contains(table.out, "builder 1: "));
  const auto json = read_json(folder / "d.json");
  CHECK(json.at("edits") == 100);
  std::uint64_t by_author = 0, by_chunk = 0, edits = 0;
  for (const auto& author : json.at("authors")) {
    by_author += author.at("voxels").get<std::uint64_t>();
    edits += author.at("edits").get<std::uint64_t>();
  }
  for (const auto& chunk : json.at("chunks")) by_chunk += chunk.at("voxels").get<std::uint64_t>();
  CHECK(json.at("voxels").get<std::uint64_t>() > 1000);
  CHECK(by_author == json.at("voxels"));
  CHECK(by_chunk == json.at("voxels"));
  CHECK(edits == 100);
  CHECK(run_replay({"diff", "--world", folder.path(), "--from", "30"}).code == 2);
  CHECK(contains(run_replay({"diff", "--world", folder.path(), "--from", "30", "--to", "20"}).err,
                 "seq=30 is behind seq=20"));
}

TEST_CASE("verify compares every chunk of every keyframe", "[store][replay]") {
  const TempFolder folder;
  make_moment_world(folder.path());
  // The edits are too scattered for a keyframe to be due. Two are made by hand, at 50 and 100.
  {
    auto store = *open_world(folder.path(), StoreAccess::read_write);
    const auto generator = *make_generator(store->meta().generator, store->meta().materials);
    for (const Sequence at : {Sequence{50}, Sequence{100}}) {
      auto world = *WorldAt::open(*store, *generator, at);
      Keyframe keyframe = world.untouched();
      std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
      for (const ChunkKey& key : world.touched()) {
        chunks.emplace_back(key, std::make_shared<const Chunk>(*world.chunk(key)));
        keyframe.world_digest =
            keyframe.world_digest + world_digest_term(key, chunks.back().second->digest);
        ++keyframe.chunks;
      }
      REQUIRE(store->save_keyframe(chunks, keyframe).has_value());
    }
  }
  const std::string file = folder / "world.sqlite", json = folder / "v.json";
  CHECK(run_replay({"verify", "--world", folder.path(), "--json", json}).code == 0);
  CHECK(std::to_string(read_json(json).at("report").at("keyframes_compared").get<int>()) ==
        raw_sql(file, "SELECT count(*) FROM keyframe_chunk"));
  CHECK(run_replay({"verify", "--world", folder.path(), "--at", "60", "--json", json}).code == 0);
  CHECK(std::to_string(read_json(json).at("report").at("keyframes_compared").get<int>()) ==
        raw_sql(file, "SELECT count(*) FROM keyframe_chunk WHERE seq <= 60"));
  CHECK(run_replay({"verify", "--quick", "--world", folder.path(), "--json", json}).code == 0);
  CHECK(read_json(json).at("report").at("keyframes_compared") == 0);
  // The keyframe is valid in itself, but differs from the world that the log gives.
  {
    SplitMix64 rng(3);
    auto store = *open_world(folder.path(), StoreAccess::read_write);
    const auto generator = *make_generator(store->meta().generator, store->meta().materials);
    auto world = *WorldAt::open(*store, *generator, 110);
    const ChunkKey key = world.touched().front();
    const auto lie = sample_chunk(rng, world.version(key));
    REQUIRE(
        store->save_keyframe(std::vector<std::pair<ChunkKey, ChunkPtr>>{{key, lie}}, std::nullopt)
            .has_value());
  }
  const auto differs = run_replay({"verify", "--world", folder.path()});
  CHECK(differs.code == 1);
  CHECK(contains(differs.out, "1 differences"));
  CHECK(contains(differs.out, "first       keyframe: chunk="));
}
