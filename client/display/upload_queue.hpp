// UploadQueue: the changes of chunks that wait for the draw thread, the newest one of each chunk,
// in the order in which they should be on the screen:
//   1. chunks with an edit of this client;
//   2. chunks that have waited for kPatience frames, so that nothing waits for ever;
//   3. chunks with edits of others;
//   4. chunks that arrived, and those beside them;
//   5. tiles, finer levels first, so that coarse ground never hides finer ground that follows.
// Within a rank the nearest to the eye comes first. Pure. Cost: O(log chunks) per change, O(chunks
// that wait) when the eye enters another chunk. Memory: one entry for each chunk.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "client/far/tile_mesh.hpp"
#include "client/replica/replica_changes.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The new quads of a chunk, and the runs that were meshed; or the quads of a tile.
struct ChunkUpload {
  std::uint64_t number = 0;  // of its mesh job, see MeshJob::number
  std::uint64_t serial = 0;  // Replica::shown_serial() of these runs
  std::int32_t edge = 0;     // voxels
  Urgency urgency = Urgency::terrain;
  std::shared_ptr<const ChunkMesh> mesh;   // null for a tile
  std::shared_ptr<const RunChunk> voxels;  // may be null
  std::shared_ptr<const TileMesh> tile;    // null for a chunk
};

/// Returns the memory of a chunk in the renderer: its quads, and at most its runs once more, with a
/// byte for each column. `voxels` may be null.
std::size_t gpu_bytes(const ChunkMesh& mesh, const RunChunk* voxels);
/// Returns the memory of a tile in the renderer: its quads, and a number for each of their layers.
/// A tile has no light.
std::size_t gpu_bytes(const TileMesh& mesh);
std::size_t gpu_bytes(const ChunkUpload& upload);

class UploadQueue {
 public:
  /// A change that has waited for this many frames comes before edits of others.
  static constexpr std::uint64_t kPatience = 30;

  /// Queues new quads. They replace a queued change of the same chunk, and keep its rank if that is
  /// higher.
  void put(const ChunkKey& key, ChunkUpload upload);
  /// Queues a removal, which replaces a queued change of the same chunk.
  void remove(const ChunkKey& key);
  void clear() { *this = {}; }

  void set_eye(ChunkCoord eye);
  /// Call it for each frame.
  void frame_passed();

  /// Returns all queued removals, which leave the queue.
  std::vector<ChunkKey> take_removals();
  /// Returns the upload that comes first, which leaves the queue, or nullopt if none is queued.
  std::optional<std::pair<ChunkKey, ChunkUpload>> take_upload();
  /// Returns the number of queued changes.
  std::size_t size() const { return uploads_.size() + removals_.size(); }
  bool empty() const { return size() == 0; }
  std::size_t upload_count() const { return uploads_.size(); }

 private:
  using Rank = std::tuple<int, int, std::int64_t, ChunkKey>;
  struct Entry {
    ChunkUpload upload;
    std::uint64_t since = 0;  // the frame in which the chunk began to wait
    bool is_overdue = false;
    Rank rank;
  };
  void place(const ChunkKey& key, Entry& entry);

  std::map<ChunkKey, Entry> uploads_;
  std::set<Rank> order_;  // of uploads_
  std::set<ChunkKey> removals_;
  std::deque<std::pair<std::uint64_t, ChunkKey>> ages_;  // by `since`; may name chunks that left
  std::uint64_t frame_ = 0;
  ChunkCoord eye_;
};

}  // namespace runstone
