// KnownGround: what the server has said the player may do, and the protected boxes near its view.
// The replica refuses an edit by it before it shows and sends the edit. It decides as the server
// does (decide_ground()) where it has every box that overlaps the edit. Where it lacks a box, it
// may allow an edit that the server rejects, or refuse one that a box of higher rank would admit.
// One thread.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/codec/rights_messages.hpp"

namespace runstone {

class KnownGround {
 public:
  /// Forgets everything, because another session begins: until it says more, every edit is allowed.
  void clear();
  void receive(const Permissions& permissions) { permissions_ = permissions; }
  /// Fails if more than kGroundBoxesMax boxes would be known; then the boxes are unspecified.
  Result<void> receive(const ProtectedGround& change);

  /// Returns why the player may not make the edit, or nullopt. Requires a valid edit. Cost:
  /// O(boxes), and that of decide_ground() for the boxes that overlap the edit.
  std::optional<std::string> refusal(const EditDescriptor& edit) const;

  /// Returns nullopt if the server has sent none.
  const std::optional<Permissions>& permissions() const { return permissions_; }
  /// Returns the boxes by the record that made each.
  const std::map<Sequence, GroundBox>& boxes() const { return boxes_; }

 private:
  std::optional<Permissions> permissions_;
  std::map<Sequence, GroundBox> boxes_;  // at most kGroundBoxesMax
};

}  // namespace runstone
