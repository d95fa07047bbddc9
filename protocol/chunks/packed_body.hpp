// PackedBody: the planes of the chunk encoding `packed` and the zstd frame around them. Internal to
// the chunk codec. Scratch and zstd contexts live per thread: after the first chunks, packing and
// unpacking allocate only the runs that they make.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

inline constexpr std::size_t kNarrowPaletteMax = 256;  // above, an index takes two bytes

/// Views of this thread's scratch. They live until the next pack() or unpack() of the thread.
struct PackedBody {
  std::span<const Material> palette;  // ascending
  ByteView body;        // palette indices, tokens of lengths by material, long lengths
  ByteView compressed;  // one zstd frame without its magic number; empty if it is not smaller
};

/// Packs runs. Requires canonical runs and the side of the fastest axis, 8 .. 128. Cost: O(runs +
/// largest id / 64).
PackedBody pack(const RunList& runs, std::uint32_t side);

/// The numbers in the head of a packed chunk.
struct PackedShape {
  std::size_t runs = 0;
  std::size_t materials = 0;  // in the palette
  std::uint32_t side = 0;     // side of the fastest axis
  std::uint32_t volume = 0;
  bool has_wide_indices() const { return materials > kNarrowPaletteMax; }
  /// Returns true if this number of runs can have a body of `body_bytes` before compression. Each
  /// run has an index, each but the last a token, and the volume bounds the number of long lengths.
  bool plausible(std::uint64_t body_bytes) const;
};

/// Unpacks the runs of a body. Guarantees that the ends ascend inside the volume and that every
/// material of the palette occurs; validate() checks the rest. The offset of broken_invariant is a
/// run, that of other errors a byte of the body. Requires an ascending palette of at most `runs`
/// ids, and 1 .. `volume` runs. Cost: O(runs).
Result<RunList> unpack(ByteView body, bool zstd, const PackedShape& shape,
                       std::span<const Material> palette);

}  // namespace runstone
