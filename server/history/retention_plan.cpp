#include "server/history/retention_plan.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "common/core/utc_text.hpp"
#include "server/store/removed_history.hpp"

namespace runstone {
namespace {

constexpr TimeUs kDayUs = 86'400'000'000;
// The number of edits behind a cut that are searched for actions that it would divide, and the
// number of times that the cut moves back for them.
constexpr Sequence kActionLookEdits = 256;
constexpr int kActionLooks = 8;

Unexpected<StoreError> refuse_plan(const WorldReader& reader, std::string what) {
  return {{StoreError::Kind::bad_request, reader.file(), "retention", std::move(what)}};
}

/// Returns the cut, moved back so that no action of a player has edits on both sides of it, as far
/// as kActionLookEdits show. It stays at or behind the head.
StoreResult<Sequence> before_actions(WorldReader& reader, Sequence head, Sequence cut) {
  for (int look = 0; look < kActionLooks && cut > head; ++look) {
    Sequence first = cut + 1;
    const auto read =
        reader.read_log(cut + 1, cut + kActionLookEdits, [&](const EditRecord& record) {
          if (record.cause == Cause::player && record.subject > 0)
            first = std::min(first, record.subject);
          return true;
        });
    if (!read) return failure(read.error());
    if (first > cut) return cut;
    // An action that began before the head is divided already.
    cut = std::max(head, first - 1);
  }
  return cut;
}

/// Returns the doubt about an edit behind which the time of the log steps ahead. A wrong clock
/// makes such a step, and then all edits before it look old. `old` is the newest edit that looks
/// old.
StoreResult<std::string> doubt_of(WorldReader& reader, const LogEnd& old, std::uint64_t days) {
  std::string doubt;
  const auto read =
      reader.read_log(old.version.seq + 1, old.version.seq + 1, [&](const EditRecord& next) {
        const TimeUs step_us = next.time_us - old.time_us;
        if (step_us < static_cast<TimeUs>(days) * kDayUs) return false;
        doubt = "the time of the log steps ahead by " + std::to_string(step_us / kDayUs) +
                " days, from " + removed_place(old) + " to " + utc_text(next.time_us) +
                ": nobody built for so long, or the clock of the "
                "machine was wrong";
        return false;
      });
  if (!read) return failure(read.error());
  return doubt;
}

}  // namespace

StoreResult<RetentionPlan> plan_retention(WorldReader& reader, std::uint64_t days, TimeUs now_us) {
  if (days == 0)
    return refuse_plan(reader,
                       "0 days would keep no edit: nothing could be seen in the past, rolled "
                       "back or undone any more; keep at least 1 day");
  if (days > kRetentionDaysMax)
    return refuse_plan(reader,
                       "at most " + std::to_string(kRetentionDaysMax) + " days can be kept");
  RetentionPlan plan;
  plan.days = days;
  const auto head = reader.log_head();
  if (!head) return failure(head.error());
  const auto range = reader.log_range();
  if (!range) return failure(range.error());
  plan.head = plan.cut = *head;
  plan.newest = range->last;
  const auto free = reader.free_space();
  if (!free) return failure(free.error());
  plan.free = *free;
  const TimeUs kept_us = static_cast<TimeUs>(days) * kDayUs;
  const TimeUs from_us = std::min(range->last.time_us, now_us);
  if (from_us < std::numeric_limits<TimeUs>::min() + kept_us) return plan;
  const auto found = reader.sequence_at(from_us - kept_us);
  if (!found) {
    // All older edits are already removed.
    if (found.error().kind == StoreError::Kind::bad_request) return plan;
    return failure(found.error());
  }
  // The newest edit stays even if eras of a wrong clock would let it go.
  const Sequence oldest_kept = range->last.version.seq;
  const Sequence wanted = std::min(*found, oldest_kept == 0 ? 0 : oldest_kept - 1);
  if (wanted <= head->version.seq) return plan;
  const auto cut = before_actions(reader, head->version.seq, wanted);
  if (!cut) return failure(cut.error());
  if (*cut <= head->version.seq) return plan;
  const auto end = reader.edit_at(*cut);
  if (!end) return failure(end.error());
  if (!end->has_value()) return plan;  // it was removed meanwhile
  plan.cut = **end;
  const auto volume = reader.log_volume(*cut);
  if (!volume) return failure(volume.error());
  plan.volume = *volume;
  // The cut may have moved back from this edit, so that it divides no action.
  const auto old = reader.edit_at(wanted);
  if (!old) return failure(old.error());
  auto doubt = doubt_of(reader, old->value_or(plan.cut), days);
  if (!doubt) return failure(doubt.error());
  plan.doubt = *std::move(doubt);
  return plan;
}

}  // namespace runstone
