// copy_box(): copies the voxels that a replica shows inside a box to a clipboard.
#pragma once
#include <cstdint>
#include <memory>

#include "client/replica/replica.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/edits/clipboard/clipboard.hpp"

namespace runstone {

/// How empty voxels are copied.
enum class CopyEmpty : std::uint8_t {
  as_empty,      // a paste empties these voxels
  as_untouched,  // a paste leaves these voxels as they are
};

/// Returns the shown voxels of a box, predicted edits included. Copies run by run. Fails with
///   - bad_value if the box is empty, or if the paste would touch nothing;
///   - limit_exceeded if a side is longer than 128 voxels, or if the clipboard is too long;
///   - not_found if a chunk of the box is not shown.
/// Cost: O(runs of the chunks inside + lines of the box * chunks along them).
Result<std::shared_ptr<const Clipboard>> copy_box(const Replica& replica, const VoxelBox& box,
                                                  CopyEmpty empty);

}  // namespace runstone
