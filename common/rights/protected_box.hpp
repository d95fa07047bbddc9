// ProtectedBox: ground that only some may change.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/public_key.hpp"

namespace runstone {

inline constexpr std::size_t kBoxMembersMax = 64;
inline constexpr std::size_t kBoxRolesMax = 16;
inline constexpr std::int32_t kBoxPriorityMax = 1000;

/// Of the boxes that hold a voxel, the one with the highest priority decides, and among equal ones
/// the one that was made last. It admits its owner, its members and its roles, and whoever has the
/// right `build_protected`. So a box of higher priority opens or closes a part of a larger one.
/// Whoever a box admits may build there, also without the right `build`, which counts for free
/// ground.
struct ProtectedBox {
  std::string name;                // is_rights_name(); unique in the world
  VoxelBox box;                    // not empty, within the world
  std::int32_t priority = 0;       // -kBoxPriorityMax .. kBoxPriorityMax
  std::optional<PublicKey> owner;  // may change the box and its members
  std::vector<PublicKey> members;  // ascending, each once, at most kBoxMembersMax
  std::vector<std::string> roles;  // ascending, each once, at most kBoxRolesMax
  friend bool operator==(const ProtectedBox&, const ProtectedBox&) = default;
};

/// Returns the number of voxels, or 2^64 - 1 if there are more. Requires that the box lies in the
/// world.
constexpr std::uint64_t volume_of(const VoxelBox& box) {
  if (box.empty()) return 0;
  const auto side = [](std::int32_t min, std::int32_t max) {
    return static_cast<std::uint64_t>(max - min);
  };
  // Two sides have at most 2^60 voxels.
  const std::uint64_t layer = side(box.min.x, box.max.x) * side(box.min.y, box.max.y);
  const std::uint64_t layers = side(box.min.z, box.max.z);
  return layer > UINT64_MAX / layers ? UINT64_MAX : layer * layers;
}

/// A run of columns reaches from the bottom to the top of the world.
constexpr VoxelBox columns(std::int32_t min_x, std::int32_t min_z, std::int32_t max_x,
                           std::int32_t max_z) {
  return {{min_x, -kWorldLimit, min_z}, {max_x, kWorldLimit, max_z}};
}

}  // namespace runstone
