#include "server/interest/cache_claims.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "common/core/hash.hpp"
#include "protocol/codec/view_tiles.hpp"
#include "protocol/limits.hpp"

namespace runstone::test {
namespace {

CachedChunk claim_at(const ChunkKey& key, std::uint64_t digest = 1) {
  return {key, {1, 1}, digest};
}

/// Compares the claims with a map of them.
void check_claims(const CacheClaims& claims, const std::map<ChunkKey, CachedChunk>& model,
                  std::span<const ChunkKey> keys) {
  REQUIRE(claims.count() == model.size());
  for (const ChunkKey& key : keys) {
    const CachedChunk* const found = claims.find(key);
    const auto expected = model.find(key);
    REQUIRE((found != nullptr) == (expected != model.end()));
    if (found != nullptr) REQUIRE(*found == expected->second);
  }
}

/// Returns `count` keys of chunks and tiles, ascending. Some are equal to keys of other calls.
std::vector<ChunkKey> some_keys(SplitMix64& rng, std::size_t count) {
  std::set<ChunkKey> keys;
  while (keys.size() < count) {
    const auto level = static_cast<std::uint8_t>(rng.below(3));
    keys.insert({level, {rng.between(-9, 9), rng.between(-2, 2), rng.between(-9, 9)}});
  }
  return {keys.begin(), keys.end()};
}

TEST_CASE("claims are found until they are dropped, replaced or outside of the view",
          "[interest]") {
  SplitMix64 rng(20261205);
  CacheClaims claims;
  std::map<ChunkKey, CachedChunk> model;
  std::uint64_t digest = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<CachedChunk> added;
    for (const ChunkKey& key : some_keys(rng, 1 + rng.below(kCachedChunksMax)))
      added.push_back(claim_at(key, ++digest));
    REQUIRE(claims.add(added));
    for (const CachedChunk& claim : added) model[claim.key] = claim;
    // Few, many, or all of them are answered.
    for (const ChunkKey& key : some_keys(rng, rng.below(round % 3 == 0 ? 900 : 100))) {
      claims.drop(key);
      model.erase(key);
    }
    if (round % 7 == 0) {
      const View view{1, {rng.between(-5, 5), 0, rng.between(-5, 5)}, 4, 1, 0, 0, 0, 2};
      claims.keep(view);
      std::erase_if(model, [&](const auto& one) { return !contains_key(view, one.first); });
    }
    if (round % 50 == 49) {
      claims.clear();
      model.clear();
    }
    CAPTURE(round);
    check_claims(claims, model, some_keys(rng, 200));
  }
}

TEST_CASE("a session may have so many claims, and answered ones do not count", "[interest]") {
  CacheClaims claims;
  const auto add_all = [&] {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(kClaimsPerSessionMax);) {
      std::vector<CachedChunk> message;
      for (; message.size() < kCachedChunksMax; ++i) message.push_back(claim_at({0, {i, 0, 0}}));
      REQUIRE(claims.add(message));
    }
  };
  add_all();
  add_all();  // the same ones
  CHECK(claims.count() == kClaimsPerSessionMax);
  claims.drop({0, {5, 0, 0}});
  CHECK(claims.add(std::vector{claim_at({0, {-1, 0, 0}})}));
  CHECK(claims.count() == kClaimsPerSessionMax);
  CHECK_FALSE(claims.add(std::vector{claim_at({0, {-2, 0, 0}})}));
}

TEST_CASE("an answered claim can be made again", "[interest]") {
  CacheClaims claims;
  const ChunkKey key{0, {1, 2, 3}};
  REQUIRE(claims.add(std::vector{claim_at({0, {0, 0, 0}}), claim_at(key)}));
  claims.drop(key);
  CHECK(claims.find(key) == nullptr);
  claims.drop(key);  // it is not there any more
  CHECK(claims.count() == 1);
  REQUIRE(claims.add(std::vector{claim_at(key, 9)}));
  REQUIRE(claims.find(key) != nullptr);
  CHECK(claims.find(key)->digest == 9);
  CHECK(claims.count() == 2);
  CHECK(claims.add({}));
  CHECK(claims.count() == 2);
}

}  // namespace
}  // namespace runstone::test
