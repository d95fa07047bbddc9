#include "server/runtime/clock_check.hpp"

#include <sys/stat.h>

#include <algorithm>

#include "common/core/utc_text.hpp"
#include "common/os/clock_service.hpp"
#include "server/runtime/read_clocks.hpp"
#include "server/store/store.hpp"
#include "server/world/order/log_clock.hpp"

namespace runstone {
namespace {

/// Returns when a file was written, or 0 if it cannot be read.
TimeUs written_at(const std::string& file) {
  struct stat about{};
  if (::stat(file.c_str(), &about) != 0) return 0;
  return TimeUs{about.st_mtim.tv_sec} * 1'000'000 + about.st_mtim.tv_nsec / 1'000;
}

}  // namespace

ClockCheck check_clock(const ClockEvidence& evidence) {
  ClockCheck check;
  const TimeUs known_us = std::max(evidence.last_us, evidence.written_us);
  if (known_us == 0) return check;
  const std::string reads = "the wall clock reads " + utc_text(evidence.wall_us);
  // LogClock warns of a log that ends ahead of the wall clock.
  const bool is_log_ahead = evidence.last_us > evidence.wall_us + LogClock::kJumpUs;
  if (evidence.written_us - evidence.wall_us > LogClock::kJumpUs && !is_log_ahead) {
    check.warning = reads + ", but " + evidence.file + " was written at " +
                    utc_text(evidence.written_us) +
                    ": the clock is wrong now, or it was wrong then. Set it right before people "
                    "build, because their edits get its time";
  }
  if (evidence.wall_us - known_us <= kRestUs || evidence.is_synchronised.value_or(false))
    return check;
  check.warning = reads + ", but nothing in the world is newer than " + utc_text(known_us) +
                  ": it has rested for more than 30 days, or the clock is wrong";
  if (!evidence.is_synchronised) return check;
  check.begin_us = known_us;
  *check.warning +=
      ". No time service has set the clock, so the time of the log goes on from there, and follows "
      "the wall clock if it stays so for an hour. If the clock is right, the command `clock correct "
      "anyway` makes the log follow at once; otherwise set it right now";
  return check;
}

std::optional<std::string> doubt_of_clock_behind(const ClockEvidence& evidence) {
  if (evidence.is_synchronised)
    return *evidence.is_synchronised ? std::nullopt
                                     : std::optional<std::string>("no time service has set it");
  if (evidence.written_us - evidence.wall_us <= LogClock::kJumpUs) return std::nullopt;
  return "it is behind the time at which " + evidence.file + " was written, " +
         utc_text(evidence.written_us);
}

ClockEvidence read_clock_evidence(const std::string& place, TimeUs last_us) {
  ClockEvidence evidence;
  evidence.wall_us = read_clocks().utc_us;
  evidence.last_us = last_us;
  evidence.is_synchronised = is_clock_synchronised();
  if (is_database(place)) return evidence;
  for (const char* name : {"world.sqlite", "world.durable"}) {
    const std::string file = place + "/" + name;
    const TimeUs written_us = written_at(file);
    if (written_us <= evidence.written_us) continue;
    evidence.written_us = written_us;
    evidence.file = file;
  }
  return evidence;
}

}  // namespace runstone
