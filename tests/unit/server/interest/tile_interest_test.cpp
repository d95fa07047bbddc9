#include "server/interest/tile_interest.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <vector>

#include "common/core/hash.hpp"
#include "tests/unit/server/interest/tile_ground.hpp"

namespace runstone::test {
namespace {

View view_at(ChunkCoord centre, std::uint8_t radius = 3, std::uint8_t levels = 3) {
  View view;
  view.centre = centre;
  view.radius_h = radius;
  view.radius_v = 1;
  view.levels = levels;
  return view;
}

/// Sends all wanted tiles. Returns them in their order, without those that an empty one took along.
std::vector<ChunkKey> send_all(TileInterest& tiles, const TileGround& ground) {
  std::vector<ChunkKey> sent;
  while (const auto key = next_of(tiles)) {
    tiles.set_waiting(*key);
    for (const ChunkKey& gone : tiles.set_sent(*key, ground.is_empty(*key))) std::erase(sent, gone);
    sent.push_back(*key);
  }
  return sent;
}

/// Returns the tiles that a session with this view has when nothing is wanted any more.
std::set<ChunkKey> expected(const View& view, const TileGround& ground) {
  std::set<ChunkKey> all;
  const std::uint8_t levels = tile_levels(view);
  for (std::uint8_t level = levels; level >= 1; --level) {
    const ChunkCoord c = tile_at(view.centre, level);
    const std::int32_t r = view.radius_h;
    for (std::int32_t x = c.x - r; x <= c.x + r; ++x) {
      for (std::int32_t y = c.y - r; y <= c.y + r; ++y) {
        for (std::int32_t z = c.z - r; z <= c.z + r; ++z) {
          const ChunkKey key{level, {x, y, z}};
          const bool is_root = level == levels;
          const bool is_below_ground =
              !is_root && all.contains(tile_parent(key)) && !ground.is_empty(tile_parent(key));
          if (has_key(view, kTileWorld, key) && (is_root || is_below_ground)) all.insert(key);
        }
      }
    }
  }
  return all;
}

bool has(const TileInterest& tiles, const ChunkKey& key) {
  return tiles.status(key) == TileStatus::sent || tiles.status(key) == TileStatus::sent_empty;
}

}  // namespace

TEST_CASE("tiles are wanted from the coarsest level down, the nearest first") {
  const TileGround ground;
  TileInterest tiles(kTileWorld);
  const View view = view_at({0, 0, 0});
  tiles.set_view(view);
  const std::vector<ChunkKey> sent = send_all(tiles, ground);
  const std::set<ChunkKey> all(sent.begin(), sent.end());
  CHECK(all == expected(view, ground));
  CHECK(all.size() == sent.size());
  CHECK(sent.front() == ChunkKey{3, {0, 0, 0}});
  CHECK(std::is_sorted(sent.begin(), sent.end(),
                       [](const ChunkKey& a, const ChunkKey& b) { return a.lod > b.lod; }));
}

TEST_CASE("views that move, grow and lose levels have the tiles of a new session") {
  const TileGround ground;
  TileInterest tiles(kTileWorld);
  SplitMix64 rng(3);
  std::set<ChunkKey> held;
  ChunkCoord centre{0, 0, 0};
  for (int step = 0; step < 200; ++step) {
    centre = {centre.x + rng.between(-3, 3), centre.y + rng.between(-1, 1),
              centre.z + rng.between(-3, 3)};
    const View view = view_at(centre, static_cast<std::uint8_t>(1 + rng.below(4)),
                              static_cast<std::uint8_t>(rng.below(5)));
    const TileInterest::Moved moved = tiles.set_view(view);
    for (const ChunkKey& key : moved.left) CHECK(held.erase(key) == 1);
    for (const ChunkKey& key : send_all(tiles, ground)) CHECK(held.insert(key).second);
    // A higher level may have come that is empty where tiles were held.
    std::erase_if(held, [&](const ChunkKey& key) {
      return tiles.status(key) == TileStatus::unknown && has_key(view, kTileWorld, key) &&
             ground.is_empty(key);
    });
    // A level that became coarser keeps the tiles that it had; they are in the view.
    for (const ChunkKey& key : expected(view, ground)) CHECK(held.contains(key));
    for (const ChunkKey& key : held) {
      CHECK(has_key(view, kTileWorld, key));
      CHECK(has(tiles, key));
    }
    CHECK(tiles.known_count() == held.size());
  }
}

TEST_CASE("tiles outside of a skipped view are sent again") {
  const TileGround ground;
  TileInterest tiles(kTileWorld);
  const View here = view_at({0, 0, 0});
  tiles.set_view(here);
  send_all(tiles, ground);
  const View away = view_at({12, 0, 0});
  const std::vector<View> skipped{away};
  tiles.set_view(here, skipped);
  const std::vector<ChunkKey> again = send_all(tiles, ground);
  std::set<ChunkKey> outside;
  for (const ChunkKey& key : expected(here, ground)) {
    if (!has_key(away, kTileWorld, key)) outside.insert(key);
  }
  CHECK(std::set<ChunkKey>(again.begin(), again.end()) == outside);
}

TEST_CASE("a tile that becomes empty takes those below it along, and brings them back") {
  const TileGround ground;
  TileInterest tiles(kTileWorld);
  const View view = view_at({0, 0, 0});
  tiles.set_view(view);
  send_all(tiles, ground);
  const std::set<ChunkKey> all = expected(view, ground);
  const auto is_root = [&](const ChunkKey& key) {
    return key.lod == 3 && has_key(view, kTileWorld, key) &&
           std::any_of(all.begin(), all.end(), [&](const ChunkKey& other) {
             return other.lod == 2 && tile_parent(other) == key;
           });
  };
  const auto found = std::find_if(ground.solid.begin(), ground.solid.end(), is_root);
  REQUIRE(found != ground.solid.end());
  const ChunkKey root = *found;
  REQUIRE(tiles.status(root) == TileStatus::sent);
  const std::vector<ChunkKey> left = tiles.set_sent(root, true);
  std::set<ChunkKey> below;
  for (const ChunkKey& key : all) {
    if (key.lod < 3 && tile_of(first_chunk(key), 3) == root) below.insert(key);
  }
  REQUIRE_FALSE(below.empty());
  CHECK(std::set<ChunkKey>(left.begin(), left.end()) == below);
  CHECK_FALSE(next_of(tiles).has_value());
  tiles.set_sent(root, false);
  const std::vector<ChunkKey> again = send_all(tiles, ground);
  CHECK(std::set<ChunkKey>(again.begin(), again.end()) == below);
}

TEST_CASE("a tile that was not sent after all is wanted again") {
  TileInterest tiles(kTileWorld);
  tiles.set_view(view_at({0, 0, 0}));
  const ChunkKey key = *next_of(tiles);
  tiles.set_waiting(key);
  CHECK(tiles.waiting_count() == 1);
  CHECK(next_of(tiles) != key);
  tiles.want_again(key);
  CHECK(tiles.waiting_count() == 0);
  CHECK(next_of(tiles) == key);
  tiles.set_waiting(key);
  tiles.set_sent(key, false);
  CHECK(tiles.clear() == std::vector<ChunkKey>{key});
  CHECK(tiles.known_count() == 0);
}

TEST_CASE("a view without levels or with a small radius has no tiles") {
  TileInterest tiles(kTileWorld);
  tiles.set_view(view_at({0, 0, 0}, 3, 0));
  CHECK_FALSE(next_of(tiles).has_value());
  tiles.set_view(view_at({0, 0, 0}, 1, 8));
  CHECK_FALSE(next_of(tiles).has_value());
}

}  // namespace runstone::test
