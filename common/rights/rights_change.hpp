// RightsChange: a record of the edit log that changes who may do what. The log orders it among the
// edits: it has author, time and sequence like them. docs/edit-log.md gives its bytes. The meaning
// of a kind is frozen; a change is a new kind.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/public_key.hpp"
#include "common/core/result.hpp"
#include "common/rights/address_range.hpp"
#include "common/rights/invite.hpp"
#include "common/rights/join_password.hpp"
#include "common/rights/protected_box.hpp"
#include "common/rights/role.hpp"

namespace runstone {

/// Defines a role, or defines it anew.
struct DefineRole {
  Role role;
  friend bool operator==(const DefineRole&, const DefineRole&) = default;
};
/// Removes a role that the world has defined. A built-in one is as it was built in again.
struct RemoveRole {
  std::string role;
  friend bool operator==(const RemoveRole&, const RemoveRole&) = default;
};
/// Gives a player a role. With an end, the role counts until then, in place of the one that the player
/// has without it, which counts again afterwards. A grant without an end replaces both.
struct GrantRole {
  PublicKey key{};
  std::string role;     // empty: the default role of the world; only without an end
  TimeUs until_us = 0;  // UTC; 0: without an end
  friend bool operator==(const GrantRole&, const GrantRole&) = default;
};
/// Sets the role of players without a grant.
struct SetDefaultRole {
  std::string role;
  friend bool operator==(const SetDefaultRole&, const SetDefaultRole&) = default;
};

/// The values are stored.
enum class RestrictionKind : std::uint8_t {
  ban = 0,    // may not join
  mute = 1,   // may not write to others
  freeze = 2  // may not edit
};
inline constexpr std::size_t kReasonBytesMax = 200;
/// Whom a restriction is for. Only bans are for addresses.
using RestrictionSubject = std::variant<PublicKey, AddressRange>;
/// Restricts a player, or everybody who comes from a range of addresses.
struct Restrict {
  RestrictionKind kind{};
  RestrictionSubject subject;
  TimeUs until_us = 0;  // UTC; 0: until it is lifted
  std::string reason;   // printable UTF-8, at most kReasonBytesMax bytes; may be empty
  friend bool operator==(const Restrict&, const Restrict&) = default;
};
/// Lifts a restriction.
struct Lift {
  RestrictionKind kind{};
  RestrictionSubject subject;
  friend bool operator==(const Lift&, const Lift&) = default;
};

/// Protects a box, or changes the box of this name.
struct Protect {
  ProtectedBox box;
  friend bool operator==(const Protect&, const Protect&) = default;
};
struct Unprotect {
  std::string box;
  friend bool operator==(const Unprotect&, const Unprotect&) = default;
};

/// Makes an invite.
struct CreateInvite {
  Invite invite;
  friend bool operator==(const CreateInvite&, const CreateInvite&) = default;
};
/// Gives a player without a granted role the role of an invite that has uses left.
struct AcceptInvite {
  InviteId invite = 0;
  PublicKey key{};
  friend bool operator==(const AcceptInvite&, const AcceptInvite&) = default;
};
/// Ends an invite. The players who accepted it keep their role.
struct CancelInvite {
  InviteId invite = 0;
  friend bool operator==(const CancelInvite&, const CancelInvite&) = default;
};

/// Sets the password of the world, in place of the one before.
struct SetPassword {
  std::optional<JoinPassword> password;  // nullopt: the world has no password from now on
  friend bool operator==(const SetPassword&, const SetPassword&) = default;
};
/// Gives a player without a granted role the role of the password.
struct AcceptPassword {
  PublicKey key{};
  friend bool operator==(const AcceptPassword&, const AcceptPassword&) = default;
};

/// Corrects the time of the log: it steps to the time of this record, which may be earlier than that of
/// the record before it. The ends of restrictions and invites that the wrong clock gave step with it, so
/// that these keep the time that they had left (RightsState).
struct CorrectTime {
  TimeUs step_us = 0;  // by which the time of the log steps: not 0; below 0 it steps back
  Sequence since = 1;  // the first record of the wrong clock, as far as the server knows; from 1
  friend bool operator==(const CorrectTime&, const CorrectTime&) = default;
};

// The order is that of the stored tags, from 1. A DefineRole with quotas is stored with a tag of
// its own, which comes before that of CorrectTime, and a GrantRole with an end with one behind it.
using RightsChange = std::variant<DefineRole, RemoveRole, GrantRole, SetDefaultRole, Restrict, Lift,
                                  Protect, Unprotect, CreateInvite, AcceptInvite, CancelInvite,
                                  SetPassword, AcceptPassword, CorrectTime>;

inline constexpr std::size_t kRightsChangeBytesMax = 4096;

/// Fails with the first field outside its range. Cost: O(members).
Result<void> validate(const RightsChange& change);

/// Appends the canonical bytes, at most kRightsChangeBytesMax. Requires a valid change.
void encode(const RightsChange& change, Bytes& out);

/// Reads one change, up to the end of the input. The result is valid if the reader is ok.
RightsChange read_rights_change(ByteReader& in);

/// Returns true for a grant with an end, which programs of world format 11 and earlier cannot read.
bool is_timed_grant(const RightsChange& change);

/// Returns the ground that the change is about; nullopt for a change that has no place, which
/// includes Unprotect.
std::optional<VoxelBox> place_of(const RightsChange& change);

}  // namespace runstone
