#include "server/world/world_memory.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "server/world/world_state.hpp"

namespace runstone {
namespace {

constexpr std::size_t kEvictionStepsPerTick = 2'048;
constexpr std::size_t kShareOfFree = 2;  // alpha of the dynamic thresholds

std::string mebibytes(std::size_t bytes) { return std::to_string(bytes >> 20); }

/// Returns the mean memory of a chunk.
std::size_t mean_chunk_bytes(const WorldState& world) {
  const WorldChunks& chunks = world.authority.chunks();
  return chunks.resident_bytes() / std::max<std::size_t>(1, chunks.resident_count());
}

/// Returns the sessions that may load no chunk because their address sees more than its share.
/// Cost: O(sessions).
std::set<SessionId> sessions_over_share(const WorldState& world, const WorldMemory& use) {
  const std::size_t mean = mean_chunk_bytes(world);
  const std::size_t voxels = std::min(use.voxels, mean * world.interest.used_count());
  const std::size_t in_use = voxels + use.stacked + use.queued;
  const std::size_t bound = world.config.memory.view_bytes_max;
  if (in_use <= bound / 2) return {};
  const std::size_t share = kShareOfFree * (bound - std::min(bound, in_use));
  std::map<AddressBlock, std::size_t> seen;  // bytes; a chunk counts for each session
  for (const auto& [id, session] : world.sessions) {
    const SessionInterest* interest = world.interest.find(id);
    if (interest == nullptr) continue;
    seen[session.address] += mean * interest->count(ChunkInterest::subscribed);
  }
  std::set<SessionId> over;
  for (const auto& [id, session] : world.sessions) {
    if (seen[session.address] >= share) over.insert(id);
  }
  return over;
}

}  // namespace

WorldMemory world_memory_of(const WorldState& world) {
  const WorldChunks& chunks = world.authority.chunks();
  return {chunks.resident_bytes(), chunks.stack_bytes(),
          world.authority.queue().bytes() + world.environment.log_queued_bytes() +
              world.unwritten.bytes()};
}

bool views_wait_for_memory(const WorldState& world) {
  return world_memory_of(world).total() > world.config.memory.view_bytes_max;
}

bool is_memory_full(const WorldState& world) {
  return world_memory_of(world).total() > world.config.memory.edit_bytes_max;
}

void keep_memory_bounds(WorldState& world) {
  const WorldMemory use = world_memory_of(world);
  const std::size_t edits = use.stacked + use.queued;
  const MemoryLimits& limits = world.config.memory;
  const std::size_t seen = mean_chunk_bytes(world) * world.interest.used_count();
  const std::size_t voxels_max =
      std::min(limits.idle_bytes_max - std::min(limits.idle_bytes_max, edits),
               seen + limits.unused_bytes_max);
  world.authority.chunks().evict(voxels_max, kEvictionStepsPerTick,
                                 [&](const ChunkKey& key) { return world.interest.is_used(key); });
  world.loads_wait = sessions_over_share(world, world_memory_of(world));
  const bool is_short = views_wait_for_memory(world);
  if (std::exchange(world.is_memory_short, is_short) == is_short) return;
  if (!is_short) {
    world.environment.report(OperatorLogLevel::info, "MEMORY: there is room again");
    return;
  }
  world.environment.report(OperatorLogLevel::warn,
                           "MEMORY: memory_mib is used up: voxels " + mebibytes(use.voxels) +
                               " MiB, waiting edits " + mebibytes(edits) +
                               " MiB: chunks are loaded later, and edits may be rejected");
}

}  // namespace runstone
