// Copy: what a replica shows inside a box, as a clipboard.
#pragma once
#include <cstdint>
#include <memory>

#include "client/replica/replica.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/edits/clipboard/clipboard.hpp"

namespace runstone {

/// What becomes of empty voxels.
enum class CopyEmpty : std::uint8_t {
  as_empty,      // a paste empties there
  as_untouched,  // a paste leaves what is there
};

/// The shown voxels of a box, own edits without an answer included, run by run. bad_value if the box is empty or
/// would touch nothing, limit_exceeded if a side is longer than 128 or the clipboard too long, not_found where a
/// chunk of the box is not shown. O(runs of the chunks inside + lines of the box * chunks along them).
Result<std::shared_ptr<const Clipboard>> copy_box(const Replica& replica, const VoxelBox& box,
                                                  CopyEmpty empty);

}  // namespace runstone
