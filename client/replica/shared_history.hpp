// SharedHistory: decides which versions that a client holds from an earlier connection are still
// part of the server's history. After a crash a server starts without the edits that were not
// durable, and gives their sequences to other edits. Pure.
#pragma once
#include <algorithm>
#include <optional>

#include "common/core/epoch_branch.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// What a client last knew of the server of a world.
struct ServerMark {
  Epoch epoch = 0;
  Sequence durable = 0;  // newest sequence known to be on disk
  Sequence head = 0;     // newest sequence seen
  friend bool operator==(const ServerMark&, const ServerMark&) = default;
};

class SharedHistory {
 public:
  /// `before`: the mark of the connection on which the chunks were received; nullopt if there was
  /// none. `now`: the mark in the new welcome.
  SharedHistory(const std::optional<ServerMark>& before, const ServerMark& now)
      : epoch_(now.epoch) {
    // Of the edits of an earlier epoch, only those known to be durable survived for sure. The log
    // may have grown past its old end since, with other edits.
    common_ = before ? std::min(before->durable, now.durable) : 0;
    // A restored backup, and a log that has lost edits, is another branch. Other servers may show
    // one only by an epoch or sequence that went back. Then no sequence is common for sure.
    went_back_ = before && (!is_same_branch(now.epoch, before->epoch) ||
                            now.epoch < before->epoch || now.durable < before->durable ||
                            (now.epoch == before->epoch && now.head < before->head));
  }

  /// Returns true if the server stands on a restored backup, or has lost edits.
  bool went_back() const { return went_back_; }
  /// Returns the newest sequence of an earlier epoch that is common for sure.
  Sequence common() const { return common_; }
  /// Returns true if a chunk of this version is the server's, too.
  bool trusts(const Version& version) const {
    const bool may_be_lost = version.epoch < epoch_ && version.seq > common_;
    return !may_be_lost && !(went_back_ && version.seq != 0);
  }

 private:
  Epoch epoch_;
  Sequence common_ = 0;
  bool went_back_ = false;
};

}  // namespace runstone
