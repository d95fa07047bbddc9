// The body of packed chunks of version 1: a plane of palette indices and a plane of lengths as
// varints, plain or in a zstd frame. Worlds of formats 1 to 3 contain it; nothing writes it.
// docs/edit-log.md specifies the bytes. Internal to the chunk codec.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

/// The numbers in the head.
struct PackedShapeV1 {
  std::size_t runs = 0;
  std::size_t body_bytes = 0;  // before compression
  /// Returns true if this number of runs can fill the body. Each run has an index, and each but the
  /// last a length of one to three bytes, because lengths are below 2^21.
  bool plausible(std::size_t palette) const {
    const std::size_t indices = runs * (palette > 256 ? 2 : 1);
    return runs >= 1 && body_bytes >= indices + (runs - 1) &&
           body_bytes <= indices + 3 * (runs - 1);
  }
};

/// Like unpack() in packed_body.hpp. Also requires a plausible shape.
Result<RunList> unpack_v1(ByteView body, bool zstd, const PackedShapeV1& shape,
                          std::span<const Material> palette, std::uint32_t volume);

}  // namespace runstone
