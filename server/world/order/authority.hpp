// Authority: orders the edits of the world. enqueue() checks an edit and queues or rejects it at
// once. commit() gives the queued edits consecutive sequence numbers, raises the versions of the
// touched chunks, and publishes each touched chunk that is in memory exactly once. It uses no
// clock, socket, disk or thread: the same offers give the same result. Rules:
//   - Sequences have no gaps and continue the log of the last start. The epoch is that of this
//     start.
//   - A commit needs no voxels. A chunk that is not in memory keeps its edits on its stack until it
//     is loaded.
//   - An operation (author, instance, client sequence) is resolved once: see OperationWatermarks.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/rules/edit_check.hpp"
#include "server/world/environment/clocks.hpp"
#include "server/world/environment/world_start.hpp"
#include "server/world/order/edit_queue.hpp"
#include "server/world/order/large_actions.hpp"
#include "server/world/order/log_clock.hpp"
#include "server/world/order/open_actions.hpp"
#include "server/world/order/operation_watermarks.hpp"
#include "server/world/order/wait_histogram.hpp"
#include "server/world/order/world_chunks.hpp"

namespace runstone {

/// One commit: its edits, their records for the log, and the chunks that each of them touched.
struct OrderedBatch {
  Commit commit;
  std::vector<EditRecord> records;
  std::vector<std::vector<ChunkKey>> touched;  // of each edit, ascending
  std::vector<ChunkKey> all_touched;           // of all edits, ascending, each once
  std::vector<ChunkPtr> before;  // of all_touched: published before the commit, or null
};

class Authority {
 public:
  Authority(const EditLimits& limits, const LogPosition& log);

  WorldChunks& chunks() { return chunks_; }
  const WorldChunks& chunks() const { return chunks_; }
  OperationWatermarks& resolved() { return resolved_; }
  const OperationWatermarks& resolved() const { return resolved_; }
  /// Puts a record of the log above the checkpoint back on the stacks of the chunks it touches.
  /// Requires log order, before the first enqueue().
  void replay_onto_stack(const EditRecord& record);

  /// Returns why a player's edit cannot be ordered (check_edit()), or nullopt.
  std::optional<RejectReason> check(const EditDescriptor& edit) const {
    return check_edit(edit, limits_);
  }
  /// Returns the limits of players' edits.
  const EditLimits& limits() const { return limits_; }
  /// Queues an edit, so that the next commit() orders it. Fails if the edit is rejected. Either way
  /// the operation is resolved: a second call for it fails in the same way, or as already_resolved.
  /// An edit of a player must pass check_edit(), any other edit check_server_edit(). Requires that
  /// the log has room.
  Result<void, RejectReason> enqueue(const EditOffer& offer);
  /// Edits may use the materials below `count` from now on.
  void set_material_count(std::size_t count) { limits_.material_count = count; }
  /// Resolves an operation that was rejected by a check outside of Authority.
  void reject(const OperationId& op, RejectReason reason) { resolved_.reject(op, reason); }

  /// The actions of the clients with the feature large actions.
  LargeActions& large_actions() { return large_actions_; }
  const LargeActions& large_actions() const { return large_actions_; }
  const EditQueue& queue() const { return queue_; }
  /// Returns how long the edits of players waited to be ordered.
  const WaitHistogram& edit_waits() const { return edit_waits_; }
  /// Adds the wait of an edit that another server has ordered for a player here.
  void add_edit_wait(TimeUs wait_us) { edit_waits_.add(wait_us); }
  /// Advances the log's time, and orders the edits that EditQueue::take(large_room) returns.
  /// Returns nullopt if there are none. Cost: O(runs + edits) for each touched chunk.
  std::optional<OrderedBatch> commit(const Clocks& now, std::uint64_t large_room = kAllLargeEdits);

  /// Makes the log's time that of the wall clock, without a record. Requires that the time is not
  /// ahead: otherwise a CorrectTime does it.
  void accept_wall_clock();
  /// Returns the first record whose time is of the present course of the log's time: the first one of
  /// this server, or behind the last step of the time. It may be behind the head.
  Sequence timed_from() const { return timed_from_; }

  // A server that follows. It orders nothing itself.
  /// Applies records that the owner has ordered, now or earlier. The commit has their order and the
  /// time `now`. Requires records of one epoch that continue the log.
  OrderedBatch apply_ordered(std::span<const LogPartRecord> records, const Clocks& now);
  /// From now on edits are ordered in this epoch. Requires that it is not below epoch().
  void begin_epoch(Epoch epoch) { epoch_ = epoch; }

  /// The time of the log, for its warnings.
  LogClock& log_clock() { return log_clock_; }
  const LogClock& log_clock() const { return log_clock_; }
  Epoch epoch() const { return epoch_; }
  /// Returns the epoch of the last record of the log, 0 if there is none.
  Epoch last_epoch() const { return last_epoch_; }
  /// Returns the last sequence ordered.
  Sequence head() const { return head_; }

 private:
  /// Returns the subject of an edit that gets the sequence `seq`.
  Sequence subject_of(const EditOffer& offer, Sequence seq);
  /// Puts an edit on the stacks of the chunks that it touches, and adds it to the commit.
  void push(OrderedEdit ordered, Version version, OrderedBatch& batch);
  /// Makes all_touched a set, and publishes its chunks.
  void publish_touched(OrderedBatch& batch);

  EditLimits limits_;
  Epoch epoch_, last_epoch_;
  Sequence head_;
  Sequence timed_from_;
  LogClock log_clock_;
  WorldChunks chunks_;
  OperationWatermarks resolved_;
  EditQueue queue_;
  WaitHistogram edit_waits_;
  OpenActions actions_;
  LargeActions large_actions_;
};

}  // namespace runstone
