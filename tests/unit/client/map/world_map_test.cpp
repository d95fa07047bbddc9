#include "client/map/world_map.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

struct MapBench : ToolBench {
  MapBench() { map.set_materials(default_material_table()); }
  /// Passes changes to the map and draws until nothing is left.
  void draw(double x = 0, double z = 0) {
    map.take(replica.drain_changes());
    do {
      map.step(replica, x, z);
    } while (map.is_drawing());
  }
  /// The top of a column, voxel by voxel.
  std::optional<ColumnTop> shown_top(std::int32_t x, std::int32_t z) const {
    for (std::int32_t y = 2 * kEdge - 1; y >= -2 * kEdge; --y) {
      const auto material = replica.shown_at({x, y, z});
      if (material && *material != kEmpty) return ColumnTop{y, *material};
    }
    return std::nullopt;
  }
  void check_all() const {
    for (std::int32_t z = -2 * kEdge; z < 2 * kEdge; z += 3) {
      for (std::int32_t x = -2 * kEdge; x < 2 * kEdge; x += 3) {
        CAPTURE(x, z);
        CHECK(map.top(x, z) == shown_top(x, z));
      }
    }
  }
  WorldMap map;
};

}  // namespace

TEST_CASE("the map shows the tops of all shown chunks, and follows edits", "[client_map]") {
  MapBench bench;
  bench.show_random();
  bench.map.open(bench.replica);
  bench.draw();
  CHECK(bench.map.tiles().size() == 16);
  bench.check_all();
  for (const auto& [key, tile] : bench.map.tiles()) CHECK(tile.image != nullptr);
  bench.predict(
      {{FillSphere{{3, 20, -7}, 6}, {}, 2}, {FillBox{{{-20, -32, 4}, {-4, 32, 9}}}, {}, 0}});
  bench.draw();
  bench.check_all();
}

TEST_CASE("an edit redraws its column, and a neighbour only if the border changed",
          "[client_map]") {
  MapBench bench;
  bench.show_flat();
  bench.map.open(bench.replica);
  bench.draw();
  const auto images = [&] {
    std::map<MapTileKey, const OverlayImage*> out;
    for (const auto& [key, tile] : bench.map.tiles()) out[key] = tile.image.get();
    return out;
  };
  const auto changed = [](const auto& a, const auto& b) {
    std::set<MapTileKey> out;
    for (const auto& [key, image] : a) {
      if (b.at(key) != image) out.insert(key);
    }
    return out;
  };
  const auto before = images();
  bench.predict({{SetVoxel{{5, 0, 5}}, {}, 3}});
  bench.draw();
  const auto inner = images();
  CHECK(changed(before, inner) == std::set<MapTileKey>{{0, 0}});
  bench.predict({{SetVoxel{{15, 0, 5}}, {}, 3}});
  bench.draw();
  CHECK(changed(inner, images()) == std::set<MapTileKey>{{0, 0}, {0, 1}, {1, 0}});
}

TEST_CASE("a closed map holds nothing and takes nothing", "[client_map]") {
  MapBench bench;
  bench.show_flat();
  bench.draw();
  CHECK(bench.map.tiles().empty());
  bench.map.open(bench.replica);
  bench.draw();
  CHECK(bench.map.bytes() > 0);
  bench.map.close();
  CHECK(bench.map.bytes() == 0);
  CHECK(bench.map.tiles().empty());
  CHECK_FALSE(bench.map.top(0, 0).has_value());
}

TEST_CASE("chunks that leave the view leave the map", "[client_map]") {
  MapBench bench;
  bench.show_flat();
  bench.map.open(bench.replica);
  bench.draw();
  bench.replica.set_view({2, {1, 0, 1}, 0, 3});
  bench.draw();
  REQUIRE(bench.map.tiles().size() == 1);
  CHECK(bench.map.tiles().begin()->first == MapTileKey{1, 1});
}

TEST_CASE("a step has bounded work, and near tiles come first", "[client_map]") {
  constexpr std::int32_t kBigEdge = 64;
  Replica replica;
  replica.set_view({1, {0, 0, 0}, 8, 0});
  static_cast<void>(replica.open({kBigEdge, 5, 77, 3, 0, 0, 0}));
  SplitMix64 rng(5);
  for (std::int32_t x = -4; x < 4; ++x) {
    for (std::int32_t z = -4; z < 4; ++z) {
      ChunkSnapshot snapshot;
      snapshot.key = {0, {x, 0, z}};
      snapshot.chunk.voxels =
          random_chunk(rng, Extent::cube(kBigEdge), AxisOrder::xzy, 4, ChunkShape::spheres);
      snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
      replica.receive(chunks_of(std::move(snapshot)), {1000, 1100, 1200});
    }
  }
  WorldMap map;
  map.set_materials(default_material_table());
  map.open(replica);
  CHECK(map.step(replica, 200, 200));
  const std::size_t first = map.tiles().size();
  CHECK(first > 0);
  CHECK(first < 64);
  CHECK(map.tiles().contains({3, 3}));
  CHECK(map.is_drawing());
  for (int i = 0; i < 1'000 && map.is_drawing(); ++i) map.step(replica, 200, 200);
  CHECK(map.tiles().size() == 64);
  CHECK(map.bytes() <= WorldMap::kBytesMax);
}

}  // namespace runstone::test
