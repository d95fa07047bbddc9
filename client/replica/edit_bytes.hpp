// edit_bytes(): the memory that an edit takes, as far as an edit determines it.
#pragma once
#include <cstddef>

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Returns the bytes of the descriptor, with its points or its clipboard. A clipboard that several
/// edits share counts for each of them. Cost: O(1).
inline std::size_t edit_bytes(const EditDescriptor& edit) {
  std::size_t bytes = sizeof(EditDescriptor);
  if (const auto* stroke = std::get_if<FillStroke>(&edit.shape))
    bytes += stroke->points.capacity() * sizeof(VoxelPos);
  if (const auto* paste = std::get_if<Paste>(&edit.shape); paste != nullptr && paste->clipboard) {
    bytes += sizeof(Clipboard) + paste->clipboard->cells().runs.byte_capacity() +
             paste->clipboard->palette().capacity() * sizeof(Material);
  }
  return bytes;
}

}  // namespace runstone
