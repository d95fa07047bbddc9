#include "server/runtime/commit_scheduler.hpp"

#include <catch2/catch.hpp>
#include <utility>
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
  WorldStrand strand(io, [] {});
  std::vector<TimeUs> commits_us;
  CommitScheduler scheduler(strand, net, [&] { commits_us.push_back(steady_now_us()); });
  const auto edit = [&] { scheduler.schedule(); };
  strand.post(edit);
  io.run();
  REQUIRE(commits_us.size() == 1);

  net.commit_send_ns = 1'000'000'000;
  net.commit_sends = 1'000;
  const TimeUs began_us = steady_now_us();
  io.restart();
  strand.post(edit);
  strand.post(edit);
  io.run();
  REQUIRE(commits_us.size() == 2);
  CHECK(commits_us[1] - began_us >= CommitPace::kGatherUsMax);
}

}  // namespace
}  // namespace runstone::test
