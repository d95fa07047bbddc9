// WorldLimits: bounds of the memory of a world, and when its changed chunks are saved.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

/// When Checkpointer writes changed chunks as snapshots.
struct SnapshotPolicy {
  // A round begins after so many edits, which bounds the edits that a start replays,
  std::uint64_t edits_max = 20'000;
  // or after this time, if anything was ordered.
  TimeUs interval_us = 30'000'000;
  std::size_t slice_chunks = 128;  // captured, loaded and written at a time
  // A round also begins when the edits that wait for their chunks take so many bytes.
  std::size_t stack_bytes_max = 64ULL << 20;
};

/// Bounds of WorldMemory (server/world/order/world_memory.hpp).
struct MemoryLimits {
  std::size_t idle_bytes_max = 448ULL << 20;
  std::size_t view_bytes_max = 480ULL << 20;
  std::size_t edit_bytes_max = 512ULL << 20;
  /// Edits that wait for their chunks over this begin a round of snapshots, which loads the chunks.
  std::size_t stack_bytes_max = 64ULL << 20;
  std::size_t unused_bytes_max = 16ULL << 20;
};
/// Bounds of the library of builds (server/world/order/library.hpp).
struct LibraryLimits {
  std::uint64_t builds_max = 100'000;
  std::uint64_t bytes_max = 4ULL << 30;        // of all files together
  std::uint64_t file_bytes_max = 64ULL << 20;  // of one file
  std::uint64_t builds_per_player = 200;
  std::uint64_t bytes_per_player = 256ULL << 20;
};

/// Returns the bounds of a world whose data may take this many bytes.
constexpr MemoryLimits memory_limits_of(std::size_t bytes) {
  return {bytes / 16 * 14, bytes / 16 * 15, bytes, bytes / 8, bytes / 32};
}

}  // namespace runstone
