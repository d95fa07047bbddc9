// PlayerRow and HighWater: what world strand and store both know of players: who has an author number, and
// how far each of their client processes got. Plain values.
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

/// Highest client sequence decided per client instance; survives compaction of the log.
struct HighWater {
  AuthorId author = 0;
  ClientInstance instance = 0;
  ClientSequence resolved = 0;
  TimeUs last_us = 0;  // UTC, of the instance's last record: old instances may be forgotten one day
};

}  // namespace runstone
