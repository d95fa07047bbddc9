// The sizes of chunk bytes. Messages, rows of databases and queues take their limits from them.
#pragma once
#include <cstddef>

#include "common/runs/extent.hpp"

namespace runstone {

/// The bytes of a raw chunk before its runs. The head of the other encodings is not longer.
inline constexpr std::size_t kChunkHeaderBytes = 12;
/// The bytes of the largest raw chunk: one of 128³ voxels in which no two neighbours are equal.
inline constexpr std::size_t kChunkBytesMax = kChunkHeaderBytes + 6ULL * kVolumeMax;

}  // namespace runstone
