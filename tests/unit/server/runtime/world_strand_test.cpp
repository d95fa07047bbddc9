#include "server/runtime/world_strand.hpp"

#include <asio/executor_work_guard.hpp>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace runstone::test {
namespace {

using Calls = std::vector<std::string>;

TEST_CASE("every task of the world strand is followed by the same call", "[server]") {
  asio::io_context io;
  Calls calls;
  WorldStrand strand(io, [&] { calls.emplace_back("after"); });
  strand.post([&] {
    calls.emplace_back("first");
    strand.post([&] { calls.emplace_back("third"); });
  });
  strand.post([&] { calls.emplace_back("second"); });
  CHECK(calls.empty());
  io.run();
  CHECK(calls == Calls{"first", "after", "second", "after", "third", "after"});
}

TEST_CASE("an expired and a cancelled timer are tasks of the world strand", "[server]") {
  asio::io_context io;
  Calls calls;
  WorldStrand strand(io, [&] { calls.emplace_back("after"); });
  asio::steady_timer soon = strand.make_timer();
  asio::steady_timer never = strand.make_timer();
  soon.expires_after(std::chrono::milliseconds(1));
  never.expires_at(asio::steady_timer::time_point::max());
  strand.wait(soon, [&](const asio::error_code& error) {
    calls.emplace_back(error ? "cancelled" : "expired");
    CHECK(strand.is_current());
    never.cancel();
  });
  strand.wait(never, [&](const asio::error_code& error) {
    calls.emplace_back(error ? "cancelled" : "expired");
  });
  io.run();
  CHECK(calls == Calls{"expired", "after", "cancelled", "after"});
  CHECK_FALSE(strand.is_current());
}

constexpr std::chrono::milliseconds kShort{20};

/// A strand that threads run.
struct RunningStrand {
  ~RunningStrand() {
    work.reset();
    for (std::thread& thread : threads) thread.join();
  }
  asio::io_context io;
  asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};
  std::atomic<int> tasks{0};
  WorldStrand strand{io, [this] { ++tasks; }};
  std::vector<std::thread> threads;
  /// Starts two threads.
  void run() {
    for (int i = 0; i < 2; ++i) threads.emplace_back([this] { io.run(); });
  }
};

TEST_CASE("a question runs on the strand, behind the tasks before it", "[server]") {
  RunningStrand running;
  int value = 1;
  running.strand.post([&] { value = 2; });
  running.run();
  const Result<int, std::string> answer = running.strand.ask([&] {
    CHECK(running.strand.is_current());
    return 10 * value;
  });
  REQUIRE(answer.has_value());
  CHECK(*answer == 20);
  // An answer need not be copied.
  const auto moved = running.strand.ask([] { return std::make_unique<int>(3); });
  CHECK(**moved == 3);
  // Several threads may ask.
  std::thread other([&] {
    for (int i = 0; i < 100; ++i) static_cast<void>(running.strand.ask([&] { return ++value; }));
  });
  for (int i = 0; i < 100; ++i) CHECK(running.strand.ask([&] { return ++value; }).has_value());
  other.join();
  CHECK(*running.strand.ask([&] { return value; }) == 202);
}

TEST_CASE("a question that is refused gives the reason", "[server]") {
  RunningStrand running;
  running.run();
  const Result<int, std::string> refused =
      running.strand.ask([]() -> Result<int, std::string> { return failure("not now"); });
  CHECK(refused.error() == "not now");
}

TEST_CASE("a question that no thread answers in time never runs", "[server]") {
  RunningStrand running;
  bool has_run = false;
  const auto answer = running.strand.ask(
      [&has_run] {
        has_run = true;
        return 1;
      },
      kShort);
  CHECK_FALSE(answer.has_value());
  CHECK_FALSE(answer.error().empty());
  running.run();
  CHECK(running.strand.ask([] { return 2; }).has_value());  // behind the other one
  CHECK_FALSE(has_run);
}

TEST_CASE("a question that has begun is waited for", "[server]") {
  RunningStrand running;
  running.run();
  bool has_run = false;
  const auto answer = running.strand.ask(
      [&has_run] {
        std::this_thread::sleep_for(5 * kShort);
        return has_run = true;
      },
      kShort);
  CHECK(answer.has_value() == has_run);  // a busy machine may not have begun it
}

TEST_CASE("a question whose answer comes later runs with every task until then", "[server]") {
  RunningStrand running;
  int value = 0, runs = 0;
  running.run();
  std::thread other([&] {
    for (int i = 0; i < 5; ++i) running.strand.post([&] { ++value; });
  });
  const auto answer = running.strand.ask_until([&]() -> std::optional<int> {
    ++runs;
    return value == 5 ? std::optional(value) : std::nullopt;
  });
  other.join();
  CHECK(*answer == 5);
  const int runs_then = *running.strand.ask([&] { return runs; });
  CHECK(runs_then <= 6);
  CHECK(*running.strand.ask([&] { return runs; }) == runs_then);  // it is answered

  const auto never = running.strand.ask_until(
      [&]() -> std::optional<int> {
        ++runs;
        return std::nullopt;
      },
      kShort);
  CHECK_FALSE(never.has_value());
  const int runs_at_end = *running.strand.ask([&] { return runs; });
  CHECK(*running.strand.ask([&] { return runs; }) == runs_at_end);
}

TEST_CASE("what a question changes is followed by the call that follows every task", "[server]") {
  asio::io_context io;
  Calls calls;
  WorldStrand strand(io, [&] { calls.emplace_back("after"); });
  std::thread asks([&] {
    static_cast<void>(strand.ask([&] {
      calls.emplace_back("question");
      return 0;
    }));
  });
  while (io.run_one() == 0) io.restart();
  asks.join();
  CHECK(calls == Calls{"question", "after"});
}

}  // namespace
}  // namespace runstone::test
