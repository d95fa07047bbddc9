// View cells: the chunks that a view contains, and the difference between two views. A view is a
// disc of columns times an interval of heights, so a difference costs O(columns + result), not
// O(view).
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Chunk coordinates of a world are in [-limit, limit). A view may extend beyond; it has no chunks
/// there.
struct CoordLimit {
  std::int32_t limit = kWorldLimit;
  bool contains(ChunkCoord c) const {
    return c.x >= -limit && c.x < limit && c.y >= -limit && c.y < limit && c.z >= -limit &&
           c.z < limit;
  }
};

/// Returns the squared distance from the view's centre, in chunks.
std::int64_t distance2(const View& view, ChunkCoord at);

/// Appends the chunks of `view` that are not in `other`, column by column; all of them if there is
/// no `other`.
void append_difference(const View& view, const std::optional<View>& other, CoordLimit limit,
                       std::vector<ChunkCoord>& out);

}  // namespace runstone
