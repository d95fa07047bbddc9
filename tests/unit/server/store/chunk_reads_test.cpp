// Reads of chunks: what is checked of a row, and reads that are joined to one moment.
#include <catch2/catch.hpp>

#include "protocol/chunks/chunk_codec.hpp"
#include "server/store/chunk_row.hpp"
#include "server/store/read_span.hpp"
#include "server/store/store.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE(
    "a row with a wrong digest is found by the check of voxels, a changed byte by both checks",
    "[store]") {
  SplitMix64 rng{6};
  const ChunkPtr chunk = sample_chunk(rng, {1, 3});
  const auto edge = static_cast<std::uint16_t>(chunk->voxels.extent.x);
  Bytes data = encode_chunk(chunk->voxels, ChunkEncoding::packed);
  ChunkRow row{{0, {1, 2, 3}}, chunk->version, chunk->digest, 0, data};
  row.digest.lane[1] ^= 1;
  row.checksum = checksum_of("base", row);
  const auto checked = chunk_of("base", row, edge, RowCheck::voxels);
  REQUIRE_FALSE(checked.has_value());
  CHECK(checked.error() == "has voxels that do not match its digest");
  const auto shown = chunk_of("base", row, edge, RowCheck::bytes);
  REQUIRE(shown.has_value());
  CHECK(shown->voxels == chunk->voxels);

  data.back() ^= 1;
  for (const RowCheck check : {RowCheck::voxels, RowCheck::bytes}) {
    const auto damaged = chunk_of("base", row, edge, check);
    REQUIRE_FALSE(damaged.has_value());
    CHECK(damaged.error() == "checksum is wrong");
  }
}

TEST_CASE("a snapshot that is newer than wanted is not read", "[store][sqlite]") {
  SplitMix64 rng{8};
  TempPlace place;
  const ChunkKey key{0, {4, 5, 6}};
  {
    const auto store = *create_world(place.path(), sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    REQUIRE(store->append(players, sample_records(rng, 1, 1, 20)).has_value());
    const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {{key, sample_chunk(rng, {1, 7})}};
    REQUIRE(store->save_snapshots(chunks, std::nullopt).has_value());
    CHECK((*store->load_snapshot(key, 7))->version == Version{1, 7});
    CHECK((*store->load_snapshot(key))->version == Version{1, 7});
    CHECK_FALSE(store->load_snapshot(key, 6)->has_value());
  }
  REQUIRE(raw_sql(place / "world.sqlite", "UPDATE snapshot SET data = x'0102'").empty());
  const auto store = *open_world(place.path(), StoreAccess::read_only);
  CHECK_FALSE(store->load_snapshot(key, 7).has_value());
  REQUIRE(store->load_snapshot(key, 6).has_value());
  CHECK_FALSE(store->load_snapshot(key, 6)->has_value());
}

TEST_CASE("joined reads see one moment while another program writes", "[store]") {
  SplitMix64 rng{7};
  TempPlace place;
  const auto writer = *create_world(place.path(), sample_meta());
  REQUIRE(writer->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(writer->append(players, sample_records(rng, 1, 1, 20)).has_value());
  const ChunkKey key{0, {4, 5, 6}};
  const auto save = [&](Version version) {
    const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {{key, sample_chunk(rng, version)}};
    REQUIRE(writer->save_snapshots(chunks, std::nullopt).has_value());
  };
  save({1, 3});
  const auto reader = *open_world(place.path(), StoreAccess::read_only);
  const auto version = [&] { return (*reader->load_snapshot(key))->version; };
  {
    ReadSpan reads(*reader);
    REQUIRE(reads.next().has_value());
    CHECK(version() == Version{1, 3});
    save({1, 8});
    REQUIRE(reads.next().has_value());
    CHECK(version() == Version{1, 3});
    // A span is bounded, so the new moment is seen after some more reads.
    bool sees_new = false;
    for (int i = 0; i < 1000 && !sees_new; ++i) {
      REQUIRE(reads.next().has_value());
      sees_new = version() == Version{1, 8};
    }
    CHECK(sees_new);
    save({1, 9});
  }
  CHECK(version() == Version{1, 9});
}
