// PlayerRow, UsedName, NameClaim and HighWater: the values about players that the world strand, the
// store and the commands share. PlayerRow maps an author number to a key and a name. UsedName is a
// name that a player uses or has used. NameClaim says which key owns a name. HighWater is the
// watermark of one client process.
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

/// A name that a key owns. At most one claim has a folded form.
struct NameClaim {
  std::string folded;  // folded_name() of the name, as it was when the name was claimed
  std::string name;    // as the owner wrote it
  PublicKey key{};
  friend bool operator==(const NameClaim&, const NameClaim&) = default;
};
struct NameChange {
  NameClaim claim;
  bool is_release = false;  // the name has no owner any more
};

/// The highest resolved client sequence of a client instance. It survives compaction of the log.
struct HighWater {
  AuthorId author = 0;
  ClientInstance instance = 0;
  ClientSequence resolved = 0;
  TimeUs last_us = 0;  // UTC, of the instance's last record
};

/// Returns the row of a repaired world whose watermarks are not all known: author 0 and instance 0,
/// which no client has. `author_max` is the highest author number at the repair; `now_us` is the
/// time of the repair, in UTC.
inline HighWater lost_watermarks(AuthorId author_max, TimeUs now_us) {
  return {0, 0, author_max, now_us};
}
inline bool is_of_lost_watermarks(const HighWater& row) {
  return row.author == 0 && row.instance == 0;
}

}  // namespace runstone
