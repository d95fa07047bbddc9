// RightsState: who may do what, as the records of the log say up to some sequence. It is a pure
// function of these records, so that server, replay and tools agree. Every answer names the record
// that decides it.
// Threads: one writer or several readers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "common/rights/box_index.hpp"
#include "common/rights/rights_change.hpp"

namespace runstone {

/// Where a change stands in the log, and who made it.
struct ChangeOrigin {
  Sequence seq = 0;  // 0: built in, no record
  AuthorId author = 0;
  TimeUs time_us = 0;  // UTC
  friend bool operator==(const ChangeOrigin&, const ChangeOrigin&) = default;
};

/// A part of the state, with the record that made it what it is.
template <class T>
struct Decided {
  T value;
  ChangeOrigin by;
};

/// The answer to "may this player do that?".
struct RightsDecision {
  enum class Reason : std::uint8_t {
    role,         // the rights of the player's role; `by` is the grant or the definition of the role
    default_role, // the same, and the player has no grant
    box,          // a protected box, `box`
    ban,
    mute,
    freeze
  };
  bool is_allowed = false;
  Reason reason{};
  ChangeOrigin by;
  std::string role;                   // of the player
  const ProtectedBox* box = nullptr;  // valid until the next apply()
};

/// Answers whether the edit under check has a voxel in the box. Exact: a bounding box does not do.
using TouchesBox = std::function<bool(const VoxelBox&)>;

class RightsState {
 public:
  RightsState();

  /// Applies a record. Requires the order of the log. Every valid change can be applied, so that a
  /// replay never fails: one that refers to nothing changes nothing.
  void apply(const RightsChange& change, const ChangeOrigin& origin);

  // Roles.
  /// Returns the role of a player: the granted one, or else the default role. A grant of a role that
  /// does not exist counts as no grant. Cost: O(log grants).
  const Role& role_of(const PublicKey& key) const;
  /// Returns null if there is none.
  const Decided<Role>* find_role(const std::string& name) const;
  const Decided<std::string>& default_role() const { return default_role_; }
  const std::map<std::string, Decided<Role>>& roles() const { return roles_; }
  const std::map<PublicKey, Decided<std::string>>& grants() const { return grants_; }
  /// Returns the keys whose role has the right `administer` and who are not banned.
  std::vector<PublicKey> administrators(TimeUs now_us) const;

  // Restrictions.
  /// Returns the restriction of a player that holds at `now_us` (UTC), or null. Cost: O(log
  /// restrictions).
  const Decided<Restrict>* restriction(RestrictionKind kind, const PublicKey& key,
                                       TimeUs now_us) const;
  /// Returns the ban of an address, or null. Cost: O(log bans), once for each length of a prefix.
  const Decided<Restrict>* address_ban(AddressBlock address, TimeUs now_us) const;
  /// Returns all restrictions, also those that have ended.
  std::vector<const Decided<Restrict>*> restrictions() const;

  // Protected ground.
  const Decided<ProtectedBox>* find_box(const std::string& name) const;
  const std::map<std::string, Decided<ProtectedBox>>& boxes() const { return boxes_; }
  /// Returns the boxes that overlap this one: those that decide first come first.
  std::vector<const Decided<ProtectedBox>*> boxes_in(const VoxelBox& box) const;
  /// Returns the box that decides for a voxel, or null. Cost: O(log boxes).
  const Decided<ProtectedBox>* box_at(VoxelPos at) const;
  /// Returns the number of boxes of an owner and their voxels together.
  struct Holding {
    std::size_t boxes = 0;
    std::uint64_t volume = 0;  // at most 2^64 - 1
  };
  Holding holding_of(const PublicKey& owner) const;

  // Decisions.
  /// Decides whether the player has the right, without regard to a place. Mute and freeze count for
  /// `chat`, and for `build`, `build_protected` and `undo`; a ban of the key counts for everything.
  RightsDecision decide(const PublicKey& key, Right right, TimeUs now_us) const;
  /// Decides whether the player may make an edit. The rule: an edit is rejected as a whole if the
  /// player may not change a single one of its voxels, mask ignored. `bounds` is its bounding box.
  /// Cost: O(log boxes) for an edit that meets no box; at worst, for an edit that meets m boxes,
  /// O(m^2) calls of `touches`, with at most kEditBoxPartsMax parts: an edit that would need more is
  /// rejected.
  RightsDecision decide_edit(const PublicKey& key, const VoxelBox& bounds,
                             const TouchesBox& touches, TimeUs now_us) const;

 private:
  std::map<std::string, Decided<Role>> roles_;
  Decided<std::string> default_role_;
  std::map<PublicKey, Decided<std::string>> grants_;
  std::map<std::string, Decided<ProtectedBox>> boxes_;
  // Further data is the implementer's choice.
};

inline constexpr std::size_t kEditBoxPartsMax = 4096;

}  // namespace runstone
