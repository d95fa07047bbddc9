// View cells: which chunks a view holds, and what changes when it moves. A view is a disc of columns times an
// interval of heights, so a difference costs O(columns + result) and not O(view).
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Chunk coordinates of a world are in [-limit, limit); a view may look past the rim, its chunks end there.
struct CoordLimit {
  std::int32_t limit = kWorldLimit;
  bool contains(ChunkCoord c) const {
    return c.x >= -limit && c.x < limit && c.y >= -limit && c.y < limit && c.z >= -limit &&
           c.z < limit;
  }
};

/// Squared distance from the view's centre, in chunks: the order in which a builder wants to see them.
std::int64_t distance2(const View& view, ChunkCoord at);

/// Appends the chunks of `view` that are not in `other` (all of them without one), column by column.
void append_difference(const View& view, const std::optional<View>& other, CoordLimit limit,
                       std::vector<ChunkCoord>& out);

}  // namespace runstone
