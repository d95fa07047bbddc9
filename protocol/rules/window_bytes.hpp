// window_bytes(): the bytes that an edit counts for while it is under way. Client and
// server count alike, so that a client keeps within Welcome::waiting_edit_bytes_max.
#pragma once
#include <cstddef>

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Returns an upper bound of the bytes of the descriptor: 64, those of the clipboard of a paste
/// besides, and 1,600 for a stroke. Cost: O(1).
inline std::size_t window_bytes(const EditDescriptor& edit) {
  if (const auto* paste = std::get_if<Paste>(&edit.shape))
    return 64 + paste->clipboard->byte_size();
  return descriptor_bytes_max(kind_of(edit));
}

}  // namespace runstone
