// Player activity: how much each player has built, counted from the log. It blocks on the disk.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/rollback/selection.hpp"

namespace runstone {

/// Edits of a player that are at most so far apart count as one stretch of building.
inline constexpr TimeUs kBuildingGapUs = TimeUs{5} * 60 * 1'000'000;
/// No further part of the log is read once so many records were read. A part is at most as large as
/// all parts before it and 4,096 edits.
inline constexpr std::size_t kActivityRecordsMax = 500'000;

struct PlayerActivity {
  AuthorId author = 0;
  std::uint64_t edits = 0;
  std::uint64_t voxels = 0;  // counted_voxels() of these edits
  TimeUs building_us = 0;    // of all stretches; a single edit takes no time
  TimeUs first_us = 0;       // UTC, of the player's first edit that the log has
  TimeUs last_us = 0;        // UTC, of the newest of these edits
};

struct ActivityReport {
  std::vector<PlayerActivity> players;  // those with the most edits first, at most `count_max`
  std::size_t players_found = 0;        // also those beyond
  bool is_complete = true;              // false: older edits that match were not read
  TimeUs from_us = 0;                   // UTC, of the oldest edit that was read; 0: there is none
};

/// Counts the edits of players that match the filter, whose cause is set to `player`. Author 0, the
/// server, is left out. Fails as the reader. Cost: O(edits that match), at most about twice
/// kActivityRecordsMax, and O(log edits) for each of the players in the answer. Memory: O(players).
StoreResult<ActivityReport> read_activity(LogReader& reader, SelectionFilter filter,
                                          std::size_t count_max);

}  // namespace runstone
