// ShownEdit: what veiled sessions are sent of an ordered edit.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/veil/veil_patch.hpp"

namespace runstone {

/// A change of a shown chunk that no descriptor carries.
struct ShownPatch {
  ChunkKey key;
  /// The versions of the shown chunk before and after the patch. They are equal if the patch follows
  /// the descriptor of the same edit, or a record that is the newest of the log.
  Version before, after;
  VeilPatch patch;  // in the order kVeilOrder, not empty
};

enum class ShownForm : std::uint8_t {
  hidden,      // the edit changes no shown voxel: nothing is sent but a receipt to its client
  descriptor,  // sessions apply the descriptor, then the patches
  result,      // sessions apply the patches alone
};

struct ShownEdit {
  ShownForm form = ShownForm::hidden;
  /// Of a descriptor: of each touched chunk, the sequence of the shown chunk before the edit, or of
  /// the true chunk where none is shown. In touched_chunks() order.
  std::vector<Sequence> previous;
  std::vector<ShownPatch> patches;  // ascending by key, one for a chunk
};

}  // namespace runstone
