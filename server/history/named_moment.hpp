// NamedMoment: a place in the log as people write it.
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
  TimeUs us = 0;  // before the time of the log's last edit, >= 0
  friend bool operator==(const BeforeEnd&, const BeforeEnd&) = default;
};
/// After this edit; after the last one that was not later than a time.
using NamedMoment = std::variant<Sequence, AtTime, BeforeEnd>;

/// "9120", a time in UTC such as "2026-11-21T23:05:00Z" or, behind a minus, a duration such as "-2h30m" (both as
/// common/core/utc_text.hpp reads them). The error says what is wrong with the text.
Result<NamedMoment, std::string> parse_moment(std::string_view text);

/// The sequence that a moment means in this world: that of the last edit not later, so 0 before the first edit. Fails (bad_request) if
/// it lies before what was compacted, or behind the end of the log where it was named by its sequence.
StoreResult<Sequence> sequence_of(LogReader& reader, const NamedMoment& moment);

}  // namespace runstone
