#include "server/runtime/periodic_task.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

TEST_CASE("a periodic task runs until it stops itself", "[server]") {
  asio::io_context io;
  WorldStrand strand(io, [] {});
  int runs = 0;
  PeriodicTask* self = nullptr;
  PeriodicTask task(strand, std::chrono::milliseconds(1), [&] {
    if (++runs == 3) self->stop();
  });
  self = &task;
  task.start();
  io.run();  // returns because nothing waits any more
  CHECK(runs == 3);
}

TEST_CASE("a periodic task that is stopped while it waits does not run", "[server]") {
  asio::io_context io;
  WorldStrand strand(io, [] {});
  int runs = 0;
  PeriodicTask task(strand, std::chrono::hours(1), [&] { ++runs; });
  task.start();
  strand.post([&] { task.stop(); });
  io.run();
  CHECK(runs == 0);
}

TEST_CASE("a periodic task that was stopped starts again, and runs once in an interval",
          "[server]") {
  asio::io_context io;
  WorldStrand strand(io, [] {});
  int runs = 0;
  PeriodicTask* self = nullptr;
  PeriodicTask task(strand, std::chrono::milliseconds(1), [&] {
    ++runs;
    if (runs == 1 || runs == 4) self->stop();
    if (runs == 1) self->start();
  });
  self = &task;
  task.start();
  io.run();
  CHECK(runs == 4);
}

}  // namespace
}  // namespace runstone::test
