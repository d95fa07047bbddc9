#include "server/runtime/commit_scheduler.hpp"

#include <chrono>
#include <utility>

#include "common/os/steady_clock.hpp"

namespace runstone {

CommitScheduler::CommitScheduler(WorldStrand& strand, const NetCounters& net,
                                 std::function<void()> commit)
    : strand_(strand), net_(net), commit_(std::move(commit)), timer_(strand.make_timer()) {}

void CommitScheduler::schedule() {
  if (std::exchange(is_scheduled_, true)) return;
  const TimeUs now_us = steady_now_us();
  const CommitSending sending{net_.commit_send_ns.load() / 1'000, net_.commit_sends.load(),
                              net_.commits_due.load()};
  const TimeUs due_us = pace_.due(now_us, sending);
  if (due_us <= now_us) {
    // The commit runs after everything that is queued on the strand now, so it includes those
    // edits.
    strand_.post([this] { commit_now(); });
    return;
  }
  timer_.expires_after(std::chrono::microseconds(due_us - now_us));
  strand_.wait(timer_, [this](const asio::error_code&) { commit_now(); });
}

void CommitScheduler::commit_now() {
  is_scheduled_ = false;
  commit_();
}

}  // namespace runstone
