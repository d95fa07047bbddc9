// TrackedChunk: what a replica keeps of one chunk: confirmed and shown runs, own edits that confirmed lacks,
// and edits that came ahead of their turn. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/core/ids.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/runs/chunk.hpp"

namespace runstone {

using ShownPtr = std::shared_ptr<const RunChunk>;

/// What all chunks of one ordered edit share.
struct OrderedInfo {
  OperationId op;
  Version version;
  EditDescriptor edit;
  Sequence subject = 0;                     // as in OrderedEdit
  bool own = false;                         // made by this client instance
  TimeUs submitted_us = 0, ordered_us = 0;  // server steady clock
  TimeUs received_us = 0, unpacked_us = 0;  // this client's
};
using OrderedPtr = std::shared_ptr<const OrderedInfo>;

struct TrackedChunk {
  /// An edit that waits for its turn.
  struct Inbound {
    OrderedPtr info;
    Sequence previous = 0;  // sequence the chunk stood at before it
  };
  /// An own edit that confirmed does not contain yet.
  struct Pending {
    ClientSequence seq = 0;
    EditDescriptor edit;
    Sequence decided_at = 0;  // 0: not answered yet
    bool until_snapshot =
        false;  // answered while we could not listen: the next snapshot settles it
  };

  ChunkPtr confirmed;        // null until the first snapshot, and after a restart that distrusts it
  ShownPtr shown;            // null until the first snapshot
  std::uint64_t serial = 0;  // of the picture, see Replica::shown_serial()
  std::vector<Pending> pending;  // ascending by seq
  std::vector<Inbound> inbox;    // ascending by sequence
  Sequence latest = 0;           // newest edit of this chunk seen on this connection
  bool current = false;          // a snapshot of it came on this connection
  Version audited_at;  // of the newest audit that told of a version above ours, on this connection
  bool awaiting = false;  // asked for a snapshot: nothing else is taken
  bool claimed = false;   // the server was told on this connection that it is held
  bool unavailable =
      false;  // said the server on this connection; then nothing is held, shown or kept back
  std::optional<TimeUs> requested_us;
  std::optional<Version> kept;  // of confirmed, as it was last handed over to be kept

  /// The server vouches for confirmed, and it is not the copy that was kept last.
  bool is_to_keep() const {
    return confirmed && current && !awaiting && kept != confirmed->version;
  }

  /// Puts an own edit into the pending stack, at its place, unless it is there.
  void add_pending(ClientSequence seq, const EditDescriptor& edit);
  bool drop_pending(ClientSequence seq);
  /// Drops what a snapshot at `seq` is known to contain or to settle. Returns how many.
  std::size_t settle_pending(Sequence seq);

  /// What the inbox holds in order, taken out of it: from the front, until an edit does not follow.
  struct InOrder {
    std::vector<EditDescriptor> stack;  // to be applied to confirmed
    std::vector<OrderedPtr> applied;    // the same edits
    std::vector<OrderedPtr> contained;  // confirmed has them already
    Version version;                    // after the stack
  };
  /// Requires confirmed.
  InOrder take_in_order();

  /// The runs to show: confirmed itself, or a copy with the pending stack applied. Requires confirmed.
  ShownPtr predicted(VoxelPos origin, ApplyScratch& scratch) const;
};

}  // namespace runstone
