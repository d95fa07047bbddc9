// Tiles of each kind are pinned. If one of them changes, clients and servers that kept tiles of the
// earlier rules must know: raise kTileRules.
#include "common/tiles/tile_rules.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <memory>
#include <string>

#include "common/core/tile_keys.hpp"
#include "common/generate/generator.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/veil.hpp"

using namespace runstone;

namespace {

constexpr std::int32_t kEdge = 32;

/// Makes tiles of generated ground.
class Ground {
 public:
  explicit Ground(const std::string& generator)
      : visibility_(visibilities(default_material_table())),
        generator_(*make_generator({generator, 1, 7, ""}, default_material_table())) {}

  RunChunk exact(const ChunkKey& key) {
    if (key.lod == 0) return generator_->generate(tile_origin(key, kEdge), Extent::cube(kEdge));
    std::array<RunChunk, kTileChildren> children;
    TileChildren pointers{};
    for (unsigned i = 0; i < kTileChildren; ++i) {
      children[i] = exact(tile_child(key, i));
      pointers[i] = &children[i];
    }
    return build_tile(pointers, kEdge, kTileOrder, visibility_, scratch_);
  }
  /// Returns the form that needs no chunks. Requires a generator that has one.
  RunChunk coarse(const ChunkKey& key) {
    return reorder(*generator_->coarse(tile_origin(key, kEdge), kEdge, key.lod), kTileOrder);
  }
  /// Returns the tile as clients get it. Requires one that the veil changes.
  RunChunk with_veil(const RunChunk& tile) {
    VeilScratch scratch;
    return *veiled(tile, visibility_, scratch);
  }

 private:
  VisibilityTable visibility_;
  std::unique_ptr<Generator> generator_;
  TileScratch scratch_;
};

std::uint64_t lane_of(const RunChunk& tile) { return digest_of(tile).lane[0]; }

}  // namespace

TEST_CASE("tiles of the present rules have these digests", "[tiles][golden]") {
  CHECK(kTileRules == 2);
  Ground terrain("terrain");
  CHECK(lane_of(terrain.exact({1, {0, 0, 0}})) == 0x17f60b19ef40a5b9);
  CHECK(lane_of(terrain.exact({2, {1, 0, -1}})) == 0x161a0c99bf50a0ec);
  CHECK(lane_of(terrain.with_veil(terrain.exact({1, {0, 0, 0}}))) == 0x0c60bcef7c3594fc);
  CHECK(lane_of(terrain.with_veil(terrain.exact({2, {1, 0, -1}}))) == 0x16beca6281e41ca2);
  CHECK(lane_of(terrain.coarse({3, {0, 0, 0}})) == 0x04481c2ae44883bd);
  CHECK(lane_of(terrain.coarse({6, {-1, 0, 2}})) == 0x1fb199d597724595);
}
