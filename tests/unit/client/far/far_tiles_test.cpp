#include "client/far/far_tiles.hpp"

#include <catch2/catch.hpp>

#include "common/core/tile_keys.hpp"
#include "protocol/codec/view_tiles.hpp"
#include "tests/unit/client/far/some_tile.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

View view_at(ChunkCoord centre, std::uint8_t levels) {
  View view;
  view.centre = centre;
  view.radius_h = 3;
  view.radius_v = 2;
  view.levels = levels;
  return view;
}

}  // namespace

TEST_CASE("tiles outside of the view and tiles of another edge are ignored", "[far]") {
  SplitMix64 rng{1};
  FarTiles tiles;
  CHECK_FALSE(tiles.receive({1, {0, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  tiles.set_view(view_at({0, 0, 0}, 2), kTileEdge);
  CHECK(tiles.receive({1, {0, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  CHECK_FALSE(tiles.receive({3, {0, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  CHECK_FALSE(tiles.receive({1, {4, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  CHECK_FALSE(tiles.receive({1, {1, 0, 0}}, Chunk{uniform_chunk(Extent::cube(32), 1), {}, {}}));
  CHECK_FALSE(tiles.receive_uniform({1, {1 << 29, 0, 0}}, 1));
  CHECK(tiles.count() == 1);
}

TEST_CASE("a view that moves drops the tiles that it left, and a smaller one those of its levels",
          "[far]") {
  SplitMix64 rng{2};
  FarTiles tiles;
  tiles.set_view(view_at({0, 0, 0}, 2), kTileEdge);
  REQUIRE(tiles.receive({1, {-3, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  REQUIRE(tiles.receive({2, {-1, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  CHECK(tiles.drain_changes() == std::vector<ChunkKey>{{1, {-3, 0, 0}}, {2, {-1, 0, 0}}});
  tiles.set_view(view_at({4, 0, 0}, 2), kTileEdge);
  CHECK(tiles.find({1, {-3, 0, 0}}) == nullptr);
  CHECK(tiles.find({2, {-1, 0, 0}}) != nullptr);
  CHECK(tiles.drain_changes() == std::vector<ChunkKey>{{1, {-3, 0, 0}}});
  tiles.set_view(view_at({4, 0, 0}, 1), kTileEdge);
  CHECK(tiles.count() == 0);
  CHECK(tiles.bytes() == 0);
}

TEST_CASE("an empty tile drops what is below it", "[far]") {
  SplitMix64 rng{3};
  FarTiles tiles;
  tiles.set_view(view_at({0, 0, 0}, 3), kTileEdge);
  const ChunkKey top{3, {0, 0, 0}};
  const ChunkKey middle = tile_child(top, 5), low = tile_child(middle, 2);
  const ChunkKey beside{1, {-1, 0, 0}};
  for (const ChunkKey& key : {top, middle, low, beside})
    REQUIRE(tiles.receive(key, Chunk{some_tile(rng), {}, {}}));
  tiles.drain_changes();
  CHECK(tiles.solid_count() == 4);
  REQUIRE(tiles.receive_uniform(top, kEmpty));
  CHECK(tiles.count() == 2);
  CHECK(tiles.solid_count() == 1);
  CHECK(is_empty(*tiles.find(top)));
  CHECK(tiles.find(beside) != nullptr);
  CHECK(tiles.drain_changes() == std::vector<ChunkKey>{low, middle, top});
}

TEST_CASE("a tile that is sent again with the same voxels changes nothing", "[far]") {
  SplitMix64 rng{4};
  FarTiles tiles;
  tiles.set_view(view_at({0, 0, 0}, 2), kTileEdge);
  const RunChunk tile = some_tile(rng);
  REQUIRE(tiles.receive({1, {0, 0, 0}}, Chunk{tile, {}, {}}));
  REQUIRE(tiles.receive_uniform({1, {1, 0, 0}}, 3));
  tiles.drain_changes();
  const std::size_t bytes = tiles.bytes();
  CHECK(tiles.receive({1, {0, 0, 0}}, Chunk{tile, {}, {}}));
  CHECK(tiles.receive_uniform({1, {1, 0, 0}}, 3));
  CHECK(tiles.drain_changes().empty());
  CHECK(tiles.bytes() == bytes);
}

TEST_CASE("random tiles and views keep the tiles within the view and their bytes right",
          "[far][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  CAPTURE(Catch::rngSeed());
  FarTiles tiles;
  View view = view_at({0, 0, 0}, 3);
  tiles.set_view(view, kTileEdge);
  for (int step = 0; step < 3'000; ++step) {
    const auto near = [&](std::uint32_t n) {
      return static_cast<std::int32_t>(rng.below(n)) - static_cast<std::int32_t>(n / 2);
    };
    if (rng.below(40) == 0) {
      view = view_at({near(40), near(10), near(40)}, static_cast<std::uint8_t>(rng.below(4)));
      tiles.set_view(view, kTileEdge);
    }
    const ChunkKey key{static_cast<std::uint8_t>(1 + rng.below(4)), {near(16), near(8), near(16)}};
    const bool is_in_view = has_key(view, CoordLimit::of(kTileEdge), key);
    if (rng.below(2) == 0) {
      REQUIRE(tiles.receive(key, Chunk{some_tile(rng), {}, {}}) == is_in_view);
    } else {
      REQUIRE(tiles.receive_uniform(key, static_cast<Material>(rng.below(3))) == is_in_view);
    }
  }
  view.levels = 0;
  tiles.set_view(view, kTileEdge);
  CHECK(tiles.count() == 0);
  CHECK(tiles.solid_count() == 0);
  CHECK(tiles.bytes() == 0);
}

TEST_CASE("tiles are missing until they or an empty one above them are held", "[far]") {
  SplitMix64 rng{7};
  FarTiles tiles;
  CHECK(tiles.missing().roots == 0);
  const View view = view_at({0, 0, 0}, 2);
  tiles.set_view(view, kTileEdge);
  const CoordLimit world = CoordLimit::of(kTileEdge);
  std::vector<ChunkKey> roots;
  for (std::int32_t x = -3; x <= 3; ++x) {
    for (std::int32_t y = -2; y <= 2; ++y) {
      for (std::int32_t z = -3; z <= 3; ++z) {
        if (has_key(view, world, {2, {x, y, z}})) roots.push_back({2, {x, y, z}});
      }
    }
  }
  CHECK(tiles.missing().roots == roots.size());
  for (const ChunkKey& root : roots) {
    if (root.at == ChunkCoord{}) {
      REQUIRE(tiles.receive(root, Chunk{some_tile(rng), {}, {}}));
    } else {
      REQUIRE(tiles.receive_uniform(root, kEmpty));
    }
  }
  CHECK(tiles.missing().roots == 0);
  CHECK(tiles.missing().others == kTileChildren);
  REQUIRE(tiles.receive_uniform({1, {0, 0, 0}}, kEmpty));
  REQUIRE(tiles.receive({1, {1, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  CHECK(tiles.missing().others == kTileChildren - 2);
  REQUIRE(tiles.receive_uniform({2, {0, 0, 0}}, kEmpty));
  CHECK(tiles.missing().others == 0);
}
