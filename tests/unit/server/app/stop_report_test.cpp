#include "server/app/stop_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr ChunkKey kHere{0, {0, 0, 0}}, kThere{0, {1, 0, 0}}, kFar{0, {5, 0, 0}};

/// A world with snapshots of two edited chunks.
struct StoppedWorld {
  TempFolder folder;
  SplitMix64 rng{1};
  ChunkPtr here = sample_chunk(rng, {1, 2}), there = sample_chunk(rng, {1, 3});
  std::unique_ptr<Store> store = *create_world(folder.path(), sample_meta());

  StoppedWorld() {
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append({}, sample_records(rng, 1, 1, 3)).has_value());
    const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {{kHere, here}, {kThere, there}};
    REQUIRE(store->save_snapshots(chunks, 3).has_value());
  }
  StopReport with(const ChunkKey& key, const Chunk& live, const StopState& state = {},
                  std::size_t rows_max = 100) const {
    const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {
        {key, std::make_shared<const Chunk>(live)}};
    return sum_up(*store, chunks, state, [left = rows_max]() mutable { return left-- > 0; });
  }
};

constexpr StopState kLost{false, 6, 0};

}  // namespace

TEST_CASE("a clean stop lists chunks from memory and the others from their snapshots", "[server]") {
  const StoppedWorld world;
  const StopReport report = world.with(kHere, *world.here);
  CHECK(report.error.empty());
  CHECK(report.is_clean);
  CHECK(report.live_chunks == 1);
  CHECK(report.digests.seq == 3);
  CHECK(report.digests.world_id == sample_meta().world_id);
  CHECK(report.digests.chunks ==
        std::vector<DigestCheckEntry>{{kHere, {1, 2}, digest_of(world.here->voxels)},
                                      {kThere, {1, 3}, digest_of(world.there->voxels)}});
  CHECK(report.world_digest == world_digest_term(kHere, world.here->digest) +
                                   world_digest_term(kThere, world.there->digest));
}

TEST_CASE(
    "a chunk in memory that differs from its snapshot is listed as it was in memory, and named",
    "[server]") {
  const StoppedWorld world;
  Chunk live = *world.here;
  ChunkKey key = kHere;
  std::string error;
  SECTION("other voxels behind an unchanged digest") {
    const Material there = material_at(live.voxels, {5, 5, 5});
    fill(live.voxels, index_of({5, 5, 5}, live.voxels.extent, live.voxels.order), 1,
         there == 1 ? 2 : 1);
    error = "has digest=" + to_hex(world.here->digest) +
            ", the server had digest=" + to_hex(digest_of(live.voxels));
  }
  SECTION("another version") {
    live.version = {1, 3};
    error = "has version=1:2, the server had version=1:3";
  }
  SECTION("no snapshot at all") {
    key = kFar;
    error = "is missing, but the chunk was edited";
  }
  const StopReport report = world.with(key, live);
  CHECK(report.error == world.store->file() +
                            ": snapshot chunk=" + (key == kFar ? "5,0,0" : "0,0,0") + ": " + error);
  const DigestCheckEntry entry{key, live.version, digest_of(live.voxels)};
  CHECK(std::count(report.digests.chunks.begin(), report.digests.chunks.end(), entry) == 1);
  // A stop that was cut short leaves chunks that are newer than their snapshots, which is no error.
  CHECK(world.with(key, live, kLost).error.empty());
}

TEST_CASE("a stop that was not clean lists the stored chunks, and marks line and file as unclean",
          "[server]") {
  const StoppedWorld world;
  Chunk live = *world.here;
  live.version = {1, 9};  // never on disk
  const StopReport report = world.with(kHere, live, kLost);
  CHECK_FALSE(report.is_clean);
  CHECK(report.digests.chunks ==
        std::vector<DigestCheckEntry>{{kHere, {1, 2}, digest_of(world.here->voxels)},
                                      {kThere, {1, 3}, digest_of(world.there->voxels)}});
  CHECK(stop_line(report) == "stopped unclean seq=3 snapshots=2 live=1 lost_edits=6");
  const auto read = parse_digests_json(to_json(report.digests), "d.json");
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error().message().find("clean") != std::string::npos);

  const StopReport clean = world.with(kHere, *world.here);
  CHECK(stop_line(clean) ==
        "stopped seq=3 edited_chunks=2 live=1 world_digest=" + to_hex(clean.world_digest));
  CHECK(parse_digests_json(to_json(clean.digests), "d.json").has_value());
}

TEST_CASE("a stop that leaves chunks to the next start is durable, and says how many they are",
          "[server]") {
  const StoppedWorld world;
  Chunk live = *world.here;
  live.version = {1, 3};  // newer than its snapshot, which is no error
  const StopReport report = world.with(kHere, live, {false, 0, 7});
  CHECK(report.state.is_durable());
  CHECK_FALSE(report.is_clean);
  CHECK_FALSE(report.digests.is_clean);
  CHECK(report.error.empty());
  CHECK(stop_line(report) == "stopped seq=3 chunks_left=7 live=1");
}

TEST_CASE("a stop without time to read every snapshot has no digest and is no failure",
          "[server]") {
  const StoppedWorld world;
  for (const std::size_t rows_max : {0U, 1U, 2U, 3U}) {
    CAPTURE(rows_max);
    const StopReport report = world.with(kHere, *world.here, {}, rows_max);
    CHECK_FALSE(report.is_summed);
    CHECK(report.is_clean);
    CHECK(report.error.empty());
    CHECK(report.digests.chunks.empty());
    CHECK_FALSE(report.digests.is_clean);
    CHECK(stop_line(report) == "stopped seq=3 chunks_left=0 live=1");
  }
  // The question is asked before the list, and after each of two snapshots and a live chunk.
  CHECK(world.with(kHere, *world.here, {}, 4).is_summed);
}

TEST_CASE("a snapshot that cannot be read is named, and the others are summed up", "[server]") {
  const StoppedWorld world;
  REQUIRE(
      raw_sql(world.folder / "world.sqlite", "UPDATE snapshot SET data = zeroblob(40) WHERE x = 1")
          .empty());
  const StopReport report = world.with(kHere, *world.here);
  CHECK(report.error.find("world.sqlite: snapshot chunk=1,0,0: ") != std::string::npos);
  CHECK(report.digests.chunks.size() == 1);
}
