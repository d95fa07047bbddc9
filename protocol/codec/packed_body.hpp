// PackedBody: the planes of the `packed` chunk encoding and the zstd around them. Internal to the chunk
// codec. Scratch and zstd contexts live per thread, so packing and unpacking allocate nothing in a steady
// state but the runs they make.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

inline constexpr std::size_t kNarrowPaletteMax = 256;  // beyond, an index takes two bytes

/// Views of this thread's scratch: they live until the next pack() or unpack() of the thread.
struct PackedBody {
  std::span<const Material> palette;  // ascending
  ByteView body;        // palette indices, tokens of lengths by material, long lengths
  ByteView compressed;  // one zstd frame without its magic; empty where that would not be smaller
};

/// Requires canonical runs and the side of the fastest axis, 8 .. 128. O(runs + largest id / 64).
PackedBody pack(const RunList& runs, std::uint32_t side);

/// What the head of a packed chunk announces.
struct PackedShape {
  std::size_t runs = 0;
  std::size_t materials = 0;  // in the palette
  std::uint32_t side = 0;     // side of the fastest axis
  std::uint32_t volume = 0;
  bool has_wide_indices() const { return materials > kNarrowPaletteMax; }
  /// Whether so many runs can fill so many bytes before compression: each has an index, each but the last a
  /// token, and long lengths are few.
  bool plausible(std::uint64_t body_bytes) const;
};

/// Runs of a body. Requires an ascending palette of at most `runs` ids, and at least one run, at most `volume`.
/// The ends ascend inside the volume and the palette is used up; the rest is for validate(). broken_invariant
/// names a run, the other errors a byte of the body. O(runs).
Result<RunList> unpack(ByteView body, bool zstd, const PackedShape& shape,
                       std::span<const Material> palette);

}  // namespace runstone
