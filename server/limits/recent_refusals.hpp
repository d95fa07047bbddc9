// RecentRefusals: what players were refused lately, for moderators. Equal refusals of a player are
// one row with a count. A player has few rows, and refused joins are given up first, so that nobody
// hides what others did.
// Memory: at most kRefusalRowsMax rows. Thread: one. Times are arguments.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/public_key.hpp"

namespace runstone {

inline constexpr std::size_t kRefusalRowsMax = 512;
/// What a refused join begins with, as text of a row.
inline constexpr const char* kRefusedJoin = "join: ";
inline constexpr std::size_t kRefusalRowsOfKeyMax = 16;

struct RefusalRow {
  PublicKey key{};
  std::string what;  // such as "edit: the ground is protected: spawn"
  std::uint64_t count = 0;
  TimeUs first_us = 0, last_us = 0;  // UTC
  friend bool operator==(const RefusalRow&, const RefusalRow&) = default;
};

class RecentRefusals {
 public:
  /// Counts a refusal. If there is no room for another row, one row of the player or of all goes:
  /// of the refused joins, or else of the others, the one that was refused longest ago. Cost: O(log
  /// rows); for a row too many, O(rows).
  void add(const PublicKey& key, const std::string& what, TimeUs now_us);
  /// Returns all rows, the newest last.
  std::vector<RefusalRow> rows() const;

 private:
  using Place = std::pair<PublicKey, std::string>;
  std::map<Place, RefusalRow> rows_;
};

}  // namespace runstone
