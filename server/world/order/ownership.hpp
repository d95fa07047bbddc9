// Ownership: whether this server orders the edits of the world, or follows the server that does.
// Thread: the world strand.
#pragma once
#include <cstdint>

#include "protocol/codec/messages.hpp"

namespace runstone {

/// The parts of the protocol that a server does not offer while it follows: they need what only the
/// owner has in memory.
inline constexpr std::uint64_t kFeaturesOfOwner =
    kFeatureKeyTransfer | kFeatureRestorePreview | kFeaturePreviews;

class Ownership {
 public:
  /// Returns true while another server owns the world, and this one follows it.
  bool is_following() const { return is_following_; }
  void follow() { is_following_ = true; }
  void take_over() { is_following_ = false; }
  /// Returns those of the server's features that it offers now.
  std::uint64_t offered(std::uint64_t features) const {
    return is_following_ ? features & ~kFeaturesOfOwner : features;
  }

 private:
  bool is_following_ = false;
};

}  // namespace runstone
