// ChunkSender: encodes chunks on the workers and queues them on a session's connection. A chunk
// gets its place in the session's queue before it is encoded, so chunks leave in the order of the
// calls.
// Threads: the world strand calls it; workers encode.
#pragma once
#include <asio/thread_pool.hpp>
#include <cstdint>
#include <memory>

#include "common/runs/chunk.hpp"
#include "server/history/chunk_source.hpp"
#include "server/net/net_session.hpp"
#include "server/runtime/encoded_chunks.hpp"

namespace runstone {

class ChunkSender {
 public:
  /// `workers` and `chunks` must outlive the object; the workers must have ended when it is
  /// destroyed.
  ChunkSender(asio::thread_pool& workers, ChunkSource& chunks)
      : workers_(workers), chunks_(chunks) {}

  /// Queues the chunk's snapshot as an answer to the view of this number. Returns false if the
  /// session's queue is full.
  bool send_snapshot(const std::shared_ptr<NetSession>& session, std::uint32_t view,
                     const ChunkKey& key, const ChunkPtr& chunk);
  /// Queues a tile that replaces one that the session has, in the encoding of chunks.
  bool send_changed_tile(const std::shared_ptr<NetSession>& session, std::uint32_t view,
                         const ChunkKey& key, const ChunkPtr& tile);
  /// Queues the edits that lead from version `held` to the chunk, or its snapshot if that is
  /// shorter or if the log cannot be read. Requires that these edits are durable. Returns false if
  /// the session's queue is full.
  bool send_update(const std::shared_ptr<NetSession>& session, std::uint32_t view,
                   const ChunkKey& key, const ChunkPtr& chunk, Version held);

  /// Returns how many snapshots were encoded. Thread: any.
  std::uint64_t encoded_count() const { return encoded_.encoded(); }

 private:
  bool queue_snapshot(const std::shared_ptr<NetSession>& session, std::uint32_t view,
                      const ChunkKey& key, const ChunkPtr& chunk, ChunkEncoding encoding);
  ChunkEntry encode_update(const ChunkKey& key, const ChunkPtr& chunk, Version held,
                           ChunkEncoding encoding);

  asio::thread_pool& workers_;
  ChunkSource& chunks_;
  EncodedChunks encoded_;
};

}  // namespace runstone
