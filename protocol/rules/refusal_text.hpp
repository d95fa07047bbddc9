// Refusal text: why a player may not make an edit. The server sends these texts with its rejects,
// and a client shows them when it refuses an edit itself.
#pragma once
#include <cstdint>
#include <string>

namespace runstone {

/// Of an edit of an action of which another edit was refused.
inline constexpr const char* kActionRefused = "an earlier edit of the same action was refused";

inline std::string refused_by_box(const std::string& box) {
  return "the ground is protected: " + box;
}
inline std::string refused_by_role(const std::string& role) {
  return "your role does not allow it: " + role;
}
inline std::string refused_by_volume(std::uint64_t voxels_max) {
  return "edits of your role have at most " + std::to_string(voxels_max) + " voxels";
}

}  // namespace runstone
