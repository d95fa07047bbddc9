// WorldMemory: the memory that the data of a world take, and what the server refuses when it runs
// out. The three bounds follow each other, so that each kind of use leaves room for the next one:
//   1. Over idle_bytes_max, chunks that nobody uses leave memory. They do so, too, when they take more
//      than about unused_bytes_max: somebody who looks at one place after another fills no memory.
//   2. Over view_bytes_max, no chunk is loaded for a session: its view stays incomplete until other
//      chunks leave. Chunks that the next checkpoint needs are still loaded, because a saved chunk
//      can leave memory and its stack becomes empty.
//      Before that, from half of it on, an address may load chunks only while those that its
//      sessions see take less than twice the memory that is left. So however many addresses see as
//      much as they can, some memory is left for others (the dynamic thresholds of A. K. Choudhury
//      and E. L. Hahne, "Dynamic queue length thresholds for shared-memory packet switches", 1998,
//      with alpha = 2).
//   3. Over edit_bytes_max, edits are rejected busy.
// The edits that were accepted already may exceed the last bound, by one commit.
// Two things take memory and are not counted. The queues of the sessions have bounds of their own
// (net_session.hpp). Each chunk that was ever edited has an entry of about 150 bytes.
// Thread: the world strand.
#pragma once
#include <cstddef>

namespace runstone {

struct WorldState;

struct MemoryLimits {
  std::size_t idle_bytes_max = 448ULL << 20;
  std::size_t view_bytes_max = 480ULL << 20;
  std::size_t edit_bytes_max = 512ULL << 20;
  /// Edits that wait for their chunks over this begin a round of snapshots, which loads the chunks.
  std::size_t stack_bytes_max = 64ULL << 20;
  std::size_t unused_bytes_max = 16ULL << 20;
};
/// Returns the bounds of a world whose data may take this many bytes.
constexpr MemoryLimits memory_limits_of(std::size_t bytes) {
  return {bytes / 16 * 14, bytes / 16 * 15, bytes, bytes / 8, bytes / 32};
}

struct WorldMemory {
  std::size_t voxels = 0;   // of the chunks in memory
  std::size_t stacked = 0;  // edits that wait for chunks that are not in memory
  std::size_t queued = 0;   // edits that wait for the next commit or for the disk
  std::size_t total() const { return voxels + stacked + queued; }
};
/// Cost: O(1).
WorldMemory world_memory_of(const WorldState& world);

/// Returns true if no chunk may be loaded for any session now.
bool views_wait_for_memory(const WorldState& world);
/// Returns true if edits must be rejected now.
bool is_memory_full(const WorldState& world);

/// Makes chunks without users leave memory, sets the sessions whose loads wait
/// (WorldState::loads_wait) to those whose address sees more than its share, and warns the operator
/// when the memory is full and when it is no longer. Call it on each tick.
void keep_memory_bounds(WorldState& world);

}  // namespace runstone
