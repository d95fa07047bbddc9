// TileBench: a WorldBench whose workers make tiles when the test says so.
#pragma once
#include <set>
#include <vector>

#include "common/core/tile_keys.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {

inline WorldConfig with_tiles() {
  WorldConfig c = config();
  c.tile_levels_max = 3;
  return c;
}

/// From here a session draws the tiles of levels 1 and 2 at the origin. From the origin it draws
/// what is below them.
inline constexpr ChunkCoord kAside{4, 0, 0};

/// A world whose ground is the layer of chunks at y = 0. Each tile that has ground is dotted.
struct TileBench : WorldBench {
  explicit TileBench(WorldConfig c = with_tiles()) : WorldBench(std::move(c)) {
    has_empty_base = true;
  }

  void enter(SessionId session, std::uint8_t levels = 3, std::uint64_t features = kFeatureTiles) {
    join(session, static_cast<std::uint8_t>(session), 1, {}, features);
    look(session, levels, {});
  }
  void look(SessionId session, std::uint8_t levels, ChunkCoord at) {
    View v;
    v.centre = at;
    v.radius_h = 2;
    v.radius_v = 1;
    v.levels = levels;
    tick(100'000);
    view(session, v);
  }
  MadeTile made(const ChunkKey& key, Sequence through) const {
    const bool has_ground = key.at.y == 0;
    Chunk tile = has_ground ? dotted_chunk(kEdge) : empty_chunk(kEdge);
    tile.version = {};
    MadeTile out{key, std::make_shared<const Chunk>(std::move(tile)), through, false, false};
    out.rules = server.order().tile_rules();
    return out;
  }
  /// The tile has the newest version of its fresh chunks.
  void answer(const TileRequest& request) {
    MadeTile tile = made(request.key, request.head);
    Chunk chunk = *tile.tile;
    for (const auto& [at, fresh] : request.fresh) {
      if (fresh) chunk.version = std::max(chunk.version, fresh->version);
    }
    tile.tile = std::make_shared<const Chunk>(std::move(chunk));
    server.ground().tiles().made(request.key, {tile}, now());
  }
  /// Answers all requests, also those that follow. Returns them.
  std::vector<TileRequest> answer_tiles() {
    std::vector<TileRequest> requests;
    while (!environment.tile_requests.empty()) {
      const TileRequest request = environment.tile_requests.front();
      environment.tile_requests.pop_front();
      answer(request);
      requests.push_back(request);
    }
    tick();
    return requests;
  }
  /// Returns the tiles that the session was sent so far.
  std::multiset<ChunkKey> tiles_of(SessionId session) const {
    std::multiset<ChunkKey> keys;
    for (const auto& sent : environment.snapshots) {
      if (sent.session == session && sent.key.lod > 0) keys.insert(sent.key);
    }
    for (const UniformChunks& message : environment.messages<UniformChunks>(session, kEdge)) {
      for (const UniformChunk& one : message.chunks) {
        if (one.key.lod > 0) keys.insert(one.key);
      }
    }
    return keys;
  }
};

}  // namespace runstone::test
