// RightsCommand: a command about roles, grants, restrictions or protected ground, as a value.
// Players are not looked up: a `player` is the word that was typed (KnownPlayers finds it).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/rights/address_range.hpp"
#include "common/rights/right.hpp"
#include "common/rights/rights_change.hpp"
#include "common/rights/role.hpp"
#include "server/admin/command_reader.hpp"

namespace runstone {

struct ListRolesCommand {
  friend bool operator==(const ListRolesCommand&, const ListRolesCommand&) = default;
};
struct SetRoleCommand {
  Role role;
  friend bool operator==(const SetRoleCommand&, const SetRoleCommand&) = default;
};
struct RemoveRoleCommand {
  std::string role;
  friend bool operator==(const RemoveRoleCommand&, const RemoveRoleCommand&) = default;
};
struct DefaultRoleCommand {
  std::string role;
  friend bool operator==(const DefaultRoleCommand&, const DefaultRoleCommand&) = default;
};
struct GrantCommand {
  std::string player;
  std::string role;
  friend bool operator==(const GrantCommand&, const GrantCommand&) = default;
};
struct RevokeCommand {
  std::string player;
  friend bool operator==(const RevokeCommand&, const RevokeCommand&) = default;
};
struct ListGrantsCommand {
  friend bool operator==(const ListGrantsCommand&, const ListGrantsCommand&) = default;
};

struct CreateInviteCommand {
  std::string role = kBuilderRole;
  std::uint32_t uses = 1;
  TimeUs until_us = 0;  // UTC
  friend bool operator==(const CreateInviteCommand&, const CreateInviteCommand&) = default;
};
struct CancelInviteCommand {
  InviteId invite = 0;
  friend bool operator==(const CancelInviteCommand&, const CancelInviteCommand&) = default;
};
struct ListInvitesCommand {
  friend bool operator==(const ListInvitesCommand&, const ListInvitesCommand&) = default;
};

struct SetPasswordCommand {
  JoinPassword password;
  bool has_verifier = false;  // false: salt and hash are missing; the control program adds them
  friend bool operator==(const SetPasswordCommand&, const SetPasswordCommand&) = default;
};
struct ClearPasswordCommand {
  friend bool operator==(const ClearPasswordCommand&, const ClearPasswordCommand&) = default;
};
struct ShowPasswordCommand {
  friend bool operator==(const ShowPasswordCommand&, const ShowPasswordCommand&) = default;
};

struct ListRefusalsCommand {
  friend bool operator==(const ListRefusalsCommand&, const ListRefusalsCommand&) = default;
};

/// Whom a restriction is for: a player, or a range of addresses.
struct RestrictionWord {
  std::string player;                 // empty: a range
  std::optional<AddressRange> range;  // nullopt: a player
  bool is_widened = false;            // a single IPv6 address was typed, which means its /64
  friend bool operator==(const RestrictionWord&, const RestrictionWord&) = default;
};
struct RestrictCommand {
  RestrictionKind kind{};
  RestrictionWord who;
  TimeUs until_us = 0;  // UTC; 0: until it is lifted
  std::string reason;   // may be empty
  friend bool operator==(const RestrictCommand&, const RestrictCommand&) = default;
};
struct LiftCommand {
  RestrictionKind kind{};
  RestrictionWord who;
  friend bool operator==(const LiftCommand&, const LiftCommand&) = default;
};
struct ListRestrictionsCommand {
  friend bool operator==(const ListRestrictionsCommand&, const ListRestrictionsCommand&) = default;
};
struct KickCommand {
  std::string player;
  std::string reason;  // may be empty
  friend bool operator==(const KickCommand&, const KickCommand&) = default;
};

/// Protects a box, or changes the box of this name. What is not set stays as it is.
struct ProtectCommand {
  std::string name;
  std::optional<VoxelBox> box;  // nullopt: the box exists
  std::optional<std::string> owner;
  std::optional<std::int32_t> priority;
  friend bool operator==(const ProtectCommand&, const ProtectCommand&) = default;
};
/// Adds members and roles to a box, or removes them.
struct BoxMembersCommand {
  std::string name;
  bool is_removal = false;
  std::vector<std::string> players;
  std::vector<std::string> roles;
  friend bool operator==(const BoxMembersCommand&, const BoxMembersCommand&) = default;
};
/// Protects a box for the one who gives the command.
struct ClaimCommand {
  std::string name;
  VoxelBox box;
  friend bool operator==(const ClaimCommand&, const ClaimCommand&) = default;
};
struct UnprotectCommand {
  std::string name;
  friend bool operator==(const UnprotectCommand&, const UnprotectCommand&) = default;
};
struct ListBoxesCommand {
  std::optional<VoxelPos> at;  // those that hold this voxel; nullopt: all
  friend bool operator==(const ListBoxesCommand&, const ListBoxesCommand&) = default;
};

/// Asks whether a player has a right, and which record decides it.
struct WhyCommand {
  std::string player;
  Right right{};
  std::optional<VoxelPos> at;  // with Right::build only: whether the player may change this voxel
  friend bool operator==(const WhyCommand&, const WhyCommand&) = default;
};
/// Takes back a record that changed rights.
struct UndoRightsCommand {
  Sequence seq = 0;
  friend bool operator==(const UndoRightsCommand&, const UndoRightsCommand&) = default;
};

using RightsCommand =
    std::variant<ListRolesCommand, SetRoleCommand, RemoveRoleCommand, DefaultRoleCommand,
                 GrantCommand, RevokeCommand, ListGrantsCommand, RestrictCommand, LiftCommand,
                 ListRestrictionsCommand, KickCommand, ProtectCommand, BoxMembersCommand,
                 ClaimCommand, UnprotectCommand, ListBoxesCommand, WhyCommand, UndoRightsCommand,
                 CreateInviteCommand, CancelInviteCommand, ListInvitesCommand, ListRefusalsCommand,
                 SetPasswordCommand, ClearPasswordCommand, ShowPasswordCommand>;

/// Returns what follows the word `verifier` of `password set`: salt and hash in hexadecimal digits.
std::string verifier_text(const JoinPassword& password);

/// Parses the words of a line, of which there is at least one. Returns nullopt if the first word is
/// no command about rights. The error is one line of text for the person who typed the command.
std::optional<Result<RightsCommand, std::string>> parse_rights_command(
    const std::vector<std::string>& words, TimeUs now_us);

}  // namespace runstone
