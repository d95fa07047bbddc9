// Scenes that are small enough to count by hand, and the promises of the functions beyond the
// faces.
#include <catch2/catch.hpp>
#include <limits>

#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/reference/binary_greedy.hpp"
#include "tests/reference/bit_matrix.hpp"
#include "tests/reference/culled_mesher.hpp"
#include "tests/reference/dense_bytes.hpp"
#include "tests/reference/grid_rdm.hpp"
#include "tests/reference/palette_decode.hpp"
#include "tests/reference/rle_rdm.hpp"
#include "tests/reference/row_compare.hpp"
#include "tests/reference/simple_mesher.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

using namespace reference;

constexpr Extent kSmall = Extent::cube(8);

void put(MeshScene& scene, LocalPos at, Material material) {
  fill(scene.chunk, index_of(at, scene.chunk.extent, scene.chunk.order), 1, material);
}

struct Counts {
  std::size_t simple, culled, grid, rle, binary;
  friend bool operator==(const Counts&, const Counts&) = default;
};

Counts quads_of(const MeshScene& scene) {
  const DenseGrid grid = grid_of(scene);
  Counts out{};
  std::vector<Quad> quads;
  mesh_simple(grid, mesh_visibility(), quads);
  out.simple = quads.size();
  mesh_culled(grid, mesh_visibility(), quads);
  out.culled = quads.size();
  GridRdmScratch grid_rdm;
  mesh_grid_rdm(grid, mesh_visibility(), grid_rdm, quads);
  out.grid = quads.size();
  mesh_rle_rdm(reorder(scene.chunk, AxisOrder::zyx), mesh_visibility(), quads);
  out.rle = quads.size();
  BinaryScratch binary;
  ChunkMesh mesh;
  mesh_binary_greedy(grid, mesh_visibility(), binary, mesh);
  out.binary = mesh.quad_count();
  return out;
}

TEST_CASE("one voxel is six quads to every mesher, an empty chunk none", "[mesh][reference]") {
  MeshScene scene{uniform_chunk(kSmall, kEmpty), {}};
  CHECK(quads_of(scene) == Counts{0, 0, 0, 0, 0});
  put(scene, {3, 4, 5}, kStone);
  CHECK(quads_of(scene) == Counts{6, 6, 6, 6, 6});
}

TEST_CASE("two voxels of one material lose the faces between them and merge", "[mesh][reference]") {
  MeshScene scene{uniform_chunk(kSmall, kEmpty), {}};
  put(scene, {3, 4, 5}, kStone);
  put(scene, {3, 4, 6}, kStone);  // along z, the thesis' run axis
  CHECK(quads_of(scene) == Counts{12, 10, 6, 6, 6});
  put(scene, {3, 4, 6}, kDirt);
  CHECK(quads_of(scene) == Counts{12, 10, 10, 12, 10});
  put(scene, {3, 4, 6}, kEmpty);
  put(scene, {4, 4, 5}, kStone);  // along x: the prototype culls nothing
  CHECK(quads_of(scene) == Counts{12, 10, 6, 12, 6});
}

TEST_CASE("equal transparent materials hide each other, different ones do not",
          "[mesh][reference]") {
  for (const bool along_x : {true, false}) {
    const LocalPos beside = along_x ? LocalPos{4, 4, 5} : LocalPos{3, 4, 6};
    MeshScene scene{uniform_chunk(kSmall, kEmpty), {}};
    put(scene, {3, 4, 5}, kWater);
    put(scene, beside, kWater);
    CHECK(quads_of(scene).culled == 10);
    CHECK(quads_of(scene).binary == 6);
    put(scene, beside, kGlass);
    CHECK(quads_of(scene).culled == 12);
    CHECK(quads_of(scene).binary == 12);
    put(scene, beside, kStone);
    CHECK(quads_of(scene).culled == 11);
    CHECK(quads_of(scene).binary == 11);
    put(scene, beside, kBarrier);
    CHECK(quads_of(scene).culled == 6);
    CHECK(quads_of(scene).binary == 6);
  }
}

TEST_CASE("a neighbour hides faces at the border by the same rule", "[mesh][reference]") {
  const auto quads_beside = [](Material own, Material beyond) {
    MeshScene scene{uniform_chunk(kSmall, own), {}};
    for (auto& n : scene.neighbours) n = uniform_chunk(Extent{8, 8, 8}, beyond, AxisOrder::yzx);
    const Counts counts = quads_of(scene);
    CHECK(counts.culled == 64 * counts.binary);
    CHECK(counts.grid == counts.binary);
    return counts.binary;
  };
  CHECK(quads_beside(kStone, kStone) == 0);
  CHECK(quads_beside(kStone, kDirt) == 0);
  CHECK(quads_beside(kStone, kWater) == 6);
  CHECK(quads_beside(kStone, kEmpty) == 6);
  CHECK(quads_beside(kWater, kStone) == 0);
  CHECK(quads_beside(kWater, kWater) == 0);
  CHECK(quads_beside(kWater, kGlass) == 6);
  CHECK(quads_beside(kWater, kBarrier) == 6);
}

TEST_CASE("the grid variant joins rows only if they are alike", "[mesh][reference]") {
  // An L of 3 + 2 on the floor: binary greedy and the grid variant cut it in different ways, both
  // into two.
  MeshScene scene{uniform_chunk(kSmall, kEmpty), {}};
  for (const LocalPos at : {LocalPos{1, 1, 1}, LocalPos{1, 1, 2}, LocalPos{1, 1, 3},
                            LocalPos{2, 1, 1}, LocalPos{2, 1, 2}}) {
    put(scene, at, kStone);
  }
  std::vector<Quad> quads;
  GridRdmScratch scratch;
  mesh_grid_rdm(grid_of(scene), mesh_visibility(), scratch, quads);
  std::vector<QuadFields> up;
  for (const Quad quad : quads) {
    if (unpack(quad).direction == Direction::pos_y) up.push_back(unpack(quad));
  }
  REQUIRE(up.size() == 2);
  // Along z first: u of a y face.
  CHECK(up[0] == QuadFields{1, 1, 1, 3, 1, Direction::pos_y, kStone});
  CHECK(up[1] == QuadFields{2, 1, 1, 2, 1, Direction::pos_y, kStone});
}

TEST_CASE("tail culling: a full chunk keeps all but the first layers' backs", "[mesh][reference]") {
  // 64 lines with +x, +y, +z, -z. Only the first slow layer has -x, and only the first line of each
  // layer has -y.
  MeshScene scene{uniform_chunk(kSmall, kStone), {}};
  CHECK(quads_of(scene).rle == 64 * 4 + 8 + 8);
}

TEST_CASE("binary greedy makes the same mesh from runs, bytes and a grid, and with its mask ready",
          "[mesh][reference]") {
  SplitMix64 rng(5);
  BinaryScratch scratch;
  OccupancyMask mask;
  PaletteVolume volume;
  ChunkMesh ready, from_grid, from_runs, from_dense, from_padded;
  const auto same = [](const ChunkMesh& a, const ChunkMesh& b) {
    return a.opaque.quads == b.opaque.quads && a.opaque.first == b.opaque.first &&
           a.transparent.quads == b.transparent.quads && a.transparent.first == b.transparent.first;
  };
  std::size_t compared = 0;
  for (int round = 0; round < 400; ++round) {
    const MeshScene scene = random_scene(rng, round % 4 == 0 ? kBinarySideMax : kPaddedSideMax);
    const DenseGrid grid = grid_of(scene);
    occupancy_of(grid, mesh_visibility(), mask);
    mesh_binary_greedy(grid, mask, scratch, ready);
    mesh_binary_greedy(grid, mesh_visibility(), scratch, from_grid);
    mesh_binary_greedy(scene.chunk, scene.pointers(), mesh_visibility(), scratch, from_runs);
    REQUIRE(same(ready, from_grid));
    REQUIRE(same(ready, from_runs));
    if (!scratch.volume.mask.one_transparent) ++compared;
    const auto dense = dense_bytes(scene.chunk, mesh_visibility());
    REQUIRE(dense);
    std::array<std::optional<DenseBytes>, kDirectionCount> beside;
    reference::DenseNeighbours neighbours{};
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (!scene.neighbours[d]) continue;
      beside[d] = dense_bytes(reorder(*scene.neighbours[d], scene.chunk.order), mesh_visibility());
      neighbours[d] = &*beside[d];
    }
    fill_volume(*dense, neighbours, mesh_visibility(), volume);
    mesh_binary_greedy(volume, scratch, from_dense);
    REQUIRE(same(ready, from_dense));
    const OrderedExtent e = grid.sides();
    if (std::max({e.f, e.m, e.s}) > kPaddedSideMax) continue;
    const auto padded = padded_runs(scene.chunk, scene.pointers());
    REQUIRE(padded);
    decode_palette(*padded, mesh_visibility(), volume);
    mesh_binary_greedy(volume, scratch, from_padded);
    REQUIRE(same(ready, from_padded));
  }
  CHECK(compared > 50);
}

TEST_CASE("a chunk with more materials than a palette has ids is meshed as well",
          "[mesh][reference]") {
  constexpr Extent kWide{16, 16, 8};
  RunBuilder builder(kWide, AxisOrder::xyz);
  for (std::uint32_t i = 0; i < kWide.volume(); ++i)
    builder.append(1, static_cast<Material>(1000 + i % 700));
  const MeshScene scene{builder.finish(), {}};
  CHECK_FALSE(padded_runs(scene.chunk, scene.pointers()));
  const auto before = dense_expansions();
  BinaryScratch scratch;
  ChunkMesh mesh;
  mesh_binary_greedy(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
  CHECK(dense_expansions() > before);
  CHECK(mesh.opaque.quads.size() == 2 * (16 * 16 + 16 * 8 + 16 * 8));
}

TEST_CASE("decoding counts as a dense expansion, and so does sampling an octree",
          "[mesh][reference]") {
  const MeshScene scene{uniform_chunk(kSmall, kStone), {}};
  std::uint64_t before = dense_expansions();
  DenseGrid grid = grid_of(scene);
  CHECK(dense_expansions() == before + 1);
  MaterialOctree octree({0, 0, 0}, 0);
  octree.insert({0, 0, 0}, scene.chunk);
  before = dense_expansions();
  grid.reset(kSmall, AxisOrder::xyz);
  octree.sample({0, 0, 0}, grid);
  CHECK(dense_expansions() == before + 1);
}

TEST_CASE("the culled mesher times its phases by the clock it is given", "[mesh][reference]") {
  static std::uint64_t ticks;
  ticks = 100;
  const Clock clock = [] { return ticks *= 3; };
  MaterialOctree octree({0, 0, 0}, 1);
  octree.insert({8, 8, 8}, uniform_chunk(kSmall, kStone));
  octree.compact();
  DenseGrid grid;
  std::vector<Quad> quads;
  const CulledPhases phases =
      mesh_culled(octree, {8, 8, 8}, kSmall, mesh_visibility(), clock, grid, quads);
  CHECK(phases.octree == 900 - 300);
  CHECK(phases.meshing == 2700 - 900);
  CHECK(quads.size() == 6 * 64);
}

TEST_CASE("a transposed bit matrix has rows for columns", "[mesh][reference]") {
  SplitMix64 rng(6);
  std::array<std::uint64_t, 64> rows{}, turned{};
  for (auto& row : rows) row = rng.next();
  turned = rows;
  transpose_bits(turned.data());
  int wrong = 0;
  for (unsigned r = 0; r < 64; ++r) {
    for (unsigned c = 0; c < 64; ++c) wrong += (rows[r] >> c & 1) != (turned[c] >> r & 1) ? 1 : 0;
  }
  CHECK(wrong == 0);
}

TEMPLATE_TEST_CASE("rows of voxels compare bit by bit and up to their first difference",
                   "[mesh][reference]", Material, PaletteId) {
  constexpr TestType kOther = std::numeric_limits<TestType>::max(), kSame = 9;
  SplitMix64 rng(7);
  std::array<TestType, 64 + 1 + kCompareSlack> a{}, b{};
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t count = 1 + rng.below(64);
    const std::uint32_t rarity = 1 + rng.below(30);
    for (std::size_t i = 0; i < a.size(); ++i) {
      a[i] = rng.below(rarity) == 0 ? kOther : kSame;
      b[i] = rng.below(rarity) == 0 ? kOther : kSame;
    }
    std::uint64_t differ = 0;
    std::uint32_t prefix = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      differ |= std::uint64_t{a[i] != b[i]} << i;
      prefix += prefix == i && a[i] == kSame ? 1u : 0u;
    }
    REQUIRE(differing_bits(a.data(), b.data(), count) == differ);
    REQUIRE(equal_prefix(a.data(), count, kSame) == prefix);
  }
}

}  // namespace
}  // namespace runstone::test
