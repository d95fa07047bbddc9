#include "server/history/named_moment.hpp"

#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

#include "common/core/utc_text.hpp"
#include "server/store/removed_history.hpp"

namespace runstone {

Result<NamedMoment, std::string> parse_moment(std::string_view text) {
  const auto wrong = [&] {
    return failure(
        "\"" + std::string(text) +
        "\" is no moment: write a sequence (9120), a time in UTC (2026-11-21T23:05:00Z) or a time "
        "before the end of the log (-2h30m)");
  };
  if (text.starts_with('-')) {
    const auto duration = parse_duration(text.substr(1));
    if (!duration) return wrong();
    return NamedMoment(BeforeEnd{*duration});
  }
  Sequence sequence = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), sequence);
  if (!text.empty() && end == text.data() + text.size()) {
    if (error != std::errc() || sequence > kSequenceMax) return wrong();
    return NamedMoment(sequence);
  }
  const auto time = parse_utc(text);
  if (!time) return wrong();
  return NamedMoment(AtTime{*time});
}

StoreResult<Sequence> sequence_of(LogReader& reader, const NamedMoment& moment) {
  const auto range = reader.log_range();
  if (!range) return failure(range.error());
  const auto refuse = [&](std::string what) {
    return failure(
        StoreError{StoreError::Kind::bad_request, reader.file(), "edit_log", std::move(what)});
  };
  if (const auto* sequence = std::get_if<Sequence>(&moment)) {
    if (*sequence + 1 < range->first) {
      const auto head = reader.log_head();
      if (!head) return failure(head.error());
      return refuse("begins at seq=" + std::to_string(range->first) +
                    ": seq=" + std::to_string(*sequence) + " was " + removed_up_to(*head));
    }
    if (*sequence <= range->last.version.seq) return *sequence;
    return refuse("ends at seq=" + std::to_string(range->last.version.seq) +
                  ", before seq=" + std::to_string(*sequence));
  }
  const auto* before_end = std::get_if<BeforeEnd>(&moment);
  // A damaged time may be near the earliest value, so the subtraction is checked. earliest + us
  // cannot overflow, since us >= 0.
  const TimeUs last = range->last.time_us;
  TimeUs us = before_end != nullptr ? 0 : std::get_if<AtTime>(&moment)->us;
  if (before_end != nullptr) {
    const TimeUs earliest = std::numeric_limits<TimeUs>::min();
    us = last < earliest + before_end->us ? earliest : last - before_end->us;
  }
  return reader.sequence_at(us);
}

}  // namespace runstone
