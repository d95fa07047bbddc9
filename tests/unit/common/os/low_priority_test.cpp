#include "common/os/low_priority.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <thread>

using namespace runstone;

namespace {

int nice_of_this_thread() { return ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid())); }

}  // namespace

TEST_CASE("low priority applies to the calling thread and the threads it starts, and to no other",
          "[process]") {
  const int before = nice_of_this_thread();
  int own = before, started = before;
  std::thread([&] {
    lower_priority();
    own = nice_of_this_thread();
    std::thread([&] { started = nice_of_this_thread(); }).join();
  }).join();
  CHECK(own >= std::max(before, 10));
  CHECK(started == own);
  CHECK(nice_of_this_thread() == before);
}

TEST_CASE("low disk priority applies to the calling thread", "[process]") {
  constexpr long kLowestBestEffort = 2 << 13 | 7;
  const auto read = [] { return ::syscall(SYS_ioprio_get, 1, 0); };
  const long before = read();
  long lowered = before;
  std::thread([&] {
    lower_disk_priority();
    lowered = read();
  }).join();
  CHECK(lowered == kLowestBestEffort);
  CHECK(read() == before);
}
