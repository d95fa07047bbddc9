// TrafficMeter: counts the messages of one direction by kind. Threads: one thread counts, any
// thread reads.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "protocol/codec/message_traffic.hpp"

namespace runstone {

class TrafficMeter {
 public:
  /// Counts a message of `bytes` bytes, without frame headers, that `frames` frames carried.
  void add(MessageKind kind, std::size_t bytes, std::uint64_t frames) {
    Cell& cell = cells_[kind];
    cell.messages.fetch_add(1, std::memory_order_relaxed);
    cell.bytes.fetch_add(bytes, std::memory_order_relaxed);
    cell.frames.fetch_add(frames, std::memory_order_relaxed);
  }
  Traffic read() const {
    Traffic out;
    for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
      out[kind] = {cells_[kind].messages, cells_[kind].bytes, cells_[kind].frames};
    }
    return out;
  }

 private:
  struct Cell {
    std::atomic<std::uint64_t> messages{0}, bytes{0}, frames{0};
  };
  std::array<Cell, kMessageKindCount> cells_{};
};

}  // namespace runstone
