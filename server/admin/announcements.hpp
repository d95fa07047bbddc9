// Announcements: lines that the server writes to all players at an interval, or at a time of each
// day. A list comes from the setting `announcements`, and commands add to it until the server
// stops. Pure: times are arguments. Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

inline constexpr std::size_t kAnnouncementsMax = 16;  // of the setting, and as many of commands
inline constexpr TimeUs kAnnouncedEveryUsMin = TimeUs{60} * 1'000'000;
inline constexpr TimeUs kAnnouncedEveryUsMax = TimeUs{7} * 86'400'000'000;

struct Announcement {
  TimeUs every_us = 0;      // between two of them; 0: at a time of the day
  std::uint32_t at_ms = 0;  // since midnight UTC
  std::string text;         // chat_text()
  friend bool operator==(const Announcement&, const Announcement&) = default;
};

/// Parses "every 30m TEXT" or "at 20:00 TEXT". The time of day is in UTC. Fails with the fault in
/// words.
Result<Announcement, std::string> parse_announcement(std::string_view text);
/// Parses announcements with "|" between them. An empty text has none. Fails with the fault in
/// words, also if there are more than kAnnouncementsMax.
Result<std::vector<Announcement>, std::string> parse_announcements(std::string_view text);
/// Returns a text that parse_announcement() reads.
std::string text_of(const Announcement& announcement);
/// Returns a text that parse_announcements() reads.
std::string text_of(const std::vector<Announcement>& announcements);

class Announcements {
 public:
  using Say = std::function<void(const std::string&)>;

  /// Replaces the announcements of the setting. An announcement that was in the old list keeps the
  /// time of its next line.
  void set_configured(const std::vector<Announcement>& announcements);
  /// Adds an announcement of a command. Fails if there are too many.
  Result<void, std::string> add(Announcement announcement);
  /// Removes the announcement with this number in list(). Fails with the reason if there is none,
  /// or if no command has added it.
  Result<Announcement, std::string> remove(std::size_t number);
  /// Returns a line for each announcement, with its number from 1.
  std::string list() const;
  /// Calls `say` for each line that is due. A line that was due while the clock jumped by more than
  /// ten minutes, or before the first call, is left out. If the clock is put back by ten minutes or
  /// less, no time of the day comes again. Cost: O(announcements).
  void tick(TimeUs steady_us, TimeUs utc_us, const Say& say);

 private:
  struct Entry {
    Announcement what;
    bool is_configured = false;
    std::optional<TimeUs> next_us;  // steady clock; nullopt: tick() has not seen it yet
  };
  std::vector<Entry> entries_;           // those of the setting first
  std::optional<TimeUs> ticked_utc_us_;  // the latest UTC time of tick() since the clock jumped
};

}  // namespace runstone
