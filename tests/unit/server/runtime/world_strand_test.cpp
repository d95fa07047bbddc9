#include "server/runtime/world_strand.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <string>
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

}  // namespace
}  // namespace runstone::test
