// Hidden tiles: a client that does not get tiles which it does not draw still draws no old state.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "common/core/hash.hpp"
#include "tests/unit/server/interest/tile_ground.hpp"

namespace runstone::test {
namespace {

/// Number of changes of each tile that was ever changed.
using Versions = std::map<ChunkKey, int>;

int version_of(const Versions& versions, const ChunkKey& key) {
  const auto found = versions.find(key);
  return found == versions.end() ? 0 : found->second;
}

/// A client that has all chunks of its view, and the tiles that the server sent.
struct Client {
  View view;
  Versions held;  // the version of each tile that it has

  /// Sets the view, and forgets the tiles outside of it.
  void set_view(const View& now) {
    view = now;
    std::erase_if(held, [&](const auto& tile) { return !has_key(now, kTileWorld, tile.first); });
  }
  /// Takes a tile that was sent. Nothing is below an empty one.
  void take(const ChunkKey& key, int version, bool is_empty) {
    held[key] = version;
    if (!is_empty) return;
    std::erase_if(held, [&](const auto& tile) {
      return tile.first.lod < key.lod && tile_of(first_chunk(tile.first), key.lod) == key;
    });
  }
  bool has(const ChunkKey& key) const {
    if (!has_place(kTileWorld, key)) return true;
    return key.lod == 0 ? view.contains(key.at) : held.contains(key);
  }
  bool draws(const ChunkKey& key) const {
    for (unsigned i = 0; i < kTileChildren; ++i) {
      if (!has(tile_child(key, i))) return true;
    }
    return false;
  }
};

View random_view(SplitMix64& rng, ChunkCoord centre) {
  View view;
  view.centre = centre;
  view.radius_h = static_cast<std::uint8_t>(2 + rng.below(7));
  view.radius_v = static_cast<std::uint8_t>(1 + rng.below(4));
  view.levels = static_cast<std::uint8_t>(rng.below(6));
  return view;
}

ChunkCoord moved(SplitMix64& rng, ChunkCoord from, std::int32_t by) {
  return {from.x + rng.between(-by, by), from.y + rng.between(-1, 1),
          from.z + rng.between(-by, by)};
}

class HiddenTilesBench {
 public:
  void send(std::size_t count_max) {
    while (count_max-- > 0) {
      const auto key = next_of(tiles);
      if (!key) return;
      tiles.set_waiting(*key);
      const bool is_empty = ground_.is_empty(*key);
      tiles.set_sent(*key, is_empty);
      client.take(*key, version_of(versions_, *key), is_empty);
    }
  }
  void send_all() { send(SIZE_MAX); }
  /// Changes a chunk, and so the tiles above it. The session gets those that it may draw.
  void edit(ChunkCoord chunk) {
    for (std::uint8_t level = 1; level <= kTileLevelMax; ++level) {
      const ChunkKey key = tile_of(chunk, level);
      ++versions_[key];
      if (tiles.status(key) == TileStatus::sent && tiles.is_hidden(key))
        tiles.set_behind(key);
      else if (client_has(tiles.status(key)) && tiles.status(key) != TileStatus::behind)
        tiles.want_again(key);
    }
  }
  void set_view(const View& view, const std::vector<View>& skipped) {
    for (const View& other : skipped) client.set_view(other);
    client.set_view(view);
    tiles.set_view(view, skipped);
  }
  /// Returns the tiles that are behind. Checks that the client draws none of them.
  std::vector<ChunkKey> check_behind() const {
    std::vector<ChunkKey> out;
    for (const auto& [key, version] : client.held) {
      if (tiles.status(key) != TileStatus::behind) continue;
      CHECK_FALSE(client.draws(key));
      out.push_back(key);
    }
    return out;
  }
  /// Checks, when nothing is wanted, that the client has the newest state of all other tiles.
  void check_others() const {
    for (const auto& [key, version] : client.held) {
      CHECK(client_has(tiles.status(key)));
      if (tiles.status(key) != TileStatus::behind) CHECK(version == version_of(versions_, key));
    }
    CHECK(tiles.known_count() == client.held.size());
  }

  TileInterest tiles{kTileWorld};
  Client client;

 private:
  const TileGround ground_{20'000};
  Versions versions_;
};

}  // namespace

TEST_CASE("no session draws an old state of a tile, whichever way its view changes") {
  SplitMix64 rng(11);
  HiddenTilesBench bench;
  View view = random_view(rng, {0, 0, 0});
  std::size_t behind = 0;
  for (int step = 0; step < 300; ++step) {
    const bool is_walk = rng.below(4) != 0;
    const ChunkCoord centre = moved(rng, view.centre, is_walk ? 1 : 12);
    std::vector<View> skipped;
    if (rng.below(5) == 0) skipped.push_back(random_view(rng, moved(rng, view.centre, 20)));
    if (is_walk) {
      view.centre = centre;
    } else {
      view = random_view(rng, centre);
    }
    bench.set_view(view, skipped);
    for (int n = 0; n < 30; ++n) {
      bench.edit(moved(rng, view.centre, 6));
      bench.send(rng.below(40));
    }
    bench.check_behind();
    bench.send_all();
    for (int n = 0; n < 20; ++n) bench.edit(moved(rng, view.centre, 6));
    bench.send_all();
    bench.check_others();
    behind += bench.check_behind().size();
    if (rng.below(40) == 0) {
      bench.tiles.clear();
      bench.client.held.clear();
    }
  }
  CHECK(behind > 500);  // the test is about these
}

TEST_CASE("a move by one child shows no tile that is behind") {
  SplitMix64 rng(12);
  for (int round = 0; round < 60; ++round) {
    HiddenTilesBench bench;
    View view = random_view(rng, {rng.between(-20, 20), 0, rng.between(-20, 20)});
    view.radius_h = std::max(view.radius_h, kHiddenMarginRadius);
    bench.set_view(view, {});
    bench.send_all();
    for (int n = 0; n < 40; ++n) bench.edit(moved(rng, view.centre, 6));
    bench.send_all();
    for (const ChunkKey& key : bench.check_behind()) {
      const std::int32_t edge = 1 << (key.lod - 1);  // of a child, in chunks
      const int axis = static_cast<int>(rng.below(3));
      const std::int32_t by = rng.below(2) == 0 ? -edge : edge;
      Client client = bench.client;
      (axis == 0   ? client.view.centre.x
       : axis == 1 ? client.view.centre.y
                   : client.view.centre.z) += by;
      client.set_view(client.view);
      CHECK_FALSE(client.draws(key));
    }
  }
}

}  // namespace runstone::test
