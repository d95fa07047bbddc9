// The hidden case prints what it takes to make tiles of generated ground, and to save and read them.
// docs/tiles.md has the figures and the rule that follows from them.
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/os/steady_clock.hpp"
#include "common/tiles/tile_rules.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/tiles/tile_world.hpp"

namespace runstone::test {
namespace {

constexpr std::uint16_t kEdge = 32;

struct Cost {
  std::size_t tiles = 0;  // that are not uniform
  // Of one of them.
  double make_us = 0, save_us = 0, read_us = 0, bytes = 0, disk_bytes = 0;
};

/// Returns the mean time of a tile. `made`: the tiles, without uniform ones.
double make_all(TileSource& source, const std::vector<ChunkKey>& keys,
                const VisibilityTable& visibility,
                std::vector<std::pair<ChunkKey, ChunkPtr>>* made) {
  double us = 0;
  std::size_t count = 0;
  for (const ChunkKey& key : keys) {
    const TimeUs start = steady_now_us();
    const auto tiles = source.make({key, 0, {}}, visibility);
    const TimeUs end = steady_now_us();
    REQUIRE(tiles.has_value());
    if (tiles->back().tile->voxels.is_uniform()) continue;
    us += static_cast<double>(end - start);
    ++count;
    if (made != nullptr) made->emplace_back(key, tiles->back().tile);
  }
  return us / static_cast<double>(count);
}

Cost cost_of(const GeneratorPin& pin, std::uint8_t level) {
  const TempFolder folder;
  WorldMeta meta = sample_meta();
  meta.generator = pin;
  meta.chunk_edge = kEdge;
  const auto generator = *make_generator(pin, meta.materials);
  const VisibilityTable visibility(visibilities(meta.materials));
  std::vector<ChunkKey> keys;
  for (std::int32_t x = 0; x < 8; ++x) {
    for (std::int32_t z = 0; z < 8; ++z) {
      for (std::int32_t y = -1; y <= 0; ++y) keys.push_back({level, {x, y, z}});
    }
  }
  Cost cost;
  const auto store = *create_world(folder.path(), meta);
  ChunkSource chunks(folder.path(), *generator);
  TileLedger ledger;
  TileSource::Options no_memory;
  no_memory.cache_bytes = 0;
  TileSource source(chunks, *generator, kEdge, ledger, [](const std::string&) {}, no_memory);
  std::vector<std::pair<ChunkKey, ChunkPtr>> made;
  cost.make_us = make_all(source, keys, visibility, &made);
  cost.tiles = made.size();
  for (const auto& [key, tile] : made)
    cost.bytes += static_cast<double>(encode_chunk(tile->voxels, ChunkEncoding::packed).size());
  cost.bytes /= static_cast<double>(made.size());
  const std::string file = folder / "world.sqlite";
  const auto file_bytes = [&] {
    REQUIRE(raw_sql(file, "PRAGMA wal_checkpoint(TRUNCATE)") == "0");
    return static_cast<double>(std::filesystem::file_size(file));
  };
  const double before = file_bytes();
  const TimeUs start = steady_now_us();
  REQUIRE(store->save_tiles(made, kTileRules).has_value());
  cost.save_us = static_cast<double>(steady_now_us() - start) / static_cast<double>(made.size());
  cost.disk_bytes = (file_bytes() - before) / static_cast<double>(made.size());
  std::vector<ChunkKey> stored;
  for (const auto& [key, tile] : made) stored.push_back(key);
  cost.read_us = make_all(source, stored, visibility, nullptr);
  return cost;
}

}  // namespace

TEST_CASE("the cost of tiles of generated ground", "[.cost]") {
  for (const GeneratorPin& pin :
       {GeneratorPin{"terrain", 1, 7, ""}, GeneratorPin{"flat", 1, 7, ""}}) {
    for (std::uint8_t level = 1; level <= 2; ++level) {
      const Cost cost = cost_of(pin, level);
      std::printf(
          "%s level %d: %zu tiles, made in %.0f us, saved in %.0f us, read in %.0f us, %.0f bytes, "
          "%.0f on disk\n",
          pin.name.c_str(), int{level}, cost.tiles, cost.make_us, cost.save_us, cost.read_us,
          cost.bytes, cost.disk_bytes);
    }
  }
}

}  // namespace runstone::test
