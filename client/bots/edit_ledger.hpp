// EditLedger: what a bot has set voxel by voxel, so that it can say at the end what of it still stands.
#pragma once
#include <cstdint>
#include <map>

#include "client/replica/replica.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

class EditLedger {
 public:
  /// An own edit was handed in: a single voxel without a mask is kept; what any other one may have written over
  /// is forgotten.
  void add(const EditDescriptor& edit);
  /// It was refused: what stands there now is nobody's word.
  void forget(const EditDescriptor& edit);

  struct Standing {
    std::uint64_t held = 0;     // voxels kept
    std::uint64_t intact = 0;   // hold what the bot set last
    std::uint64_t changed = 0;  // hold something else
    std::uint64_t unseen = 0;   // in chunks that are not here
  };
  Standing compare(const Replica& replica) const;

 private:
  std::map<VoxelPos, Material> set_;
};

}  // namespace runstone
