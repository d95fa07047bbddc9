// PlayerRow, UsedName and HighWater: the values about players that the world strand, the store
// and the commands share. PlayerRow maps an author number to a key and a name. UsedName is a name
// that a player uses or has used. HighWater is the watermark of one client process.
#pragma once
#include <string>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct PlayerRow {
  AuthorId author = 0;  // from 1
  PublicKey key{};
  std::string name;  // last used
};

struct UsedName {
  AuthorId author = 0;
  std::string name;
};

/// The highest resolved client sequence of a client instance. It survives compaction of the log.
struct HighWater {
  AuthorId author = 0;
  ClientInstance instance = 0;
  ClientSequence resolved = 0;
  TimeUs last_us = 0;  // UTC, of the instance's last record
};

}  // namespace runstone
