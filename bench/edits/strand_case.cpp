#include "bench/edits/strand_case.hpp"

#include <deque>
#include <map>
#include <memory>
#include <span>
#include <utility>

#include "bench/edits/stack_case.hpp"
#include "bench/harness/clocks.hpp"
#include "bench/harness/strand_surroundings.hpp"
#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "protocol/limits.hpp"
#include "server/tiles/tile_ledger.hpp"
#include "server/world/world_server.hpp"

namespace runstone::bench {
namespace {

constexpr std::size_t kPlayers = 20;
constexpr std::size_t kTicks = 200;
constexpr TimeUs kTickUs = 50'000;
constexpr std::size_t kEditsPerTick = kStrandEdits / kTicks;
constexpr std::int32_t kSite = 24;  // edits lie within so many voxels of the origin

/// With workers that make tiles, whose answers wait until the strand's time is stopped.
class Outside final : public StrandSurroundings {
 public:
  std::deque<TileRequest> tiles;

  void make_tile(TileRequest request) override { tiles.push_back(std::move(request)); }
  void tiles_edited(std::span<const ChunkKey> chunks, Sequence seq) override {
    ledger_.edited(chunks, seq);
  }
  Sequence newest_tile_edit(const ChunkKey& tile) const override {
    return ledger_.newest_edit(tile);
  }

 private:
  TileLedger ledger_;
};

class Strand {
 public:
  explicit Strand(std::uint8_t levels)
      : levels_(levels), server_(strand_config(levels), {}, outside_, fill_constant) {
    for (SessionId player = 1; player <= kPlayers; ++player) join(player);
    settle();
  }

  /// Does one repetition.
  double run() {
    SplitMix64 rng(1);
    std::uint64_t ns = 0;
    const std::uint64_t ordered_before = server_.counters().edits_ordered;
    for (std::size_t tick = 0; tick < kTicks; ++tick) {
      const std::uint64_t start = core_ns();
      for (std::size_t i = 0; i < kEditsPerTick; ++i) {
        edit(1 + static_cast<SessionId>(i % kPlayers), rng);
        now_.steady_us += kTickUs / kEditsPerTick;
        now_.utc_us += kTickUs / kEditsPerTick;
        server_.commit(now_);
      }
      server_.tick(now_);
      deliver();
      ns += core_ns() - start;
      ns += answer();
    }
    RUNSTONE_ASSERT(server_.counters().edits_ordered == ordered_before + kStrandEdits);
    return static_cast<double>(ns) / 1000 / kStrandEdits;
  }

 private:
  void join(SessionId player) {
    const KeyPair keys = key_pair_of({2, static_cast<std::uint8_t>(player)});
    bench::join(server_, outside_, player, keys, "player" + std::to_string(player), kFeatureTiles,
                now_);
    View view;
    view.radius_h = 6;
    view.radius_v = 3;
    view.levels = levels_;
    server_.received(player, view, now_);
  }

  /// Ticks until all chunks and tiles are there.
  void settle() {
    do {
      now_.steady_us += kTickUs;
      now_.utc_us += kTickUs;
      server_.tick(now_);
      deliver();
    } while (answer() != 0);
  }

  void deliver() {
    while (server_.ground().has_deliveries()) server_.ground().deliver_next(now_);
  }

  /// Answers what the workers were asked for. Returns the time that the strand takes for the answers.
  std::uint64_t answer() {
    std::uint64_t ns = 0;
    while (!outside_.loads.empty() || !outside_.tiles.empty()) {
      if (!outside_.loads.empty()) {
        const ChunkKey key = outside_.loads.front();
        outside_.loads.pop_front();
        Chunk chunk = terrain_chunk(key.at);
        const std::uint64_t start = core_ns();
        server_.chunk_loaded(key, std::move(chunk), now_);
        ns += core_ns() - start;
      } else {
        const TileRequest request = std::move(outside_.tiles.front());
        outside_.tiles.pop_front();
        const MadeTile made = tile_of(request);
        const std::uint64_t start = core_ns();
        server_.ground().tiles().made(request.key, {made}, now_);
        ns += core_ns() - start;
      }
      const std::uint64_t start = core_ns();
      deliver();
      ns += core_ns() - start;
    }
    return ns;
  }

  /// Makes a tile with the voxels of a chunk of terrain. What it shows does not matter to the strand.
  MadeTile tile_of(const TileRequest& request) {
    Chunk tile = ground_;
    tile.version.seq = outside_.newest_tile_edit(request.key);
    MadeTile made{request.key, nullptr, request.head};
    made.voxel_digest = tile.digest;
    made.tile = std::make_shared<const Chunk>(std::move(tile));
    return made;
  }

  void edit(SessionId player, SplitMix64& rng) {
    const auto place = [&rng] { return rng.between(-kSite, kSite); };
    const EditDescriptor edit{
        SetVoxel{{place(), place(), place()}}, {}, static_cast<Material>(rng.below(8))};
    server_.received(player, EditRequest{++sequence_[player], 0, edit}, now_);
  }

  const std::uint8_t levels_;
  const Chunk ground_ = terrain_chunk({0, 0, 0});
  Outside outside_;
  Clocks now_{1'000'000, 1'000'000'000'000};
  std::map<SessionId, ClientSequence> sequence_;
  WorldServer server_;
};

}  // namespace

StrandTiming time_strand(unsigned repetitions) {
  Strand near(0), far(kStrandLevels);
  near.run();  // the first repetition grows the buffers
  far.run();
  StrandTiming timing;
  for (unsigned i = 0; i < repetitions; ++i) {
    timing.near_us.push_back(near.run());
    timing.far_us.push_back(far.run());
  }
  return timing;
}

}  // namespace runstone::bench
