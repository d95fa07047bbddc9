// CommitScheduler: decides when queued edits become a commit, and calls `commit` on the world
// strand then. Edits that arrive together become one commit. CommitPace computes the delay.
// Threads: the world strand.
#pragma once
#include <functional>

#include "server/net/net_session.hpp"
#include "server/runtime/world_strand.hpp"
#include "server/world/order/commit_pace.hpp"

namespace runstone {

class CommitScheduler {
 public:
  /// `strand` and `net` must outlive the object.
  CommitScheduler(WorldStrand& strand, const NetCounters& net, std::function<void()> commit);

  /// Schedules a commit of the queued edits. Does nothing while a commit is scheduled.
  void schedule();

 private:
  void commit_now();

  WorldStrand& strand_;
  const NetCounters& net_;
  const std::function<void()> commit_;
  asio::steady_timer timer_;
  CommitPace pace_;
  bool is_scheduled_ = false;
};

}  // namespace runstone
