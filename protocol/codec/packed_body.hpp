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

/// Views of this thread's scratch: they live until the next pack() or unpack() of the thread.
struct PackedBody {
  std::span<const Material> palette;  // ascending
  ByteView body;                      // plane of palette indices, then plane of run lengths
  ByteView compressed;                // one zstd frame; empty where that would not be smaller
};

/// Requires at least one run. O(runs + largest id / 64).
PackedBody pack(const RunList& runs);

/// What the head of a packed chunk announces.
struct PackedShape {
  std::size_t runs = 0;
  std::size_t body_bytes = 0;  // without zstd
  /// Whether so many runs can fill so many bytes: each has an index, and each but the last a length of one to
  /// three bytes (lengths stay below 2^21).
  bool plausible(std::size_t palette) const {
    const std::size_t indices = runs * (palette > 256 ? 2 : 1);
    return runs >= 1 && body_bytes >= indices + (runs - 1) && body_bytes <= indices + 3 * (runs - 1);
  }
};

/// Runs of a body. Requires a plausible shape, an ascending palette of at most `shape.runs` ids and
/// runs <= volume. The ends are inside the volume and the palette is used up; the rest is for validate().
/// broken_invariant names a run, the other errors a byte of the body. O(runs).
Result<RunList> unpack(ByteView body, bool zstd, const PackedShape& shape, std::span<const Material> palette,
                       std::uint32_t volume);

}  // namespace runstone
