// View cells: the chunks that a view contains, and the difference between two views. A view is a
// disc of columns times an interval of heights, so a difference costs O(columns + result), not
// O(view).
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/view_size.hpp"

namespace runstone {

/// Appends the chunks of `view` that are not in `other`, column by column; all of them if there is
/// no `other`.
void append_difference(const View& view, const std::optional<View>& other, CoordLimit limit,
                       std::vector<ChunkCoord>& out);

}  // namespace runstone
