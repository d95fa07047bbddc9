// PlacedVoxels: the voxels that a bot has set one by one, so that it can report at the end which
// are intact.
#pragma once
#include <cstdint>
#include <map>

#include "client/replica/replica.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

class PlacedVoxels {
 public:
  /// Takes a submitted local edit. Keeps a single voxel without a mask. Forgets the voxels that any
  /// other edit may have changed.
  void add(const EditDescriptor& edit);
  /// Takes a rejected edit: forgets its voxels, because what they hold now is unknown.
  void forget(const EditDescriptor& edit);

  struct Standing {
    std::uint64_t held = 0;     // voxels kept
    std::uint64_t intact = 0;   // they hold what the bot set last
    std::uint64_t changed = 0;  // they hold something else
    std::uint64_t unseen = 0;   // in chunks that are not loaded
  };
  Standing compare(const Replica& replica) const;

 private:
  std::map<VoxelPos, Material> set_;
};

}  // namespace runstone
