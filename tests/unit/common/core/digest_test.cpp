#include "common/core/digest.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/core/m61.hpp"

using namespace runstone;

TEST_CASE("material factors are residues, and zero for the empty material alone",
          "[core][digest]") {
  for (int lane = 0; lane < kDigestLanes; ++lane) {
    CHECK(digest_material(lane, kEmpty) == 0);
    for (unsigned m = 1; m < 65536; m += 7) {
      const std::uint64_t g = digest_material(lane, static_cast<Material>(m));
      REQUIRE(g != 0);
      REQUIRE(g < m61::kPrime);
    }
  }
  CHECK(digest_material(0, 1) != digest_material(1, 1));
}

TEST_CASE("axis sums add up from single places", "[core][digest]") {
  for (int lane = 0; lane < kDigestLanes; ++lane) {
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
      std::uint64_t sum = 0;
      for (unsigned i = 0; i < 128; ++i) {
        REQUIRE(digest_axis_sum(lane, axis, 0, i) == sum);
        REQUIRE(digest_axis_prefix(lane, axis)[i] == sum);
        REQUIRE(digest_axis_sum(lane, axis, i, i + 1) != 0);
        sum = m61::add(sum, digest_axis_sum(lane, axis, i, i + 1));
      }
      CHECK(digest_axis_sum(lane, axis, 0, 128) == sum);
      CHECK(digest_axis_sum(lane, axis, 5, 5) == 0);
      CHECK(digest_axis_prefix(lane, axis)[129] == sum);
    }
  }
}

TEST_CASE("a box's digest is the sum of its voxels' digests", "[core][digest]") {
  Digest sum;
  for (unsigned x = 3; x < 7; ++x) {
    for (unsigned y = 0; y < 5; ++y) {
      for (unsigned z = 120; z < 128; ++z)
        sum = sum + digest_of_box(9, {x, y, z}, {x + 1, y + 1, z + 1});
    }
  }
  CHECK(digest_of_box(9, {3, 0, 120}, {7, 5, 128}) == sum);
  CHECK(digest_of_box(kEmpty, {0, 0, 0}, {128, 128, 128}) == Digest{});
  CHECK(digest_of_box(9, {3, 0, 4}, {3, 5, 8}) == Digest{});
}

TEST_CASE("digests add and subtract without order", "[core][digest]") {
  const Digest a = digest_of_box(1, {0, 0, 0}, {4, 4, 4});
  const Digest b = digest_of_box(2, {4, 0, 0}, {9, 4, 4});
  CHECK(a + b == b + a);
  CHECK(a + b - b == a);
  CHECK(a - a == Digest{});
}

TEST_CASE("digests differ for different axes and materials", "[core][digest]") {
  CHECK(digest_of_box(1, {1, 0, 0}, {2, 1, 1}) != digest_of_box(1, {0, 1, 0}, {1, 2, 1}));
  CHECK(digest_of_box(1, {0, 1, 0}, {1, 2, 1}) != digest_of_box(1, {0, 0, 1}, {1, 1, 2}));
  CHECK(digest_of_box(1, {0, 0, 0}, {1, 1, 1}) != digest_of_box(2, {0, 0, 0}, {1, 1, 1}));
}

TEST_CASE("a world digest's terms depend on key and chunk, and empty chunks add nothing",
          "[core][digest]") {
  const Digest chunk = digest_of_box(1, {0, 0, 0}, {4, 4, 4});
  const ChunkKey key{0, {1, -2, 3}};
  const Digest term = world_digest_term(key, chunk);
  CHECK(world_digest_term(key, Digest{}) == Digest{});
  CHECK(term != Digest{});
  CHECK(term.lane[0] < m61::kPrime);
  CHECK(term.lane[1] < m61::kPrime);
  CHECK(world_digest_term({1, {1, -2, 3}}, chunk) != term);
  CHECK(world_digest_term({0, {-2, 1, 3}}, chunk) != term);
  CHECK(world_digest_term({0, {1, -2, 4}}, chunk) != term);
  CHECK(world_digest_term(key, digest_of_box(1, {0, 0, 0}, {4, 4, 5})) != term);
}

TEST_CASE("digests print as 32 hexadecimal digits, lane 0 first", "[core][digest]") {
  CHECK(to_hex(Digest{{0x1, 0x1fedcba987654321}}) == "00000000000000011fedcba987654321");
  CHECK(to_hex(Digest{}) == std::string(32, '0'));
}
