// Authority: gives edits their one order. An offered edit is checked and queued or refused at once; commit()
// gives what is queued consecutive sequence numbers, moves the versions of the chunks touched, and publishes
// each touched chunk that is in memory exactly once. It knows no clock, socket, disk or thread; same offers,
// same result. Rules:
//   - sequences have no gaps and continue the log of the last start; the epoch is that of this start;
//   - a commit needs no voxels: a chunk that is not in memory keeps its edits on its stack until
//     it is loaded;
//   - an operation (author, instance, client sequence) is decided once: see OperationWatermarks.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/clocks.hpp"
#include "server/world/edit_check.hpp"
#include "server/world/operation_watermarks.hpp"
#include "server/world/world_chunks.hpp"

namespace runstone {

/// Where the log stands when a server starts.
struct LogPosition {
  Epoch epoch = 1;          // of this start, already raised
  Sequence last = 0;        // last sequence in the log: all of it is durable
  TimeUs last_time_us = 0;  // of that record; 0 without one
};

struct EditOffer {
  OperationId op;
  Cause cause = Cause::player;
  TimeUs submitted_us = 0;
  EditDescriptor edit;
  Sequence subject = 0;  // as in EditRecord: the edit this one answers; 0: none
};

/// One commit: the message, the records for the log, and the chunks it touched, ascending.
struct OrderedBatch {
  Commit commit;
  std::vector<EditRecord> records;
  std::vector<ChunkKey> touched;
};

class Authority {
 public:
  Authority(const EditLimits& limits, const LogPosition& log);

  // ---- start: before the first offer
  WorldChunks& chunks() { return chunks_; }
  const WorldChunks& chunks() const { return chunks_; }
  OperationWatermarks& resolved() { return resolved_; }
  const OperationWatermarks& resolved() const { return resolved_; }
  /// A record of the log above the checkpoint: back on the stacks of the chunks it touches. In log order.
  void replay_onto_stack(const EditRecord& record);

  // ---- edits
  /// Nothing: queued, and its client sequence is decided. Else why not, which decides it too: busy (if
  /// `log_has_room` is false) or what check_edit() says, for another cause than player check_server_edit(). An edit decided before is answered as it was then:
  /// with its refusal, or already_resolved.
  std::optional<RejectReason> submit(const EditOffer& offer, bool log_has_room);
  /// Decides a client sequence without an edit: it was refused for a reason outside the authority's sight.
  void refuse(const OperationId& op, RejectReason reason) { resolved_.refuse(op, reason); }

  std::size_t queued() const { return queue_.size(); }
  /// Orders as many queued edits as one commit message may carry; nothing if none is queued. Call again until
  /// then. O(per touched chunk: runs + its edits).
  std::optional<OrderedBatch> commit(const Clocks& now);

  Epoch epoch() const { return epoch_; }
  /// The sequence that an edit which was ever accepted has at most.
  Sequence sequence_bound() const { return head_ + queue_.size(); }
  /// Last sequence ordered.
  Sequence head() const { return head_; }

 private:
  EditLimits limits_;
  Epoch epoch_;
  Sequence head_;
  TimeUs last_time_us_;
  WorldChunks chunks_;
  OperationWatermarks resolved_;
  std::deque<EditOffer> queue_;
};

}  // namespace runstone
