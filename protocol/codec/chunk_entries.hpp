// The entries of Chunks messages. A server encodes a chunk once, without its place in a message,
// and joins the entries that a session waits for to one message. So many small chunks share one
// envelope. docs/protocol.md specifies the bytes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// What a session gets for one chunk. The bytes are shared by all sessions with one encoding.
struct ChunkEntry {
  ChunkKey key;
  std::shared_ptr<const Bytes> bytes;
  std::size_t runs = 0;  // of a snapshot
};

/// Makes the snapshot of a chunk. Reads runs and makes no dense copy. Cost: O(runs). Thread: any.
ChunkEntry encode_snapshot(const ChunkKey& key, const Chunk& chunk, ChunkEncoding encoding);
/// Requires 1 .. kChunkEditsMax edits as ChunkEdits describes. Thread: any.
ChunkEntry encode_chunk_edits(const ChunkEdits& edits);

/// Makes a Chunks message. Requires 1 .. kChunksPerMessageMax entries, strictly ascending by key
/// and of one level of detail. Several entries may have at most kRunsPerMessageMax runs together.
/// Cost: it copies the bytes. Thread: any.
EncodedMessage join_entries(std::uint32_t view, std::span<const ChunkEntry> entries);

/// Gathers the entries of one message, as many as a sender should join. Thread: one.
class ChunksBuilder {
 public:
  /// Of the entries in a message. A client decodes a message when it has all of it, so more would
  /// show chunks later.
  static constexpr std::size_t kBytesMax = 4 * 1024;

  /// Returns true if the entry may join those that were added. The first entry always may. A chunk
  /// that is added already may not: its entries keep their order in two messages. Neither may a
  /// chunk of another level of detail.
  bool fits(const ChunkEntry& entry) const;
  /// Adds an entry that fits. Entries may come in any order.
  void add(ChunkEntry entry);
  bool empty() const { return entries_.empty(); }
  /// Returns the message and begins the next one. Requires an entry.
  EncodedMessage take(std::uint32_t view);

 private:
  std::vector<ChunkEntry> entries_;
  std::size_t bytes_ = 0, runs_ = 0;
};

// ---- Internal to the message codec

/// Makes an entry of either form, with snapshots as `raw`.
ChunkEntry encode_answer(const ChunkAnswer& answer);
/// Returns the byte list of a Chunks message.
Bytes list_of(std::span<const ChunkEntry> entries);
/// `level` is that of all entries. `key_edge` bounds the keys. `chunk_edge` is the edge of the
/// world's chunks, or 0 if it is not known: then chunks of any size are accepted. Rejects tiles
/// that are not snapshots.
Result<std::vector<ChunkAnswer>> decode_answers(ByteView bytes, std::uint8_t level,
                                                std::int32_t key_edge, std::int32_t chunk_edge);

}  // namespace runstone
