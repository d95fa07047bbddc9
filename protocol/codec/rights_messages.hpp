// Rights messages: what a player may do, and the protected ground near its view. Clients use them
// to refuse edits that the server would reject.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/budget.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// What a player may do where no protected box decides. A later message replaces it.
struct Permissions {
  std::string role;  // 1 .. kGroundNameBytesMax bytes
  std::uint32_t rights =
      0;  // in force; bit n is the right with the value n; unknown bits are valid
  std::uint64_t edit_volume_max = 0;  // voxels of one edit of the role; 0: no limit of its own
  /// Why the player may not edit anything, for the player; empty if the player may.
  std::string edits_refused;
  Budget edit_budget{};  // replaces that of Welcome
  friend bool operator==(const Permissions&, const Permissions&) = default;
};

/// A protected box, as it matters to the player who receives it.
struct GroundBox {
  Sequence seq = 0;           // of the record that made the box; identifies it; at least 1
  VoxelBox box;               // not empty, within the world
  std::int32_t priority = 0;  // -kGroundPriorityMax .. kGroundPriorityMax
  bool admits = false;        // the player may edit in the box
  std::string name;           // 1 .. kGroundNameBytesMax bytes
  std::string owner;  // a player's name or a key's fingerprint; at most kPlayerNameBytesMax bytes
  friend bool operator==(const GroundBox&, const GroundBox&) = default;
};

/// Changes of the boxes that a client knows. The removals come first. At least one of the lists is
/// not empty.
struct ProtectedGround {
  std::vector<Sequence> removed;  // at most kGroundBoxesMax, strictly ascending
  std::vector<GroundBox> boxes;   // at most kGroundBoxesMax, strictly ascending by seq
  friend bool operator==(const ProtectedGround&, const ProtectedGround&) = default;
};

}  // namespace runstone
