// CommitWalk: reads a commit edit by edit and keeps none of them, for a client that verifies every one of thousands and has no
// voxels to apply them to. It checks what decode_message() checks, with the same code, but allocates nothing per edit.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// One edit of a commit. Lives until the function that gets it returns.
struct WalkedEdit {
  Version version;
  const OrderedEdit& ordered;
  std::span<const ChunkCoord> chunks;  // touched_chunks(); ordered.previous has one entry for each
};

/// Holds the room that edits are read into. One thread.
class CommitWalk {
 public:
  using OnEdit = std::function<Result<void>(const WalkedEdit&)>;

  /// A server's message of the class of edits, 8-aligned as FrameReader's are; `chunk_edge` is 16, 32, 64 or 128. Returns
  /// false for anything but a commit, which is then for decode_message(). An error, also one of `on_edit`, ends the walk: the
  /// edits before the bad one have been handed out by then.
  Result<bool> read(ByteView bytes, std::uint16_t chunk_edge, const OnEdit& on_edit);

 private:
  OrderedEdit edit_;
  std::vector<ChunkCoord> chunks_;
};

}  // namespace runstone
