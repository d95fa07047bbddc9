#include "server/net/chunk_gate.hpp"

#include <catch2/catch.hpp>
#include <deque>
#include <vector>

namespace runstone {
namespace {

constexpr std::size_t kFrame = kFragmentBytesMax + kFrameHeaderBytes;

/// Sends as much as possible for a while, in steps of 200 microseconds. Returns the bytes.
std::uint64_t send_for(ChunkGate& gate, TimeUs from_us, TimeUs span_us) {
  std::uint64_t bytes = 0;
  for (TimeUs now_us = from_us; now_us < from_us + span_us; now_us += 200) {
    while (const std::size_t body = gate.open(now_us)) {
      gate.sent(body + kFrameHeaderBytes, 0, now_us);
      bytes += body + kFrameHeaderBytes;
      if (bytes > 1'000'000'000) return bytes;
    }
  }
  return bytes;
}

TEST_CASE("without budgets and acknowledgements only TCP limits terrain", "[net]") {
  ByteBudget none(0);
  ChunkGate gate(0, none);
  CHECK(gate.open(0) == kFragmentBytesMax);
  CHECK(send_for(gate, 0, 1'000) > 1'000'000'000);
}

TEST_CASE("terrain uses the socket's room, and books no slot if there is none", "[net]") {
  ByteBudget none(0);
  ChunkGate gate(1'000'000, none);
  for (TimeUs now_us = 0; now_us < 10'000'000; now_us += 1'000) {
    CHECK(gate.open(now_us, 0) == 0);
    CHECK(gate.open(now_us, kFrameHeaderBytes) == 0);
  }
  CHECK(gate.next_us(10'000'000) == 10'000'000);
  CHECK(gate.open(10'000'000, 1448) == 1448 - kFrameHeaderBytes);
  CHECK(gate.open(10'000'000, 1 << 20) == kFragmentBytesMax);
}

TEST_CASE("a session sends no more terrain than its budget, and nearly all of it", "[net]") {
  ByteBudget none(0);
  ChunkGate gate(1'000'000, none);
  const std::uint64_t bytes = send_for(gate, 0, 10'000'000);
  CHECK(bytes <= 10'000'000 + 2 * kFrame);
  CHECK(bytes >= 9'700'000);
  CHECK(gate.open(10'000'000) == 0);
  const TimeUs next_us = gate.next_us(10'000'000);
  CHECK(next_us > 10'000'000);
  CHECK(gate.open(next_us) > 0);
}

TEST_CASE("edits do not wait for a budget, but their bytes count, and terrain is still sent",
          "[net]") {
  ByteBudget none(0);
  ChunkGate gate(1'000'000, none);
  std::uint64_t chunks = 0;
  for (TimeUs now_us = 0; now_us < 10'000'000; now_us += 1'000) {
    gate.sent(0, 500, now_us);  // half a megabyte a second
    chunks += send_for(gate, now_us, 1'000);
  }
  CHECK(chunks >= 4'500'000);
  CHECK(chunks <= 5'500'000);
  for (TimeUs now_us = 10'000'000; now_us < 20'000'000; now_us += 1'000) {
    gate.sent(0, 5'000, now_us);  // five times the budget
    chunks += send_for(gate, now_us, 1'000);
  }
  CHECK(chunks >= 4'500'000 + 30 * kFrame);
}

TEST_CASE(
    "the server's budget is shared fairly by those who have terrain, and idle ones leave no gap",
    "[net]") {
  ByteBudget all(3'000'000);
  std::deque<ChunkGate> gates;
  for (int i = 0; i < 10; ++i) gates.emplace_back(0, all);
  std::vector<std::uint64_t> bytes(gates.size());
  const auto run = [&](TimeUs from_us, std::size_t active) {
    for (TimeUs now_us = from_us; now_us < from_us + 10'000'000; now_us += 1'000) {
      for (std::size_t i = 0; i < active; ++i) bytes[i] += send_for(gates[i], now_us, 1'000);
    }
  };
  run(0, 10);
  for (const std::uint64_t each : bytes) {
    CHECK(each >= 2'700'000);
    CHECK(each <= 3'300'000);
  }
  bytes.assign(gates.size(), 0);
  run(10'000'000, 2);
  CHECK(bytes[0] + bytes[1] >= 29'000'000);
  CHECK(bytes[0] + bytes[1] <= 30'000'000 + 12 * kFrame);
  CHECK(bytes[0] >= 14'000'000);
  CHECK(bytes[1] >= 14'000'000);
}

TEST_CASE("a session with a slow link still gets its share of the server's budget", "[net]") {
  ByteBudget all(1'000'000);
  ChunkGate fast(0, all), slow(0, all);
  slow.pace();
  std::uint64_t fast_bytes = 0, slow_sent = 0, slow_read = 0;
  for (TimeUs now_us = 0; now_us < 10'000'000; now_us += 1'000) {
    fast_bytes += send_for(fast, now_us, 1'000);
    slow_sent += send_for(slow, now_us, 1'000);
    slow_read = std::min(slow_sent, slow_read + 400);  // 400 kB a second
    if (now_us % 10'000 == 0 && slow_read > 0) REQUIRE(slow.acked(slow_read, now_us).has_value());
  }
  CHECK(slow_read >= 3'000'000);
  CHECK(fast_bytes >= 5'400'000);
}

}  // namespace
}  // namespace runstone
