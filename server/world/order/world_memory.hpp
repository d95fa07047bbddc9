// WorldMemory: the memory that the data of a world take, and what the server refuses when it runs
// out. The three bounds of MemoryLimits follow each other, so that each kind of use leaves room for
// the next one:
//   1. Over idle_bytes_max, chunks that nobody uses leave memory. They do so, too, when they take
//      more than about unused_bytes_max: somebody who looks at one place after another fills no
//      memory.
//   2. Over view_bytes_max, no chunk is loaded for a session: its view stays incomplete until other
//      chunks leave. Chunks that the next checkpoint needs are still loaded, because a saved chunk
//      can leave memory and its stack becomes empty. Before that, addresses share the memory that
//      is left (server/world/ground/loads.hpp).
//   3. Over edit_bytes_max, edits are rejected busy.
// The edits that were accepted already may exceed the last bound, by one commit.
// Two things take memory and are not counted. The queues of the sessions have bounds of their own
// (net_session.hpp). Each chunk that was ever edited has an entry of about 150 bytes.
#pragma once
#include <cstddef>

namespace runstone {

struct WorldMemory {
  std::size_t voxels = 0;   // of the chunks in memory
  std::size_t stacked = 0;  // edits that wait for chunks that are not in memory
  std::size_t queued = 0;   // edits that wait for the next commit or for the disk
  std::size_t total() const { return voxels + stacked + queued; }
};

}  // namespace runstone
