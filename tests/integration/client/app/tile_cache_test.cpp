// A client that starts again with its cache gets only the tiles that changed.
#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "client/cache/chunk_cache.hpp"
#include "client/session/client_session.hpp"
#include "common/core/tile_keys.hpp"
#include "common/os/steady_clock.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/session_messages.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/sql/raw_sql.hpp"

namespace runstone::test::tile_cache_test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr std::uint8_t kLevels = 4;

/// The tiles that a client received in one run. Uniform ones are not counted.
struct Received {
  std::set<ChunkKey> tiles;  // whole
  std::size_t not_modified = 0;
  std::size_t held = 0;  // tiles, at the end
};

/// Runs a client with a cache in this folder until it has all tiles of its view.
Received run_client(std::uint16_t port, const std::string& folder) {
  SessionConfig config;
  config.keys = key_pair_of(KeySeed{7});
  config.features = kFeatureTiles;
  config.has_cache = true;
  config.view.centre = {0, 2, 0};
  config.view.radius_h = 2;
  config.view.radius_v = 1;
  config.view.levels = kLevels;
  auto cache = ChunkCache::open(folder, std::uint64_t{1} << 26);
  REQUIRE(cache.has_value());
  RawClient socket(port);
  socket.cuts_chunks = false;
  ClientSession session(config);
  session.connected(Nonce{1}, socket.binding(), steady_now_us());
  Received received;
  std::set<ChunkKey> claimed, answered;  // tiles
  const auto is_complete = [&] {
    if (!session.is_open() || !session.loaded()) return false;
    const FarTiles::Missing missing = session.replica().far_tiles().missing();
    return missing.roots + missing.others == 0 &&
           received.not_modified + received.tiles.size() != 0 &&
           std::includes(answered.begin(), answered.end(), claimed.begin(), claimed.end());
  };
  while (!is_complete()) {
    while (auto lookup = session.take_cache_lookup())
      session.receive_cache_result((*cache)->find(*lookup), steady_now_us());
    for (const Message& message : session.take_outgoing()) {
      if (const auto* claims = std::get_if<CachedChunks>(&message)) {
        for (const CachedChunk& claim : claims->chunks) {
          if (claim.key.lod > 0) claimed.insert(claim.key);
        }
      }
      socket.send(encode_message(message));
    }
    auto message = socket.next();
    REQUIRE(message.has_value());
    if (const auto* chunks = std::get_if<Chunks>(&*message)) {
      for (const ChunkAnswer& answer : chunks->chunks) {
        answered.insert(key_of(answer));
        const auto* tile = std::get_if<ChunkSnapshot>(&answer);
        if (tile != nullptr && tile->key.lod > 0 && !tile->chunk.voxels.is_uniform())
          received.tiles.insert(tile->key);
      }
    } else if (const auto* same = std::get_if<ChunksNotModified>(&*message)) {
      if (same->chunks.front().key.lod > 0) received.not_modified += same->chunks.size();
      for (const UnmodifiedChunk& one : same->chunks) answered.insert(one.key);
    } else if (const auto* uniform = std::get_if<UniformChunks>(&*message)) {
      for (const UniformChunk& one : uniform->chunks) answered.insert(one.key);
    }
    const TimeUs now = steady_now_us();
    session.receive(*std::move(message), {now, now, now});
    session.tick(now);
  }
  received.held = session.replica().far_tiles().solid_count();
  (*cache)->keep(*session.cached_world(), session.replica().take_for_cache(100'000));
  return received;
}

}  // namespace

TEST_CASE("a client that starts again gets only the tiles above an edit", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const std::string cache = folder / "cache";
  auto server = start_server(config, terrain_creation());
  const auto restart = [&] {
    server->stop();
    server.reset();
    server = start_server(config, {});
  };
  const Received first = run_client(server->port(), cache);
  CHECK(first.not_modified == 0);
  CHECK(first.tiles.size() > 40);

  SECTION("while the server runs, and after it started again") {
    if (GENERATE(false, true)) {
      restart();
    }
    const Received again = run_client(server->port(), cache);
    CHECK(again.tiles.empty());
    CHECK(again.not_modified == first.tiles.size());
    CHECK(again.held == first.held);
  }
  SECTION("after an edit") {
    RawClient builder(server->port());
    REQUIRE(builder.join(2).has_value());
    // The chunks of the edit stay in memory. A tile above others is sent before the edit is in it, and
    // again later.
    View here;
    here.radius_h = 1;
    here.radius_v = 4;
    builder.send(here);
    REQUIRE(builder.next_of<ViewState>().has_value());
    const EditDescriptor tower{FillBox{{{4, 0, 4}, {8, 60, 8}}}, {}, 3};
    builder.send(EditRequest{1, 0, tower});
    REQUIRE(builder.sees_durable(1));
    if (GENERATE(false, true)) {
      restart();
    }
    const Received again = run_client(server->port(), cache);
    CHECK_FALSE(again.tiles.empty());
    for (const ChunkKey& key : again.tiles) {
      const VoxelBox box = std::get<FillBox>(tower.shape).box;
      const ChunkCoord low = tile_at(chunk_of(box.min, kEdge), key.lod);
      const ChunkCoord high = tile_at(chunk_of({7, 59, 7}, kEdge), key.lod);
      INFO("level " << int{key.lod} << " at " << key.at.x << " " << key.at.y << " " << key.at.z);
      CHECK((key.at.x == low.x && key.at.z == low.z && key.at.y >= low.y && key.at.y <= high.y));
    }
    // The server makes tiles of the ground above the tower exact, so children of theirs may be new.
    CHECK(again.not_modified + again.tiles.size() >= first.tiles.size());
    const Received third = run_client(server->port(), cache);
    CHECK(third.tiles.empty());
    CHECK(third.not_modified == again.not_modified + again.tiles.size());
  }
  SECTION("a damaged row of the cache is sent whole") {
    REQUIRE(
        raw_sql(cache + "/cache.sqlite",
                "UPDATE chunk SET checksum = checksum + 1 WHERE rowid IN (SELECT rowid FROM chunk "
                "WHERE level = 1 LIMIT 1); SELECT changes()") == "1");
    const Received again = run_client(server->port(), cache);
    CHECK(again.tiles.size() == 1);
    CHECK(again.not_modified == first.tiles.size() - 1);
  }
  server->stop();
}

}  // namespace runstone::test::tile_cache_test
