// The body of packed chunks of version 1, which worlds of format 3 and before hold: a plane of palette indices, a plane
// of lengths as varints, perhaps in a zstd frame. Nothing writes it any more. docs/edit-log.md has the bytes.
// Internal to the chunk codec.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

/// What the head announces.
struct PackedShapeV1 {
  std::size_t runs = 0;
  std::size_t body_bytes = 0;  // without zstd
  /// Whether so many runs can fill so many bytes: each has an index, and each but the last a length of one to
  /// three bytes (lengths stay below 2^21).
  bool plausible(std::size_t palette) const {
    const std::size_t indices = runs * (palette > 256 ? 2 : 1);
    return runs >= 1 && body_bytes >= indices + (runs - 1) &&
           body_bytes <= indices + 3 * (runs - 1);
  }
};

/// As unpack() of packed_body.hpp. Requires a plausible shape, too.
Result<RunList> unpack_v1(ByteView body, bool zstd, const PackedShapeV1& shape,
                          std::span<const Material> palette, std::uint32_t volume);

}  // namespace runstone
