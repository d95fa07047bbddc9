// Commits: takes a commit from the queue to the sessions: orders its edits, applies its changes of
// rights and materials, appends it to the log, and sends it. A session gets the edits that concern
// it and no others. Sessions that get the same edits share one message.
// Thread: the world strand.
#pragma once
#include <span>
#include <vector>

#include "server/world/ground/ground.hpp"
#include "server/world/order/receipts.hpp"

namespace runstone {

class Commits {
 public:
  /// The arguments must outlive the object.
  Commits(const WorldConfig& config, WorldCounters& counters, Sessions& sessions, Order& order,
          Receipts& receipts, Rights& rights, Ground& ground)
      : config_(config),
        counters_(counters),
        sessions_(sessions),
        order_(order),
        receipts_(receipts),
        rights_(rights),
        ground_(ground) {}

  /// Returns true if commit() with paced large edits would order edits.
  bool has_ready_edits(TimeUs now_us) const {
    return order_.has_ready_edits(sessions_.count(), now_us);
  }
  /// Orders the queued edits of one commit, appends them to the log, and sends each edit to the
  /// subscribers of the chunks that it touched and to the session of its client. Returns false if
  /// no edit is queued that may be ordered now. Cost: O(edits + subscribers of touched chunks), and
  /// that of audiences_of().
  bool commit(LargeEdits large, const Clocks& now);
  /// Orders and sends queued edits as long as there are any that may be ordered.
  void commit_all(LargeEdits large, const Clocks& now) {
    while (commit(large, now)) {
    }
  }

  /// Applies records that another server has ordered, which continue the log, and sends them.
  void apply_ordered(std::span<const LogPartRecord> records, const Clocks& now);
  /// Begins an epoch of the log, in which all that came before stays.
  void begin_epoch(Epoch epoch);

 private:
  /// Applies the changes of rights, materials, textures, the library and the clock among these
  /// records. Closes the sessions that may not stay.
  void apply(const std::vector<EditRecord>& records, const Clocks& now);
  /// Sends edits that were ordered to the sessions, and does what they make necessary for tiles and
  /// for chunks that are not in memory.
  void send_batch(const OrderedBatch& batch, const Clocks& now);
  void send(const OrderedBatch& batch, const Clocks& now);
  std::vector<std::vector<SessionId>> receivers_of(const OrderedBatch& batch) const;
  void drop_edits_for(SessionId session, const OrderedBatch& batch,
                      const std::vector<std::uint32_t>& edits, const Clocks& now);

  const WorldConfig& config_;
  WorldCounters& counters_;
  Sessions& sessions_;
  Order& order_;
  Receipts& receipts_;
  Rights& rights_;
  Ground& ground_;
};

}  // namespace runstone
