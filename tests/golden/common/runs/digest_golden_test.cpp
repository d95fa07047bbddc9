// Pinned digests of fixed voxels. Digests are compared, stored and logged. If one of these values
// changes, every world's digest changes, and the changelog must say so.
#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/runs/dense_chunk.hpp"

using namespace runstone;

namespace {

template <class F>
RunChunk chunk_of(Extent extent, AxisOrder order, F&& material) {
  RunBuilder builder(extent, order);
  for (VoxelIndex i = 0; i < extent.volume(); ++i) {
    const LocalPos p = pos_of(i, extent, order);
    builder.append(1, static_cast<Material>(material(p.x, p.y, p.z)));
  }
  return builder.finish();
}

Material noise(unsigned x, unsigned y, unsigned z) {
  return static_cast<Material>(mix64(x | y << 8 | z << 16) % 5);
}
Material hills(unsigned x, unsigned y, unsigned z) {
  const unsigned height = 10 + static_cast<unsigned>(mix64(x / 4 | z / 4 << 8) % 9);
  return static_cast<Material>(y + 3 < height ? 1 : y < height ? 2 : y < 14 ? 40000 : 0);
}

}  // namespace

TEST_CASE("pinned digests hold in every axis order, from runs and from single voxels",
          "[runs][golden]") {
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(static_cast<int>(order));
    const RunChunk one = chunk_of({8, 8, 8}, order, [](unsigned x, unsigned y, unsigned z) {
      return x == 1 && y == 2 && z == 3 ? 1 : 0;
    });
    const RunChunk noisy = chunk_of({9, 20, 33}, order, noise);
    const RunChunk hilly = chunk_of(Extent::cube(32), order, hills);
    const RunChunk wide = chunk_of({128, 40, 64}, order, hills);
    CHECK(to_hex(digest_of(uniform_chunk(Extent::cube(32), kEmpty, order))) ==
          std::string(32, '0'));
    CHECK(to_hex(digest_of(uniform_chunk(Extent::cube(32), 1, order))) ==
          "1d097e98f4fc282407cd14195a2e2b9a");
    CHECK(to_hex(digest_of(one)) == "010a51814835306010b093d3d6f74a73");
    CHECK(to_hex(digest_of(noisy)) == "00c6d3db03ac40751d08f08a3fe2040d");
    CHECK(to_hex(digest_of(hilly)) == "016e6d07e9655fbd15bde0778fabff27");
    CHECK(to_hex(digest_of(wide)) == "1edededfcfb868700f51521ec088d003");
    CHECK(test::DenseChunk::of(one).digest() == digest_of(one));
    CHECK(test::DenseChunk::of(noisy).digest() == digest_of(noisy));
    CHECK(test::DenseChunk::of(hilly).digest() == digest_of(hilly));
  }
}

TEST_CASE("pinned world digest terms", "[runs][golden]") {
  const Digest chunk = digest_of(uniform_chunk(Extent::cube(32), 1));
  CHECK(to_hex(world_digest_term({0, {0, 0, 0}}, chunk)) == "070d9379bdcf15221a802a2f95094477");
  CHECK(to_hex(world_digest_term({2, {1, -2, 3}}, chunk)) == "10f21c2c426eae7e16c6f00d44f31a88");
}

TEST_CASE("pinned table entries", "[runs][golden]") {
  CHECK(digest_material(0, 1) == 0x13a0eb80b285f4d7ULL);
  CHECK(digest_material(1, 65535) == 0xc783ad849d9f432ULL);
  CHECK(digest_axis_sum(0, Axis::x, 0, 1) == 0xb92844c9f9dc59eULL);
  CHECK(digest_axis_sum(1, Axis::z, 0, 128) == 0xc77b64731944777ULL);
}
