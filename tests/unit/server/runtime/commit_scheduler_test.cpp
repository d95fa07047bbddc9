#include "server/runtime/commit_scheduler.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/os/steady_clock.hpp"

namespace runstone::test {
namespace {

TEST_CASE("edits that arrive together become one commit", "[server]") {
  asio::io_context io;
  NetCounters net;
  WorldStrand strand(io, [] {});
  int queued = 0;
  std::vector<int> commits;
  CommitScheduler scheduler(strand, net, [&] { commits.push_back(std::exchange(queued, 0)); });
  const auto edit = [&] {
    ++queued;
    scheduler.schedule();
  };
  strand.post(edit);
  strand.post(edit);
  io.run();
  CHECK(commits == std::vector{2});
  io.restart();
  strand.post(edit);
  io.run();
  CHECK(commits == std::vector{2, 1});
}

TEST_CASE("a commit waits while sending commits takes too much time", "[server]") {
  asio::io_context io;
  NetCounters net;
  net.commit_send_ns = 1'000'000'000;
  net.commit_sends = 1'000;
  WorldStrand strand(io, [] {});
  TimeUs committed_us = 0;
  int commits = 0;
  CommitScheduler scheduler(strand, net, [&] {
    committed_us = steady_now_us();
    ++commits;
  });
  const TimeUs began_us = steady_now_us();
  strand.post([&] { scheduler.schedule(); });
  strand.post([&] { scheduler.schedule(); });
  io.run();
  CHECK(commits == 1);
  CHECK(committed_us - began_us >= CommitPace::kGatherUsMax);
}

}  // namespace
}  // namespace runstone::test
