#include "client/replica/claims.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

ChunkKey key_at(std::int32_t x) { return {0, {x, 0, 0}}; }

ChunkPtr chunk_of_material(Material material) {
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(16), material);
  chunk.digest = digest_of(chunk.voxels);
  chunk.version = {2, 9};
  return std::make_shared<const Chunk>(std::move(chunk));
}

}  // namespace

TEST_CASE("only chunks that are held and expected are claimed", "[replica]") {
  ReplicaChunks table;
  for (std::int32_t x = 0; x < 5; ++x) {
    table.set_confirmed(*table.track(key_at(x)).first, chunk_of_material(3));
  }
  table.answer(*table.find(key_at(1)));
  table.request(*table.find(key_at(2)));
  table.set_confirmed(*table.find(key_at(3)), nullptr);
  Claims claims;
  const auto taken = claims.take(table, {});
  REQUIRE(taken.size() == 2);
  CHECK(taken[0].key == key_at(0));
  CHECK(taken[1].key == key_at(4));
  CHECK(taken[0].version == Version{2, 9});
  CHECK(taken[0].digest == claim_digest(digest_of(chunk_of_material(3)->voxels)));
  CHECK(claims.waiting_count() == 2);
}

TEST_CASE("the digest of a claim is that of the runs, so that drift is found", "[replica]") {
  ReplicaChunks table;
  Chunk drifted = *chunk_of_material(3);
  drifted.voxels = uniform_chunk(Extent::cube(16), 4);  // drifted.digest is that of material 3
  table.set_confirmed(*table.track(key_at(0)).first,
                      std::make_shared<const Chunk>(std::move(drifted)));
  const auto taken = Claims().take(table, {});
  REQUIRE(taken.size() == 1);
  CHECK(taken[0].digest == claim_digest(digest_of(chunk_of_material(4)->voxels)));
}

TEST_CASE("a chunk is claimed once on a connection, unless it left the view", "[replica]") {
  ReplicaChunks table;
  table.set_confirmed(*table.track(key_at(0)).first, chunk_of_material(3));
  Claims claims;
  CHECK(claims.take(table, {}).size() == 1);
  CHECK(claims.take(table, {}).empty());
  claims.answer(key_at(0));
  CHECK(claims.waiting_count() == 0);
  CHECK(claims.take(table, {}).empty());
  claims.forget(key_at(0));
  CHECK(claims.take(table, {}).size() == 1);
  claims.clear();
  CHECK(claims.waiting_count() == 0);
  CHECK(claims.take(table, {}).size() == 1);
}

TEST_CASE("claims without an answer are bounded", "[replica]") {
  ReplicaChunks table;
  const ChunkPtr shared = chunk_of_material(3);
  for (std::size_t i = 0; i < kClaimsMax + 3; ++i) {
    table.set_confirmed(*table.track(key_at(static_cast<std::int32_t>(i))).first, shared);
  }
  Claims claims;
  CHECK(claims.take(table, {}).size() == kClaimsMax);
  CHECK(claims.take(table, {}).empty());
  claims.answer(key_at(0));
  claims.answer(key_at(1));
  CHECK(claims.take(table, {}).size() == 2);
}
