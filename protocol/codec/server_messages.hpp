// Server messages: what two servers of one world say to each other. The server that owns the world
// orders its edits. A server that follows is its client: it gets every record of the log, and
// passes on what its own players do. It has proved that it holds the world's secret key.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/public_key.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/pose.hpp"
#include "protocol/limits.hpp"

namespace runstone {

/// Asks for the records of the log. The follower has those up to this version.
struct FollowRequest {
  Version after;
  // The follower's entry in the list of servers, see ServerEntry. Without an address it has none.
  std::string player_address = {}, page_address = {};
  friend bool operator==(const FollowRequest&, const FollowRequest&) = default;
};
/// The owner sends every record after `head`, in LogPart messages. Those up to it are in the
/// database, or will be as soon as they are durable.
struct FollowAnswer {
  Sequence head = 0;
  friend bool operator==(const FollowAnswer&, const FollowAnswer&) = default;
};

struct LogPlayer {
  AuthorId author = 1;
  PublicKey key{};
  std::string name;  // 1 .. kPlayerNameBytesMax bytes
  friend bool operator==(const LogPlayer&, const LogPlayer&) = default;
};
struct LogName {
  std::string folded;  // 1 .. kFoldedNameBytesMax bytes
  std::string name;    // 1 .. kPlayerNameBytesMax bytes
  PublicKey key{};
  bool is_release = false;
  friend bool operator==(const LogName&, const LogName&) = default;
};
struct LogPartRecord {
  EditRecord record;
  TimeUs submitted_us = 0;  // EditRequest::submitted_us; 0: not known
  friend bool operator==(const LogPartRecord&, const LogPartRecord&) = default;
};
/// What the owner appends to its log at a time: rows of players, then changes of names, then
/// records.
struct LogPart {
  Epoch epoch = 1;  // of the owner's start
  std::vector<LogPlayer> players;
  std::vector<LogName> names;
  std::vector<LogPartRecord> records;  // without gaps; none of them has an epoch above `epoch`
  friend bool operator==(const LogPart&, const LogPart&) = default;
};

/// A player's session at a follower, which the owner is to handle. `session` is the number that the
/// follower gave it.
struct RelayOpen {
  SessionId session = 0;
  std::uint64_t address = 0;  // AddressBlock
  bool is_encrypted = false;
  PublicKey key{};  // the player has proved to the follower that it is theirs
  ClientInstance instance = 0;
  std::string name;
  std::uint64_t features = 0;  // in force
  /// 0: the player joins. Otherwise the number that an earlier owner gave to the player, whose
  /// session goes on.
  AuthorId author = 0;
  Pose pose;
  std::string ticket;  // ClientAuth::ticket
  /// ClientAuth::password_key.
  std::optional<std::array<std::uint8_t, kPasswordKeyBytes>> password_key = std::nullopt;
  friend bool operator==(const RelayOpen&, const RelayOpen&) = default;
};
/// A message of a player to the owner, or of the owner to players. The body is not verified.
struct Relay {
  std::vector<SessionId> sessions;  // 1 .. kRelaySessionsMax; of a follower: one
  EncodedMessage message;
};
bool operator==(const Relay& a, const Relay& b);
/// A player's session has ended (from a follower), or is to be closed (from the owner).
struct RelayClose {
  SessionId session = 0;
  std::uint8_t reason = 1;  // GoodbyeReason
  std::string text;         // as in Goodbye
  friend bool operator==(const RelayClose&, const RelayClose&) = default;
};
/// A message of the session cost the owner as much as so many bytes.
struct RelayCharge {
  SessionId session = 0;
  std::uint64_t bytes = 0;
  friend bool operator==(const RelayCharge&, const RelayCharge&) = default;
};

}  // namespace runstone
