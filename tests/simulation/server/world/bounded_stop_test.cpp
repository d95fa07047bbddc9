// A stop that has too little time for all snapshots, and the starts after it. The check of the
// voxels shares no code with server and store: each edit is drawn on the base.
#include <catch2/catch.hpp>
#include <set>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/simulation/client/session/sim_server.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kStopUs = 8'000'000;
constexpr std::int32_t kLayers = 10;                  // boxes, one over the other
constexpr std::int32_t kChunksX = 50, kChunksZ = 20;  // of each box
constexpr Sequence kEdits = kLayers;
constexpr std::size_t kChunks = std::size_t{kLayers} * kChunksX * kChunksZ;

/// Returns a box one voxel high in a layer of chunks of its own.
EditDescriptor wide_box(std::int32_t layer) {
  const std::int32_t y = layer * kSimEdge + 3;
  return {FillBox{{{0, y, 0}, {kChunksX * kSimEdge, y + 1, kChunksZ * kSimEdge}}}, {}, 3};
}

/// Returns the digest of a touched chunk, voxel by voxel.
Digest expected_digest(ChunkCoord at) {
  RunBuilder builder(Extent::cube(kSimEdge), AxisOrder::xzy);
  const VoxelPos o = origin_of(at, kSimEdge);
  for (VoxelIndex i = 0; i < Extent::cube(kSimEdge).volume(); ++i) {
    const LocalPos p = pos_of(i, Extent::cube(kSimEdge), AxisOrder::xzy);
    const bool is_in_box = p.y == 3;
    builder.append(1,
                   is_in_box ? Material{3} : sim_base_material({o.x + p.x, o.y + p.y, o.z + p.z}));
  }
  return digest_of(builder.finish());
}

struct StopBench {
  StopBench() {
    WorldMeta meta = sample_meta();
    meta.chunk_edge = kSimEdge;
    REQUIRE(create_world(folder.path(), meta).has_value());
  }
  static WorldConfig world_config() {
    WorldConfig config;
    config.chunk_edge = kSimEdge;
    config.materials = default_material_table();
    config.server_keys = key_pair_of(KeySeed{7});
    config.stop_us_max = kStopUs;
    return config;
  }
  std::unique_ptr<Store> open() const {
    auto store = open_world(folder.path(), StoreAccess::read_write);
    if (!store) throw SimFault(store.error().message());
    return *std::move(store);
  }
  void edit() {
    std::vector<EditOffer> offers;
    for (std::int32_t layer = 0; layer < kLayers; ++layer) {
      const auto seq = static_cast<ClientSequence>(layer + 1);
      offers.push_back({{0, 5, seq}, Cause::console, 0, wide_box(layer), 0});
    }
    const auto ordered = server.world().changes().order_edits(offers, 0, server.now());
    REQUIRE(ordered.count == offers.size());
  }
  /// Stops the server in order and returns the time that it took.
  TimeUs stop() {
    const TimeUs began_us = time.now();
    server.world().begin_stop(server.now());
    while (!server.world().order().is_flushed()) time.run_until(time.now() + 1'000);
    return time.now() - began_us;
  }

  const TempFolder folder;
  VirtualTime time;
  SplitMix64 rng{1};
  SimServer server{time, rng, world_config(), [this] { return open(); }};
};

}  // namespace

TEST_CASE("ten thousand changed chunks that load slowly do not keep a stop beyond its limit",
          "[simulation]") {
  StopBench bench;
  bench.server.start();
  bench.edit();
  // A load takes 25 ms in the mean and eight are under way, so that all of them take half a minute.
  std::size_t left = kChunks;
  int stops = 0;
  while (left > 0 && ++stops < 20) {
    const TimeUs took_us = bench.stop();
    CHECK(took_us < kStopUs + 200'000);  // a tick, and the log
    CHECK(bench.server.world().order().durable() == kEdits);
    const bool is_overdue = bench.server.world().order().is_stop_overdue();
    CHECK(is_overdue == (bench.server.world().order().dirty_chunks() > 0));
    bench.server.crash();  // ends the server: a slice that is on its way is lost
    bench.server.start();
    // Written slices stay, so every start replays fewer chunks.
    const std::size_t now = bench.server.world().order().dirty_chunks();
    CHECK(now < left);
    CHECK(bench.server.world().order().checkpoint() == (now == 0 ? kEdits : 0));
    left = now;
  }
  CHECK(left == 0);
  CHECK(stops > 2);
  std::size_t wrong = 0;
  for (std::int32_t layer = 0; layer < kLayers; ++layer) {
    const Version version{1, static_cast<Sequence>(layer + 1)};
    for (const ChunkCoord at : touched_chunks(wide_box(layer), kSimEdge)) {
      const auto snapshot = bench.server.store().load_snapshot({0, at});
      REQUIRE(snapshot.has_value());
      REQUIRE(snapshot->has_value());
      const bool is_right =
          (*snapshot)->digest == expected_digest(at) && (*snapshot)->version == version;
      wrong += is_right ? 0 : 1;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("a start after a bounded stop writes the snapshots that are left in its ordinary rounds",
          "[simulation]") {
  StopBench bench;
  bench.server.start();
  bench.edit();
  bench.stop();
  REQUIRE(bench.server.world().order().dirty_chunks() > 0);
  bench.server.crash();
  bench.server.start();
  bench.time.run_until(bench.time.now() + 120'000'000);
  CHECK(bench.server.world().order().dirty_chunks() == 0);
  CHECK(bench.server.world().order().checkpoint() == kEdits);
}

}  // namespace runstone::test
