// PastView: records if a replica shows the live world or a moment of the past, and adapts its
// chunks when this changes. In the past the chunks are read-only: snapshots replace them, and
// nothing is predicted or applied. One thread.
#pragma once
#include <optional>

#include "client/replica/replica_chunks.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// A moment of the past that a replica shows.
struct PastMoment {
  Sequence seq = 0;   // its last edit; 0: before the first one
  TimeUs utc_us = 0;  // when that edit was ordered
};

class PastView {
 public:
  /// Returns nullopt while the live world is shown.
  const std::optional<PastMoment>& moment() const { return moment_; }
  bool is_past() const { return moment_.has_value(); }

  /// Shows a moment of the past, or the live world if `moment` is nullopt. What is shown stays
  /// until snapshots arrive.
  ///   - Into the past: pending edits and inboxes are cleared.
  ///   - From moment to moment: chunks stay current, because the server sends only those that
  ///     differ.
  ///   - Otherwise every chunk is expected again.
  /// Cost: O(chunks).
  void show(const std::optional<PastMoment>& moment, ReplicaChunks& chunks);
  /// Shows the live world, because a new connection begins.
  void reset() { moment_.reset(); }

 private:
  std::optional<PastMoment> moment_;
};

}  // namespace runstone
