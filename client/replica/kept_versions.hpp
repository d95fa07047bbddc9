// KeptVersions: which chunks, kept over the end of a connection, are still history that the server shares. After a crash
// it comes back without the edits that were not durable, and gives their numbers to others. Pure.
#pragma once
#include <algorithm>
#include <optional>

#include "common/core/ids.hpp"

namespace runstone {

/// What was last known of a world's server.
struct ServerMark {
  Epoch epoch = 0;
  Sequence durable = 0;  // heard to be on disk
  Sequence head = 0;     // newest heard of
  friend bool operator==(const ServerMark&, const ServerMark&) = default;
};

class KeptVersions {
 public:
  /// `before`: of the connection on which the chunks were kept; nothing if there was none. `now`: in the new welcome.
  KeptVersions(const std::optional<ServerMark>& before, const ServerMark& now) : epoch_(now.epoch) {
    // Of what the last server ordered, only what was heard to be durable survived its end for sure: by now the log may
    // have grown past that again, with other edits.
    common_ = before ? std::min(before->durable, now.durable) : 0;
    // Neither epochs nor durable sequences go back but where a backup was restored: no number says what is common then.
    went_back_ = before && (now.epoch < before->epoch || now.durable < before->durable ||
                            (now.epoch == before->epoch && now.head < before->head));
  }

  bool went_back() const { return went_back_; }
  /// The newest sequence of an earlier epoch that is common for sure.
  Sequence common() const { return common_; }
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
