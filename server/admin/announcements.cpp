#include "server/admin/announcements.hpp"

#include <algorithm>
#include <utility>

#include "common/core/utc_text.hpp"
#include "common/core/world_time.hpp"
#include "protocol/rules/chat_text.hpp"
#include "server/admin/rights_change_text.hpp"

namespace runstone {
namespace {

constexpr TimeUs kUtcDayUs = 86'400'000'000;
constexpr TimeUs kClockJumpUsMax = 600'000'000;
constexpr const char* kAnnouncementRule = "every DURATION TEXT, or at HH:MM TEXT (UTC)";

std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// Takes the first word, and the blanks around it.
std::string_view take_announced_word(std::string_view& text) {
  text = without_blanks(text);
  const std::string_view word = text.substr(0, text.find(' '));
  text = without_blanks(text.substr(word.size()));
  return word;
}

/// Returns true if this time of the day comes after `since_us` and not after `now_us` (UTC).
bool has_come(std::uint32_t at_ms, TimeUs since_us, TimeUs now_us) {
  const TimeUs at_us = TimeUs{at_ms} * 1'000;
  const auto days = [at_us](TimeUs us) {
    const TimeUs shifted = us - at_us;
    return shifted / kUtcDayUs - (shifted % kUtcDayUs < 0 ? 1 : 0);
  };
  return days(now_us) > days(since_us);
}

}  // namespace

Result<Announcement, std::string> parse_announcement(std::string_view text) {
  Announcement out;
  const std::string_view form = take_announced_word(text);
  if (form == "every") {
    const std::string_view word = take_announced_word(text);
    const auto every_us = parse_duration(word);
    if (!every_us || *every_us < kAnnouncedEveryUsMin || *every_us > kAnnouncedEveryUsMax)
      return failure("every \"" + std::string(word) + "\": a time from 1m to 7d, such as 30m");
    // In two units, as text_of() writes it.
    out.every_us = parse_duration(apart_text(*every_us)).value_or(*every_us);
  } else if (form == "at") {
    const std::string_view word = take_announced_word(text);
    const auto at_ms = parse_day_ms(word);
    if (!at_ms)
      return failure("at \"" + std::string(word) + "\": a time from 0:00 to 23:59, such as 20:00");
    out.at_ms = *at_ms;
  } else {
    return failure(std::string("an announcement is ") + kAnnouncementRule);
  }
  auto line = chat_text(text);
  if (!line) return failure("the text of an announcement is refused: " + line.error());
  if (line->find('|') != std::string::npos)
    return failure("the text of an announcement has a \"|\", which divides announcements");
  out.text = *std::move(line);
  return out;
}

Result<std::vector<Announcement>, std::string> parse_announcements(std::string_view text) {
  std::vector<Announcement> out;
  if (without_blanks(text).empty()) return out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('|', at), text.size());
    auto each = parse_announcement(text.substr(at, end - at));
    if (!each) return failure(each.error());
    if (out.size() == kAnnouncementsMax)
      return failure("has more than " + std::to_string(kAnnouncementsMax) + " announcements");
    out.push_back(*std::move(each));
    at = end + 1;
  }
  return out;
}

std::string text_of(const Announcement& announcement) {
  const std::string when = announcement.every_us != 0 ? "every " + apart_text(announcement.every_us)
                                                      : "at " + day_time_text(announcement.at_ms);
  return when + " " + announcement.text;
}

std::string text_of(const std::vector<Announcement>& announcements) {
  std::string text;
  for (const Announcement& each : announcements)
    text += (text.empty() ? "" : " | ") + text_of(each);
  return text;
}

void Announcements::set_configured(const std::vector<Announcement>& announcements) {
  std::vector<Entry> entries;
  for (const Announcement& each : announcements) {
    const auto old = std::ranges::find_if(
        entries_, [&](const Entry& entry) { return entry.is_configured && entry.what == each; });
    entries.push_back({each, true, old == entries_.end() ? std::nullopt : old->next_us});
  }
  for (Entry& entry : entries_) {
    if (!entry.is_configured) entries.push_back(std::move(entry));
  }
  entries_ = std::move(entries);
}

Result<void, std::string> Announcements::add(Announcement announcement) {
  const auto added = static_cast<std::size_t>(
      std::ranges::count_if(entries_, [](const Entry& entry) { return !entry.is_configured; }));
  if (added >= kAnnouncementsMax)
    return failure("commands have added " + std::to_string(added) +
                   " announcements already (announcements remove N)");
  entries_.push_back({std::move(announcement), false, std::nullopt});
  return {};
}

Result<Announcement, std::string> Announcements::remove(std::size_t number) {
  if (number == 0 || number > entries_.size())
    return failure("there is no announcement " + std::to_string(number) +
                   " (announcements lists them)");
  const auto entry = entries_.begin() + static_cast<std::ptrdiff_t>(number - 1);
  if (entry->is_configured)
    return failure("announcement " + std::to_string(number) +
                   " is one of the setting announcements: change it there, and reload");
  Announcement removed = std::move(entry->what);
  entries_.erase(entry);
  return removed;
}

std::string Announcements::list() const {
  std::string text;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    text += (i == 0 ? "" : "\n") + std::to_string(i + 1) + " " + text_of(entries_[i].what) +
            (entries_[i].is_configured ? " (setting)" : "");
  }
  return text.empty() ? "there are no announcements (announce every 30m TEXT adds one)" : text;
}

void Announcements::tick(TimeUs steady_us, TimeUs utc_us, const Say& say) {
  const TimeUs since_us = ticked_utc_us_.value_or(utc_us);
  const bool is_steady =
      utc_us - since_us <= kClockJumpUsMax && since_us - utc_us <= kClockJumpUsMax;
  // A clock that is put back a little does not let a time of the day come again.
  ticked_utc_us_ = is_steady ? std::max(since_us, utc_us) : utc_us;
  for (Entry& entry : entries_) {
    if (entry.what.every_us == 0) {
      if (is_steady && has_come(entry.what.at_ms, since_us, utc_us)) say(entry.what.text);
      continue;
    }
    const bool is_due = entry.next_us && steady_us >= *entry.next_us;
    if (is_due) say(entry.what.text);
    if (is_due || !entry.next_us) entry.next_us = steady_us + entry.what.every_us;
  }
}

}  // namespace runstone
