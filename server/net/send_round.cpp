#include "server/net/send_round.hpp"

#include <asio/dispatch.hpp>
#include <asio/post.hpp>
#include <utility>

#include "common/os/thread_cpu_ns.hpp"

namespace runstone {

void SendRound::start_group() {
  if (group_.empty()) return;
  asio::post(io_, [group = std::exchange(group_, {}), &counters = counters_,
                   is_of_commit = is_of_commit_] { write(group, counters, is_of_commit); });
}

void SendRound::write(const Group& group, NetCounters& counters, bool is_of_commit) {
  const std::int64_t began_ns = thread_cpu_ns();
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (i + 2 < group.size()) group[i + 2]->prefetch();
    if (i + 1 < group.size()) group[i + 1]->prefetch_stream();
    // It runs here, unless another thread runs the session's strand now.
    asio::dispatch(group[i]->strand_, [session = group[i], &counters] {
      if (session->write_at_once()) counters.commit_sends.fetch_add(1, std::memory_order_relaxed);
    });
  }
  if (is_of_commit)
    counters.commit_send_ns.fetch_add(thread_cpu_ns() - began_ns, std::memory_order_relaxed);
}

}  // namespace runstone
