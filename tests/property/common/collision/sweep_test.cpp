// Sweeps against an oracle that looks at every voxel by itself and in fractions.
#include "common/collision/sweep.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr Material kWater = 1;  // not solid

/// Two chunks along each axis around the origin, in all axis orders; one of them may be unknown.
class SomeChunks final : public VoxelSpace {
 public:
  explicit SomeChunks(SplitMix64& rng) : VoxelSpace(kEdge) {
    for (std::int32_t i = 0; i < 8; ++i) {
      if (rng.below(16) == 0) continue;
      const ChunkCoord at{(i & 1) - 1, (i >> 1 & 1) - 1, (i >> 2 & 1) - 1};
      RunChunk chunk = random_chunk(rng, Extent::cube(kEdge), random_order(rng), 3);
      // Mostly empty, so that bodies have room to move.
      for (std::uint32_t k = rng.below(300); k > 0; --k) {
        const auto first = rng.below(chunk.volume() - 40);
        fill(chunk, first, 1 + rng.below(40), kEmpty);
      }
      chunks_.emplace(at, std::move(chunk));
    }
  }
  const RunChunk* chunk(ChunkCoord at) const override {
    const auto found = chunks_.find(at);
    return found == chunks_.end() ? nullptr : &found->second;
  }
  bool is_solid(VoxelPos at) const {
    const RunChunk* const found = chunk(chunk_of(at, kEdge));
    if (found == nullptr) return true;
    const Material material = material_at(*found, local_of(at, kEdge));
    return material != kEmpty && material != kWater;
  }

 private:
  std::map<ChunkCoord, RunChunk> chunks_;
};

/// A fraction with a positive denominator.
struct Fraction {
  std::int64_t over = 0, under = 1;
  friend bool operator<(const Fraction& a, const Fraction& b) {
    return a.over * b.under < b.over * a.under;
  }
};

/// A body and its move in eighths of a voxel.
struct Eighths {
  std::array<std::int64_t, 3> min{}, max{}, move{};
};

/// Returns the part of the move during which the body overlaps voxel `at`, or nullopt if it never
/// does.
std::optional<std::pair<Fraction, Fraction>> overlap_of(const Eighths& body, VoxelPos at) {
  const std::array<std::int64_t, 3> low = {8LL * at.x, 8LL * at.y, 8LL * at.z};
  Fraction from{-1'000'000, 1}, to{1'000'000, 1};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t move = body.move[a];
    // min + move * t < low + 8 and max + move * t > low.
    const std::int64_t before_high = low[a] + 8 - body.min[a], behind_low = low[a] - body.max[a];
    if (move == 0) {
      if (before_high <= 0 || behind_low >= 0) return std::nullopt;
      continue;
    }
    const Fraction enter = move > 0 ? Fraction{behind_low, move} : Fraction{-before_high, -move};
    const Fraction leave = move > 0 ? Fraction{before_high, move} : Fraction{-behind_low, -move};
    if (from < enter) from = enter;
    if (leave < to) to = leave;
  }
  if (!(from < to)) return std::nullopt;
  return std::pair{from, to};
}

/// Returns the fraction at which the body meets a solid voxel that it did not overlap before.
std::optional<double> first_hit(const SomeChunks& chunks, const Eighths& body) {
  std::optional<Fraction> first;
  constexpr std::int32_t kFar = 2 * kEdge;
  for (std::int32_t x = -kFar; x < kFar; ++x) {
    for (std::int32_t y = -kFar; y < kFar; ++y) {
      for (std::int32_t z = -kFar; z < kFar; ++z) {
        const auto overlap = overlap_of(body, {x, y, z});
        if (!overlap || overlap->first < Fraction{0, 1}) continue;
        if (!(overlap->first < Fraction{1, 1}) || !chunks.is_solid({x, y, z})) continue;
        if (!first || overlap->first < *first) first = overlap->first;
      }
    }
  }
  if (!first) return std::nullopt;
  return static_cast<double>(first->over) / static_cast<double>(first->under);
}

WorldPos pos_of_eighths(const std::array<std::int64_t, 3>& n) {
  return {static_cast<double>(n[0]) / 8, static_cast<double>(n[1]) / 8,
          static_cast<double>(n[2]) / 8};
}

Eighths random_body(SplitMix64& rng) {
  Eighths body;
  const bool is_walking = rng.below(2) == 0;
  for (std::size_t a = 0; a < 3; ++a) {
    body.min[a] = rng.between(-14 * 8, 12 * 8);
    body.max[a] = body.min[a] + rng.between(1, 20);
    body.move[a] = is_walking && rng.below(2) == 0 ? 0 : rng.between(-60, 60);
  }
  return body;
}

MaterialSet all_but_water() { return MaterialSet({false, false}, true); }

}  // namespace

TEST_CASE("a sweep stops where the first voxel is met", "[collision][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  const MaterialSet solid = all_but_water();
  int hits = 0, free_ways = 0;
  for (int world = 0; world < 30; ++world) {
    const SomeChunks chunks(rng);
    for (int i = 0; i < 8; ++i) {
      const Eighths body = random_body(rng);
      CAPTURE(Catch::rngSeed(), world, i);
      const auto expected = first_hit(chunks, body);
      const BodyBox box{pos_of_eighths(body.min), pos_of_eighths(body.max)};
      const auto hit = sweep(chunks, solid, box, pos_of_eighths(body.move));
      REQUIRE(hit.has_value() == expected.has_value());
      if (!hit) {
        ++free_ways;
        continue;
      }
      ++hits;
      CHECK(hit->fraction == Approx(*expected).margin(1e-9));
      CHECK(chunks.is_solid(hit->voxel));
    }
  }
  CHECK(hits > 20);
  CHECK(free_ways > 20);
}

TEST_CASE("a slide never enters a solid voxel and stops only at one", "[collision][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  const MaterialSet solid = all_but_water();
  int moved_on = 0;
  for (int world = 0; world < 60; ++world) {
    const SomeChunks chunks(rng);
    for (int i = 0; i < 20; ++i) {
      const Eighths body = random_body(rng);
      CAPTURE(Catch::rngSeed(), world, i);
      const BodyBox box{pos_of_eighths(body.min), pos_of_eighths(body.max)};
      if (overlaps(chunks, solid, box)) continue;
      const WorldPos move = pos_of_eighths(body.move);
      const Slide end = slide(chunks, solid, box, move);
      const BodyBox there{
          {box.min.x + end.moved.x, box.min.y + end.moved.y, box.min.z + end.moved.z},
          {box.max.x + end.moved.x, box.max.y + end.moved.y, box.max.z + end.moved.z}};
      REQUIRE_FALSE(overlaps(chunks, solid, there));
      const std::array<double, 3> wanted = {move.x, move.y, move.z};
      const std::array<double, 3> got = {end.moved.x, end.moved.y, end.moved.z};
      for (std::size_t a = 0; a < 3; ++a) {
        const auto direction = a * 2 + (wanted[a] > 0 ? 1U : 0U);
        CHECK((end.is_stopped[direction] || got[a] == Approx(wanted[a]).margin(1e-9)));
        CHECK(got[a] * wanted[a] >= 0);
        CHECK(std::abs(got[a]) <= std::abs(wanted[a]) + 1e-9);
        // A little further the box would be in the voxel that stopped it.
        if (end.is_stopped[direction] && std::abs(got[a]) < std::abs(wanted[a])) ++moved_on;
      }
    }
  }
  CHECK(moved_on > 20);
}

}  // namespace runstone::test
