// A server makes tiles of far ground, keeps them current while players build, and stores them.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/core/tile_keys.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/generate/generator.hpp"
#include "common/mesh/visibility.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"
#include "common/tiles/veil.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/view_tiles.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/session_messages.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/sql/raw_sql.hpp"

namespace runstone::test::tiles_test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr Material kTower = 3;

View far_view(ChunkCoord centre) {
  View view;
  view.centre = centre;
  view.radius_h = 2;
  view.radius_v = 1;
  view.levels = 4;
  return view;
}

/// A client that keeps the tiles of its view.
class Watcher {
 public:
  Watcher(std::uint16_t port, std::uint8_t who, const View& view) : client_(port), view_(view) {
    client_.features = kFeatureTiles;
    REQUIRE(client_.join(who).has_value());
    client_.send(view);
  }
  const std::map<ChunkKey, Chunk>& tiles() const { return tiles_; }
  const Chunk* find(const ChunkKey& key) const {
    const auto found = tiles_.find(key);
    return found == tiles_.end() ? nullptr : &found->second;
  }
  /// Reads until every root of the view and every child of a tile with ground has arrived.
  void read_all() {
    while (!is_complete()) read_tile();
  }
  /// Reads until `is_done` returns true.
  template <class IsDone>
  void read_until(const IsDone& is_done) {
    while (!is_done()) read_tile();
  }
  void send(const Message& message) { client_.send(message); }
  RawClient& client() { return client_; }

 private:
  void read_tile() {
    auto snapshot = client_.next_of<ChunkSnapshot>();
    REQUIRE(snapshot.has_value());
    if (snapshot->key.lod == 0) return;
    CHECK(contains_key(view_, snapshot->key));
    CHECK((digest_matches(*snapshot) || snapshot->chunk.digest == Digest{}));  // 0: a past tile
    if (is_empty(snapshot->chunk.voxels)) {
      std::erase_if(tiles_, [above = snapshot->key](const auto& tile) {
        ChunkKey key = tile.first;
        while (key.lod < above.lod) key = tile_parent(key);
        return key == above;
      });
    }
    tiles_.insert_or_assign(snapshot->key, std::move(snapshot->chunk));
  }
  bool has_below(const ChunkKey& key) const {
    const Chunk* tile = find(key);
    if (tile == nullptr) return false;
    if (key.lod == 1 || is_empty(tile->voxels)) return true;
    for (unsigned i = 0; i < kTileChildren; ++i) {
      const ChunkKey child = tile_child(key, i);
      if (contains_key(view_, child) && !has_below(child)) return false;
    }
    return true;
  }
  bool is_complete() const {
    const ChunkCoord centre = tile_at(view_.centre, view_.levels);
    for (std::int32_t x = -2; x <= 2; ++x) {
      for (std::int32_t y = -kTileRadiusV; y <= kTileRadiusV; ++y) {
        for (std::int32_t z = -2; z <= 2; ++z) {
          const ChunkKey root{view_.levels, {centre.x + x, centre.y + y, centre.z + z}};
          if (contains_key(view_, root) && !has_below(root)) return false;
        }
      }
    }
    return true;
  }

  RawClient client_;
  View view_;
  std::map<ChunkKey, Chunk> tiles_;
};

/// Makes tiles from the generator and from edits alone.
class Expected {
 public:
  explicit Expected(const std::string& folder) {
    const auto store = open_world(folder, StoreAccess::read_only);
    REQUIRE(store.has_value());
    const MaterialTable materials = (*store)->meta().materials;
    visibility_.emplace(visibilities(materials));
    auto made = make_generator((*store)->meta().generator, materials);
    REQUIRE(made.has_value());
    generator_ = *std::move(made);
  }
  void edit(const EditDescriptor& edit) { edits_.push_back(edit); }
  /// Returns a tile as clients get it.
  RunChunk sent(const ChunkKey& key) {
    const RunChunk whole = tile(key);
    VeilScratch scratch;
    return veiled(whole, *visibility_, scratch).value_or(whole);
  }

 private:
  RunChunk tile(const ChunkKey& key) {
    if (key.lod == 0) return chunk(key.at);
    std::array<RunChunk, kTileChildren> children;
    TileChildren pointers{};
    for (unsigned i = 0; i < kTileChildren; ++i) {
      children[i] = tile(tile_child(key, i));
      pointers[i] = &children[i];
    }
    return build_tile(pointers, kEdge, kTileOrder, *visibility_, scratch_);
  }
  RunChunk chunk(ChunkCoord at) const {
    const VoxelPos origin = origin_of(at, kEdge);
    RunChunk voxels = generator_->generate(origin, Extent::cube(kEdge));
    Digest digest = digest_of(voxels);
    ApplyScratch scratch;
    apply_stack(voxels, digest, origin, edits_, scratch);
    return voxels;
  }

  std::optional<VisibilityTable> visibility_;
  std::unique_ptr<Generator> generator_;
  std::vector<EditDescriptor> edits_;
  TileScratch scratch_;
};

/// Compares the tiles below the level from which on the generator may approximate them.
void check_exact(const Watcher& watcher, Expected& expected) {
  int compared = 0;
  for (const auto& [key, tile] : watcher.tiles()) {
    if (key.lod > 2) continue;
    INFO("level " << int{key.lod} << " at " << key.at.x << " " << key.at.y << " " << key.at.z);
    CHECK(digest_of(tile.voxels) == digest_of(expected.sent(key)));
    ++compared;
  }
  CHECK(compared > 20);
}

/// From the centre of the views the tiles of levels 1 and 2 are drawn here.
const std::array<EditDescriptor, 2> kTowers = {
    EditDescriptor{FillBox{{{72, 0, 8}, {76, 150, 12}}}, {}, kTower},
    EditDescriptor{FillBox{{{-50, 60, 8}, {-40, 90, 20}}}, {}, kTower}};

}  // namespace

TEST_CASE("a tower appears in the tiles of another client, and in those of the next start",
          "[integration]") {
  TempFolder folder;
  const ServerConfig config = quiet_config(folder.path());
  {
    const auto server = start_server(config, terrain_creation());
    Expected expected(folder.path());
    Watcher watcher(server->port(), 1, far_view({0, 2, 0}));
    watcher.read_all();
    check_exact(watcher, expected);

    RawClient builder(server->port());
    REQUIRE(builder.join(2).has_value());
    ClientSequence seq = 0;
    for (const EditDescriptor& tower : kTowers) {
      builder.send(EditRequest{++seq, 0, tower});
      expected.edit(tower);
    }
    REQUIRE(builder.sees_durable(2));
    const ChunkKey above = tile_of(chunk_of({72, 140, 8}, kEdge), 2);
    watcher.read_until([&] {
      const Chunk* tile = watcher.find(above);
      return tile != nullptr && tile->version.seq == 1;
    });
    watcher.read_all();
    const auto has_towers = [&] {
      for (const EditDescriptor& tower : kTowers) {
        const VoxelBox box = std::get<FillBox>(tower.shape).box;
        for (std::uint8_t level = 1; level <= 2; ++level) {
          const ChunkKey key = tile_of(chunk_of(box.min, kEdge), level);
          const Chunk* tile = watcher.find(key);
          if (contains_key(far_view({0, 2, 0}), key) && (tile == nullptr || tile->version.seq == 0))
            return false;
        }
      }
      return true;
    };
    watcher.read_until(has_towers);
    server->stop();
  }
  const auto server = start_server(config, {});
  Expected expected(folder.path());
  for (const EditDescriptor& tower : kTowers) expected.edit(tower);
  Watcher watcher(server->port(), 1, far_view({0, 2, 0}));
  watcher.read_all();
  check_exact(watcher, expected);
  server->stop();
  CHECK(raw_sql(folder / "world.sqlite", "SELECT count(*) FROM tile WHERE seq > 0") != "0");
}

TEST_CASE("requested tiles are sent coded, and a tile that replaces another one is sent packed",
          "[integration]") {
  TempFolder folder;
  const auto server = start_server(quiet_config(folder.path()), terrain_creation());
  Watcher watcher(server->port(), 1, far_view({0, 2, 0}));
  std::map<ChunkKey, ChunkEncoding> sent_as;  // the last time
  watcher.client().on_body = [&](MessageKind kind, ByteView body) {
    const auto message = decode_message(Sender::server, kind, body, kEdge);
    const auto* chunks = message ? std::get_if<Chunks>(&*message) : nullptr;
    if (chunks == nullptr) return;
    for (const ChunkAnswer& answer : chunks->chunks) {
      const auto* snapshot = std::get_if<ChunkSnapshot>(&answer);
      if (snapshot == nullptr || snapshot->key.lod == 0) continue;
      const auto is_sent = [&](ChunkEncoding encoding) {
        const auto entry = encode_snapshot(snapshot->key, snapshot->chunk, encoding);
        return !std::ranges::search(body, *entry.bytes).empty();
      };
      CHECK(is_sent(ChunkEncoding::coded) != is_sent(ChunkEncoding::packed));
      sent_as[snapshot->key] =
          is_sent(ChunkEncoding::coded) ? ChunkEncoding::coded : ChunkEncoding::packed;
    }
  };
  watcher.read_all();
  CHECK(sent_as.size() > 20);
  std::vector<ChunkKey> first;
  for (const auto& [key, encoding] : sent_as) {
    CHECK(encoding == ChunkEncoding::coded);
    first.push_back(key);
  }

  RawClient builder(server->port());
  REQUIRE(builder.join(2).has_value());
  builder.send(EditRequest{1, 0, kTowers[0]});
  REQUIRE(builder.sees_durable(1));
  const auto changed = [&](const ChunkKey& key) {
    const Chunk* now = watcher.find(key);
    return now != nullptr && now->version.seq == 1;
  };
  watcher.read_until([&] { return std::ranges::any_of(first, changed); });
  CHECK(sent_as.at(*std::ranges::find_if(first, changed)) == ChunkEncoding::packed);
  server->stop();
}

TEST_CASE("far ground shows the moment to which a client moves in time", "[integration]") {
  TempFolder folder;
  const auto server = start_server(quiet_config(folder.path()), terrain_creation());
  Watcher watcher(server->port(), 1, far_view({0, 2, 0}));
  watcher.read_all();
  RawClient builder(server->port());
  REQUIRE(builder.join(2).has_value());
  ClientSequence seq = 0;
  for (const EditDescriptor& tower : kTowers) builder.send(EditRequest{++seq, 0, tower});
  REQUIRE(builder.sees_durable(2));
  std::array<std::unique_ptr<Expected>, kTowers.size() + 1> expected;  // by the number of towers
  for (std::size_t towers = 0; towers < expected.size(); ++towers) {
    expected[towers] = std::make_unique<Expected>(folder.path());
    for (std::size_t i = 0; i < towers; ++i) expected[towers]->edit(kTowers.at(i));
  }
  std::set<ChunkKey> touched;
  for (const EditDescriptor& tower : kTowers) {
    for (const ChunkCoord at : touched_chunks(tower, kEdge)) {
      for (std::uint8_t level = 1; level <= 2; ++level) {
        const ChunkKey key = tile_of(at, level);
        if (contains_key(far_view({0, 2, 0}), key)) touched.insert(key);
      }
    }
  }
  const auto shows = [&](std::size_t towers) {
    watcher.read_until([&] {
      return std::ranges::all_of(touched, [&](const ChunkKey& key) {
        const Chunk* tile = watcher.find(key);
        const RunChunk wanted = expected.at(towers)->sent(key);
        // The server sends no tiles below an empty tile, so the client may lack them.
        return tile == nullptr ? is_empty(wanted) : digest_of(tile->voxels) == digest_of(wanted);
      });
    });
    watcher.read_all();
  };
  shows(2);
  std::uint32_t request = 0;
  for (const std::size_t towers : {0U, 1U, 0U}) {
    watcher.send(HistoryRequest{++request, HistoryTarget::sequence, towers, 0});
    shows(towers);
    check_exact(watcher, *expected.at(towers));
  }
  watcher.send(HistoryRequest{++request, HistoryTarget::live, 0, 0});
  shows(2);
  check_exact(watcher, *expected.back());
  server->stop();
}

TEST_CASE("a view that flips its levels and place with each message delays nobody else",
          "[integration]") {
  TempFolder folder;
  ServerConfig config = quiet_config(folder.path());
  config.chunk_loads_per_second = 400;
  const auto server = start_server(config, terrain_creation());
  RawClient hostile(server->port());
  hostile.features = kFeatureTiles;
  REQUIRE(hostile.join(1).has_value());
  std::jthread flips([&hostile](const std::stop_token& stop) {
    for (std::int32_t i = 0; !stop.stop_requested() && hostile.is_open(); ++i) {
      View view = far_view({(i % 7) * 1'000, 2, i % 5});
      view.levels = static_cast<std::uint8_t>(i % 9);
      std::vector<CachedChunk> claims;  // of tiles that it never had
      for (std::int32_t x = -2; x <= 2; ++x)
        claims.push_back({tile_of({view.centre.x + 16 * x, 2, 0}, 4), {1, 9}, 77});
      for (Message& message : cached_chunks_messages(claims)) hostile.send(std::move(message));
      hostile.send(view);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  Expected expected(folder.path());
  Watcher watcher(server->port(), 2, far_view({0, 2, 0}));
  watcher.read_all();
  CHECK(hostile.is_open());
  check_exact(watcher, expected);
  server->stop();
}

}  // namespace runstone::test::tiles_test
