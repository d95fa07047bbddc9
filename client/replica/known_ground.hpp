// KnownGround: the rights of the player and the protected boxes near the view, as the server has
// sent them. Before the replica shows and sends an edit, it checks the edit here.
//   - If every box that overlaps the edit is known, the decision is that of the server
//     (decide_ground()).
//   - If a box is not known, an edit may be allowed that the server rejects, or an edit may be
//     refused that a box of higher rank would admit.
// One thread.
#pragma once
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/codec/rights_messages.hpp"

namespace runstone {

class KnownGround {
 public:
  /// Forgets everything, because another session begins. Until its messages arrive, every edit is
  /// allowed.
  void clear();
  void receive(const Permissions& permissions) { permissions_ = permissions; }
  /// Fails if more than kGroundBoxesMax boxes would be known; then the boxes are unspecified.
  Result<void> receive(const ProtectedGround& change);

  /// Returns why the player may not make the edit, or nullopt. Requires a valid edit. Cost:
  /// O(boxes), and that of decide_ground() for the boxes that overlap the edit.
  std::optional<std::string> refusal(const EditDescriptor& edit) const;

  /// Returns the bound of the voxels of an edit that the player's role has, or the largest number.
  std::uint64_t edit_volume_max() const {
    return permissions_ && permissions_->edit_volume_max != 0
               ? permissions_->edit_volume_max
               : std::numeric_limits<std::uint64_t>::max();
  }
  /// Returns nullopt if the server has sent none.
  const std::optional<Permissions>& permissions() const { return permissions_; }
  /// Returns the boxes by the record that made each.
  const std::map<Sequence, GroundBox>& boxes() const { return boxes_; }

 private:
  std::optional<Permissions> permissions_;
  std::map<Sequence, GroundBox> boxes_;  // at most kGroundBoxesMax
};

}  // namespace runstone
