// The commands of moderators: status, names, kick, ban, mute, freeze, unban, unmute, unfreeze,
// bans, refusals, chat log.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/rights/address_range.hpp"
#include "common/rights/rights_change.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

struct KickCommand {
  std::vector<std::string> players;
  std::string reason;  // may be empty
  friend bool operator==(const KickCommand&, const KickCommand&) = default;
};
/// Whom a restriction is for: a player, or a range of addresses.
struct RestrictionWord {
  std::string player;                 // empty: a range
  std::optional<AddressRange> range;  // nullopt: a player
  bool is_widened = false;            // a single IPv6 address was typed, which means its /64
  std::string address = {};           // of a range, as it was typed
  bool is_address = false;            // "address" stood before it, so it is no player's name
  friend bool operator==(const RestrictionWord&, const RestrictionWord&) = default;
};
struct RestrictCommand {
  RestrictionKind kind{};
  std::vector<RestrictionWord> who;
  TimeUs until_us = 0;  // UTC; 0: until it is lifted
  std::string reason;   // may be empty
  friend bool operator==(const RestrictCommand&, const RestrictCommand&) = default;
};
struct LiftCommand {
  RestrictionKind kind{};
  std::vector<RestrictionWord> who;
  friend bool operator==(const LiftCommand&, const LiftCommand&) = default;
};

struct WithdrawCommand {
  std::vector<std::string> players;  // whose lines of the chat are withdrawn
  friend bool operator==(const WithdrawCommand&, const WithdrawCommand&) = default;
};

std::span<const CommandRow> moderation_commands();

}  // namespace runstone
