// Tiles of the map are compared with a dense oracle: every voxel of every column is looked at, from
// above, in chunks that a plain replay made.
#include "server/map/map_drawer.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "common/map/map_painter.hpp"
#include "common/runs/reorder.hpp"
#include "server/map/map_world.hpp"
#include "server/store/store.hpp"
#include "server/store/world_folder.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/map/png_pixels.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr std::int32_t kSide = kMapTileSide;

/// The chunks of a level by place: those of level 0 as a plain replay makes them.
using DenseLevel = std::map<ChunkCoord, RunChunk>;

DenseLevel chunks_at(const std::string& folder, Sequence at) {
  const auto reader = open_world(folder, StoreAccess::read_only);
  REQUIRE(reader.has_value());
  const auto generator = generator_of(**reader);
  REQUIRE(generator.has_value());
  auto world = WorldAt::open(**reader, **generator, at);
  REQUIRE(world.has_value());
  DenseLevel out;
  for (const ChunkKey& key : world->edited()) out[key.at] = world->chunk(key)->voxels;
  return out;
}

/// The tiles above a level.
DenseLevel level_above(const DenseLevel& below, const VisibilityTable& visibility) {
  DenseLevel out;
  TileScratch scratch;
  for (const auto& [at, ignored] : below) {
    const ChunkKey parent = tile_parent({0, at});
    if (out.contains(parent.at)) continue;
    TileChildren children{};
    for (unsigned i = 0; i < kTileChildren; ++i) {
      const auto found = below.find(tile_child({1, parent.at}, i).at);
      if (found != below.end()) children[i] = &found->second;
    }
    out[parent.at] = build_tile(children, kSampleEdge, kTileOrder, visibility, scratch);
  }
  return out;
}

std::vector<std::uint32_t> oracle_picture(const DenseLevel& level, const MapPlace& place,
                                          const MapMaterials& materials) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::pair<ChunkCoord, DenseChunk>>>
      columns;
  for (const auto& [at, voxels] : level)
    columns[{at.x, at.z}].emplace_back(at, DenseChunk::of(voxels));
  const auto top_of = [&](std::int32_t x, std::int32_t z, const ShowingMaterials& showing) {
    ColumnTop top;
    for (const auto& [at, dense] :
         columns[{floor_div(x, kSampleEdge), floor_div(z, kSampleEdge)}]) {
      for (int y = kSampleEdge - 1; y >= 0; --y) {
        const Material id = dense.at(x - at.x * kSampleEdge, y, z - at.z * kSampleEdge);
        const std::int32_t height = at.y * kSampleEdge + y;
        if (id < showing.size() && !showing[id]) continue;
        if (height > top.y) top = {height, id};
        break;
      }
    }
    return top;
  };
  MapTops tops(kSide);
  tops.ground.resize(tops.surface.size());
  std::vector<ColumnTop> west(kSide), north(kSide);
  const std::int32_t first_x = place.x * kSide, first_z = place.z * kSide;
  for (std::int32_t z = -1; z < kSide; ++z) {
    for (std::int32_t x = -1; x < kSide; ++x) {
      // Edits of the sample lie near the origin.
      if (std::abs(first_x + x) > 96 || std::abs(first_z + z) > 96) continue;
      const ColumnTop surface = top_of(first_x + x, first_z + z, materials.showing);
      if (x < 0 && z < 0) continue;
      if (x < 0) west[static_cast<std::size_t>(z)] = surface;
      if (z < 0) north[static_cast<std::size_t>(x)] = surface;
      if (x < 0 || z < 0) continue;
      const auto at = static_cast<std::size_t>(x + kSide * z);
      tops.surface[at] = surface;
      tops.ground[at] = top_of(first_x + x, first_z + z, materials.ground);
    }
  }
  return paint_map(tops, west, north, materials, 1 << place.zoom);
}

/// A world with a log of edits near the origin.
struct SampleWorld {
  explicit SampleWorld(std::size_t edits) : folder(temp / "world") {
    auto created = create_world(folder, sample_meta());
    REQUIRE(created.has_value());
    store = *std::move(created);
    REQUIRE(store->raise_epoch().has_value());
    add(edits);
  }
  void add(std::size_t edits) {
    const auto records = sample_records(rng, 1, count + 1, edits);
    REQUIRE(store->append({}, records).has_value());
    count += edits;
  }
  const TempFolder temp;
  const std::string folder;
  std::unique_ptr<Store> store;
  SplitMix64 rng{Catch::rngSeed()};
  Sequence count = 0;
};

std::vector<std::uint32_t> draw(MapWorld& world, const MapMoment& moment, const MapPlace& place) {
  const auto picture = world.draw(moment, place, [] { return true; });
  REQUIRE(picture.has_value());
  return pixels_of(**picture);
}

MapMaterials sample_materials() { return map_materials(sample_meta().materials); }

}  // namespace

TEST_CASE("tiles of the present and of the past are those of the dense oracle", "[map]") {
  SampleWorld sample(40);
  MapCaches caches(std::size_t{64} << 20);
  MapWorld world(sample.folder, caches);
  REQUIRE(world.refresh(1, 0).has_value());
  const MapMaterials materials = sample_materials();
  CAPTURE(Catch::rngSeed());
  for (const MapPlace& place : {MapPlace{0, 0, 0}, MapPlace{0, -1, -1}, MapPlace{0, -1, 0}}) {
    CAPTURE(place.x, place.z);
    const DenseLevel chunks = chunks_at(sample.folder, 40);
    CHECK(draw(world, world.present(), place) == oracle_picture(chunks, place, materials));
    const auto past = world.past(17, {});
    REQUIRE(past.has_value());
    CHECK(draw(world, **past, place) ==
          oracle_picture(chunks_at(sample.folder, 17), place, materials));
  }
  // An oracle without the last edits differs.
  CHECK(draw(world, world.present(), {0, 0, 0}) !=
        oracle_picture(chunks_at(sample.folder, 17), {0, 0, 0}, materials));
}

TEST_CASE("farther tiles are drawn from the tiles that the world's rule makes", "[map]") {
  SampleWorld sample(40);
  MapCaches caches(std::size_t{64} << 20);
  MapWorld world(sample.folder, caches);
  REQUIRE(world.refresh(1, 0).has_value());
  const VisibilityTable visibility(visibilities(sample_meta().materials));
  DenseLevel level = chunks_at(sample.folder, 40);
  CAPTURE(Catch::rngSeed());
  for (std::uint8_t zoom = 1; zoom <= 3; ++zoom) {
    level = level_above(level, visibility);
    const MapPlace place{zoom, -1, 0};
    CAPTURE(zoom);
    CHECK(draw(world, world.present(), place) == oracle_picture(level, place, sample_materials()));
  }
}

TEST_CASE("the present follows the log, and equal versions mean equal pictures", "[map]") {
  SampleWorld sample(20);
  MapCaches caches(std::size_t{64} << 20);
  MapWorld world(sample.folder, caches);
  std::map<std::pair<MapPlace, Version>, std::vector<std::uint32_t>> seen;
  CAPTURE(Catch::rngSeed());
  for (TimeUs round = 1; round <= 20; ++round) {
    REQUIRE(world.refresh(round * 1'000'000, 0).has_value());
    REQUIRE(world.present().at() == sample.count);
    for (const MapPlace& place :
         {MapPlace{0, 0, 0}, MapPlace{0, -1, -1}, MapPlace{1, 0, -1}, MapPlace{0, 5, 5}}) {
      const Version version = MapDrawer::version(world.present(), place);
      caches.clear();
      auto pixels = draw(world, world.present(), place);
      const auto [before, is_new] = seen.try_emplace({place, version}, pixels);
      CHECK(before->second == pixels);
      if (place.x == 5) CHECK(version == Version{});
    }
    sample.add(1);
  }
  CHECK(seen.size() > 8);  // the versions moved
}

TEST_CASE("work that must stop is cancelled, and a world that goes away is an error", "[map]") {
  SampleWorld sample(10);
  MapCaches caches(std::size_t{64} << 20);
  MapWorld world(sample.folder, caches);
  REQUIRE(world.refresh(1, 0).has_value());
  const auto stopped = world.draw(world.present(), {0, 0, 0}, [] { return false; });
  REQUIRE_FALSE(stopped.has_value());
  CHECK(stopped.error().kind == StoreError::Kind::cancelled);
  CHECK_FALSE(world.past(11, {}).has_value());
  std::filesystem::rename(sample.folder, sample.temp / "elsewhere");
  CHECK(world.refresh(100'000, 0).has_value());  // not looked at again so soon
  CHECK_FALSE(world.refresh(10'000'000, 0).has_value());
  std::filesystem::rename(sample.temp / "elsewhere", sample.folder);
  CHECK(world.refresh(20'000'000, 0).has_value());
}
