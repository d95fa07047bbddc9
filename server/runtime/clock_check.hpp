// ClockCheck decides whether the wall clock may be wrong when a server starts. It compares the wall
// clock with all times that the world has: the time of the last record of the log, and the times at
// which the files of the world were written. The rule:
//   - The wall clock may be more than kJumpUs behind one of these times. Then it is wrong now, or it
//     was wrong then. The operator is warned.
//   - The wall clock may be more than kRestUs ahead of all of these times, while the kernel does not
//     report that a time service has set it. Then the world has rested for long, or the clock is
//     wrong. The operator is warned. If the kernel reports that no time service has set the clock, the
//     log's time goes on from the newest of these times, and LogClock treats the wall clock as one that
//     has jumped.
// A clock that is wrong by less than kRestUs cannot be told from a right one.
#pragma once
#include <optional>
#include <string>

#include "common/core/ids.hpp"

namespace runstone {

inline constexpr TimeUs kRestUs = TimeUs{30} * 24 * 3600 * 1'000'000;

/// The times (UTC) that a start compares.
struct ClockEvidence {
  TimeUs wall_us = 0;
  TimeUs last_us = 0;     // of the last record of the log, 0: there is none
  TimeUs written_us = 0;  // when the newest file of the world was written, 0: there is none
  std::string file;       // the name of that file
  std::optional<bool> is_synchronised;  // is_clock_synchronised()
};

struct ClockCheck {
  std::optional<std::string> warning;  // for the operator, as a sentence
  std::optional<TimeUs> begin_us;      // LogPosition::begin_us
};

/// Applies the rule above. Reads no clock.
ClockCheck check_clock(const ClockEvidence& evidence);

/// Returns why a wall clock that is behind the time of the log may be wrong, as a part of a sentence,
/// or nullopt. It may be if the kernel reports that no time service has set it. It also may be if the
/// kernel reports nothing, and the clock is more than kJumpUs behind a file of the world.
std::optional<std::string> doubt_of_clock_behind(const ClockEvidence& evidence);

/// Reads the wall clock, and when the files of the world at `place` were written. A file that cannot
/// be read counts as missing. Call it before the world is changed. Blocks on the file system.
ClockEvidence read_clock_evidence(const std::string& place, TimeUs last_us);

}  // namespace runstone
