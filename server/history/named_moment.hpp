// NamedMoment: a place in the log as users write it.
#pragma once
#include <string>
#include <string_view>
#include <variant>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

struct AtTime {
  TimeUs us = 0;  // UTC
  friend bool operator==(const AtTime&, const AtTime&) = default;
};
struct BeforeEnd {
  TimeUs us = 0;  // from there to the log's last edit; >= 0
  friend bool operator==(const BeforeEnd&, const BeforeEnd&) = default;
};
/// The moment after an edit, named by its sequence, or after the last edit that is not later than a
/// time.
using NamedMoment = std::variant<Sequence, AtTime, BeforeEnd>;

/// Parses a sequence ("9120"), a time in UTC ("2026-11-21T23:05:00Z"), or a minus and a duration
/// ("-2h30m"). common/core/utc_text.hpp defines times and durations. The error is one line of text.
Result<NamedMoment, std::string> parse_moment(std::string_view text);

/// Returns the sequence of a moment in this world: that of the last edit that is not later, or 0
/// before the first edit. Fails (bad_request) if the moment was removed, or if it is a
/// sequence after the end of the log.
StoreResult<Sequence> sequence_of(LogReader& reader, const NamedMoment& moment);

}  // namespace runstone
