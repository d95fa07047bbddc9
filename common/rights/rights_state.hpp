// RightsState: who may do what, as the records of the log say up to some sequence. It is a pure
// function of these records, so that server, replay and tools agree. Every answer names the record
// that decides it.
// Threads: one writer or several readers.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "common/rights/box_index.hpp"
#include "common/rights/ground_decision.hpp"
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
    role,  // the player's role: `by` is the newer one of its grant and its definition
    // The default role, of a player without a grant: `by` is the newer one of its choice and its
    // definition.
    default_role,
    box,  // a protected box, `box`, admits the player or does not
    ban,
    mute,
    freeze
  };
  bool is_allowed = false;
  Reason reason = Reason::default_role;
  ChangeOrigin by;
  std::string role;                   // of the player
  const ProtectedBox* box = nullptr;  // valid until the next apply()
};

/// An invite that was not cancelled, and the number of players who accepted it.
struct OpenInvite {
  Invite invite;
  std::uint32_t accepted = 0;
  friend bool operator==(const OpenInvite&, const OpenInvite&) = default;
};

/// Returns true if the box admits the player, who has this role.
bool admits(const ProtectedBox& box, const PublicKey& key, const Role& role);

class RightsState {
 public:
  RightsState();
  // The index holds the addresses of boxes. A move keeps these addresses; a copy would not.
  RightsState(RightsState&&) = default;
  RightsState& operator=(RightsState&&) = default;
  RightsState(const RightsState&) = delete;
  RightsState& operator=(const RightsState&) = delete;

  /// Applies a record. Requires the order of the log. Every valid change can be applied, so that a
  /// replay never fails: one that refers to nothing changes nothing. Cost: O(log n) on average over
  /// many records for a role, a grant or a restriction, and that of BoxIndex for a box.
  void apply(const RightsChange& change, const ChangeOrigin& origin);

  /// Sets the time (UTC) at which role_of() answers. apply() sets it to that of the record.
  void set_time(TimeUs now_us) { time_us_ = now_us; }

  // Roles.
  /// Returns the role of a player: the granted role, otherwise the default role. A grant with an
  /// end that is in force counts before a grant without an end. A grant of a role that does not
  /// exist is ignored. If the default role does not exist, it is the role visitor. Cost: O(log
  /// grants).
  const Role& role_of(const PublicKey& key) const { return role_of(key, time_us_); }
  const Role& role_of(const PublicKey& key, TimeUs now_us) const;
  /// Returns null if there is none. The built-in roles always exist.
  const Decided<Role>* find_role(const std::string& name) const;
  const Decided<std::string>& default_role() const { return default_role_; }
  const std::map<std::string, Decided<Role>>& roles() const { return roles_; }
  /// Returns the grants without an end.
  const std::map<PublicKey, Decided<std::string>>& grants() const { return grants_; }
  /// Returns the newest grant with an end of each player, also if it has ended. A grant that has
  /// ended is removed when a later grant with an end is made.
  const std::map<PublicKey, Decided<GrantRole>>& timed_grants() const { return timed_grants_; }
  /// Returns true if a record has given a role for some time.
  bool has_timed_grants_ever() const { return has_timed_grants_ever_; }
  /// Returns the grant with an end that gives the player a role at `now_us` (UTC), or null.
  const Decided<GrantRole>* timed_grant(const PublicKey& key, TimeUs now_us) const;
  /// Returns the grants that ended after `since_us`, up to `now_us` (UTC). Cost: O(timed grants).
  std::vector<GrantRole> grants_ended(TimeUs since_us, TimeUs now_us) const;
  /// Returns the keys with a grant without an end whose role has the right `administer` and who are
  /// not banned. Cost: O(grants log n).
  std::vector<PublicKey> administrators(TimeUs now_us) const;

  /// Returns true if a role was ever granted or an invite ever made, even if it was taken back.
  bool has_ever_granted() const { return has_ever_granted_; }

  // Invites.
  /// Returns the invites that were neither cancelled nor removed: an invite that has ended is
  /// removed when a later one is made.
  const std::map<InviteId, Decided<OpenInvite>>& invites() const { return invites_; }
  /// Returns the invite if a player may accept it at `now_us` (UTC), or null.
  const Decided<OpenInvite>* usable_invite(InviteId id, TimeUs now_us) const;

  // The password.
  /// Returns the password with which players join, or nullopt, and the record that decided it.
  const Decided<std::optional<JoinPassword>>& password() const { return password_; }

  // Restrictions.
  /// Returns the restriction of a player that holds at `now_us` (UTC), or null. Cost: O(log
  /// restrictions).
  const Decided<Restrict>* restriction(RestrictionKind kind, const PublicKey& key,
                                       TimeUs now_us) const;
  /// Returns the ban of an address, or null. Of several, the one with the longest prefix is
  /// returned. Cost: O(log bans), once for each length of a prefix that a ban has.
  const Decided<Restrict>* address_ban(AddressBlock address, TimeUs now_us) const;
  /// Returns the restriction of a subject, also one that has ended, or null. Cost: O(log
  /// restrictions).
  const Decided<Restrict>* find_restriction(RestrictionKind kind,
                                            const RestrictionSubject& subject) const;
  /// Returns all restrictions, also those that have ended: those of players come first.
  std::vector<const Decided<Restrict>*> restrictions() const;
  std::size_t restriction_count() const { return by_key_.size() + address_bans_.size(); }

  // Corrections of the time.
  /// Returns true if the records have a correction of the time.
  bool is_time_corrected() const { return is_time_corrected_; }
  /// Returns true if a record from `since` on has given an end after `now_us` (UTC) to a
  /// restriction, an invite or a grant. Cost: O(log n) for each restriction, invite and grant with
  /// an end.
  bool has_ends_given_since(Sequence since, TimeUs now_us) const;

  // Protected ground.
  const Decided<ProtectedBox>* find_box(const std::string& name) const;
  const std::map<std::string, Decided<ProtectedBox>>& boxes() const { return boxes_; }
  /// Returns the boxes that overlap this one: those that decide first come first.
  std::vector<const Decided<ProtectedBox>*> boxes_in(const VoxelBox& box) const;
  /// Returns `count_max` of the boxes that overlap this one, or all of them if there are not more,
  /// in no special order. Requires that `box` is not empty. Cost: O(log^2 boxes + count_max), if
  /// few boxes overlap one another.
  std::vector<const Decided<ProtectedBox>*> some_boxes_in(const VoxelBox& box,
                                                          std::size_t count_max) const;
  /// Returns the box that decides for a voxel, or null. Cost: O(log boxes).
  const Decided<ProtectedBox>* box_at(VoxelPos at) const;
  /// Returns the boxes of an owner, in no special order. Cost: O(log boxes + boxes of the owner).
  std::vector<const Decided<ProtectedBox>*> boxes_of(const PublicKey& owner) const;
  struct Holding {
    std::size_t boxes = 0;
    std::uint64_t volume = 0;  // voxels of all of them together, at most 2^64 - 1
  };
  /// Returns what an owner has, without the box `except` if it is not null. Cost: O(log boxes +
  /// boxes of the owner).
  Holding holding_of(const PublicKey& owner, const ProtectedBox* except = nullptr) const;

  // Decisions.
  /// Decides whether the player has the right, without regard to a place. Mute and freeze count for
  /// `chat`, and for `build`, `build_protected` and `undo`; a ban of the key counts for everything.
  RightsDecision decide(const PublicKey& key, Right right, TimeUs now_us) const;
  /// Returns the rights of the player's role without those that a restriction takes away: the ones
  /// that decide() allows.
  RightSet rights_in_force(const PublicKey& key, TimeUs now_us) const;
  /// Decides whether the player may make an edit: decide_ground() with the boxes that overlap
  /// `bounds`, its bounding box. The mask of the edit is ignored. Free ground, which no box
  /// protects, needs the right `build`. Requires that the edit has a voxel in `bounds`. `touches`
  /// is called with boxes in `bounds` that are not empty. Cost: O(log boxes) for an edit that meets
  /// no box. For one that meets m boxes: O(m log m), and that of decide_ground().
  RightsDecision decide_edit(const PublicKey& key, const VoxelBox& bounds,
                             const TouchesBox& touches, TimeUs now_us) const;

 private:
  /// The granted role of a player, or null, and the record that gave it.
  struct Granted {
    const Role* role = nullptr;
    ChangeOrigin by;
  };
  Granted granted_at(const PublicKey& key, TimeUs now_us) const;
  RightsDecision decide_by_role(const PublicKey& key, Right right, TimeUs now_us) const;
  /// Returns the answer if a restriction of the player forbids the right.
  std::optional<RightsDecision> forbidden(const PublicKey& key, Right right, TimeUs now_us) const;

  void apply_kind(const DefineRole& change, const ChangeOrigin& origin);
  void apply_kind(const RemoveRole& change, const ChangeOrigin& origin);
  void apply_kind(const GrantRole& change, const ChangeOrigin& origin);
  void apply_kind(const SetDefaultRole& change, const ChangeOrigin& origin);
  void apply_kind(const Restrict& change, const ChangeOrigin& origin);
  void apply_kind(const Lift& change, const ChangeOrigin& origin);
  void apply_kind(const Protect& change, const ChangeOrigin& origin);
  void apply_kind(const Unprotect& change, const ChangeOrigin& origin);
  void apply_kind(const CreateInvite& change, const ChangeOrigin& origin);
  void apply_kind(const AcceptInvite& change, const ChangeOrigin& origin);
  void apply_kind(const CancelInvite& change, const ChangeOrigin& origin);
  void apply_kind(const SetPassword& change, const ChangeOrigin& origin);
  void apply_kind(const AcceptPassword& change, const ChangeOrigin& origin);
  void apply_kind(const CorrectTime& change, const ChangeOrigin& origin);
  /// Returns the record that has given an end its present value: the one of the restriction or invite,
  /// or the correction of the time that has moved the end last.
  const ChangeOrigin& giver_of_end(const ChangeOrigin& by) const;
  void remove_box(const std::string& name);

  std::map<std::string, Decided<Role>> roles_;
  Decided<std::string> default_role_;
  std::map<PublicKey, Decided<std::string>> grants_;
  std::map<PublicKey, Decided<GrantRole>> timed_grants_;
  bool has_timed_grants_ever_ = false;
  TimeUs time_us_ = 0;  // UTC
  bool has_ever_granted_ = false;
  std::map<InviteId, Decided<OpenInvite>> invites_;
  Decided<std::optional<JoinPassword>> password_;

  std::map<std::pair<PublicKey, RestrictionKind>, Decided<Restrict>> by_key_;
  std::map<AddressRange, Decided<Restrict>> address_bans_;
  std::array<std::uint32_t, 65> bans_of_length_{};  // by the bits of the prefix

  bool is_time_corrected_ = false;
  // The correction that has moved an end last, by the sequence of the record of the restriction or
  // invite.
  std::map<Sequence, ChangeOrigin> moved_ends_;

  std::map<std::string, Decided<ProtectedBox>> boxes_;
  BoxIndex index_;
  std::vector<const Decided<ProtectedBox>*> indexed_;  // by id; null: the id is in free_ids_
  std::vector<BoxIndex::Id> free_ids_;
  std::map<std::string, BoxIndex::Id> id_of_;
  std::set<std::pair<PublicKey, BoxIndex::Id>> owned_;
};

}  // namespace runstone
