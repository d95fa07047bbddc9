// The head of a PNG: its sides, without the rest of the file.
#pragma once
#include <cstdint>
#include <optional>

#include "common/core/bytes.hpp"

namespace runstone {

struct PngSides {
  std::uint32_t width = 0, height = 0;
  friend bool operator==(const PngSides&, const PngSides&) = default;
};

/// Returns the sides that the head of a PNG names, or nullopt if the bytes are no PNG or a side is
/// 0. Cost: O(1).
std::optional<PngSides> png_sides(ByteView png);

}  // namespace runstone
