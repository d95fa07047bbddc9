// Invite: lets players join who have no role of their own yet, and gives them one. The world's log
// holds what an invite allows; the link that a player gets names the invite and proves that this
// server made it (protocol/codec/invite_token.hpp).
#pragma once
#include <cstdint>
#include <string>

#include "common/core/ids.hpp"

namespace runstone {

/// Random, so that nobody guesses it.
using InviteId = std::uint64_t;

inline constexpr std::uint32_t kInviteUsesMax = 1000;

struct Invite {
  InviteId id = 0;
  std::string role;        // of the players who accept it
  std::uint32_t uses = 1;  // players who may accept it, 1 .. kInviteUsesMax
  TimeUs until_us = 0;     // UTC; it cannot be accepted from then on
  friend bool operator==(const Invite&, const Invite&) = default;
};

}  // namespace runstone
