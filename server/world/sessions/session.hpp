// Session: who is connected, and how far the handshake has come. The other rooms of the world keep
// what they know of a session in records of their own.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/address_block.hpp"
#include "common/core/channel_binding.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/limits/assumed_position.hpp"

namespace runstone {

/// Times are of the steady clock.
struct Session {
  SessionId id = 0;
  SessionStage stage = SessionStage::greeting;
  /// The session gets nothing any more, and is removed at the end of the task (Sessions::close()).
  bool is_closed = false;
  /// The player has proved the key. The session opens when the claim of its name is on disk, or
  /// when the owner of the world lets the player in.
  bool is_authenticated = false;
  /// The server that owns the world decides whether the player may join.
  bool awaits_owner = false;
  /// The session is connected to another server, which sends it terrain and commits.
  bool is_relayed = false;
  std::uint64_t features = 0;  // in force, from welcome on
  AddressBlock address{};
  std::optional<ChannelBinding> binding;  // of an encrypted connection
  PublicKey key{};
  ClientInstance instance = 0;
  std::string name;
  AuthorId author = 0;           // valid when open
  std::uint32_t tile_rules = 0;  // SessionAccepted::tile_rules
  TimeUs connected_us = 0;
  TimeUs last_message_us = 0;
  Pose pose;
  AssumedPosition position;  // the reach of edits is measured from there

  bool is_open() const { return stage == SessionStage::open && !is_closed; }
  bool has(std::uint64_t feature) const { return (features & feature) != 0; }
};

}  // namespace runstone
