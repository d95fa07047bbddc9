// CommitWalk: reads a commit edit by edit and keeps none of them. It serves clients without voxels,
// such as bots, that verify thousands of edits. It makes the checks of decode_message() with the
// same code, but allocates nothing per edit.
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

/// One edit of a commit. It lives until the function that gets it returns.
struct WalkedEdit {
  Version version;
  const OrderedEdit& ordered;
  std::span<const ChunkCoord> chunks;  // touched_chunks(); ordered.previous has one entry for each
};

/// Reuses the memory that edits are read into. Thread: one.
class CommitWalk {
 public:
  using OnEdit = std::function<Result<void>(const WalkedEdit&)>;

  /// Reads the bytes of a Commit message, 8-aligned as FrameReader's are. An error of the message
  /// or of `on_edit` ends the walk; the edits before the bad one have been delivered by then.
  /// Requires a chunk_edge of 16, 32, 64 or 128.
  Result<void> read(ByteView bytes, std::uint16_t chunk_edge, const OnEdit& on_edit);

 private:
  OrderedEdit edit_;
  std::vector<ChunkCoord> chunks_;
};

}  // namespace runstone
