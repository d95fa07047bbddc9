// SendRound: wakes the writers of all sessions for which one message was queued. A task for each session
// would cost more than most writes. So one task writes for a group of sessions, one after another, and
// fetches the memory of the next sessions while it writes for one.
// Threads: one; a session adds itself in NetSession::send(). The tasks run on the I/O threads.
#pragma once
#include <asio/io_context.hpp>
#include <memory>
#include <vector>

#include "server/net/net_session.hpp"

namespace runstone {

class SendRound {
 public:
  /// `io` and `counters` must outlive the tasks. `is_of_commit`: the message is a Commit.
  SendRound(asio::io_context& io, NetCounters& counters, bool is_of_commit)
      : io_(io), counters_(counters), is_of_commit_(is_of_commit) {}
  /// Starts the last task.
  ~SendRound() { start_group(); }
  SendRound(const SendRound&) = delete;
  SendRound& operator=(const SendRound&) = delete;

  /// Adds a session whose writer is idle: NetSession::take_wake() was true.
  void add(std::shared_ptr<NetSession> session) {
    if (group_.empty()) group_.reserve(kGroupSessions);
    group_.push_back(std::move(session));
    if (group_.size() == kGroupSessions) start_group();
  }

 private:
  // 32 writes with encryption take about 0.4 ms. Other tasks of the thread wait for that long.
  static constexpr std::size_t kGroupSessions = 32;
  using Group = std::vector<std::shared_ptr<NetSession>>;

  void start_group();
  static void write(const Group& group, NetCounters& counters, bool is_of_commit);

  asio::io_context& io_;
  NetCounters& counters_;
  const bool is_of_commit_;
  Group group_;
};

}  // namespace runstone
