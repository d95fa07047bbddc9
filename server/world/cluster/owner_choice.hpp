// OwnerChoice: finds out whether the world should move to another server, because most edits come
// from the players there. An edit of a player at a server that follows takes the way to the owner
// and back.
//   - The owner looks at the edits of each server in windows of kOwnerWindowUs.
//   - The world should move to a server whose players made more than three quarters of all edits,
//     and at least kOwnerEditsPerSecond, in kOwnerWindows windows in a row.
//   - It moves at most once in kOwnerPauseUs.
// Thread: the world strand. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "common/core/ids.hpp"

namespace runstone {

inline constexpr TimeUs kOwnerWindowUs = 10'000'000;
inline constexpr int kOwnerWindows = 3;
inline constexpr std::uint64_t kOwnerEditsPerSecond = 5;
inline constexpr TimeUs kOwnerPauseUs = 60'000'000;

class OwnerChoice {
 public:
  /// The edits since this server owns the world, or since the other server connected.
  struct Counts {
    std::uint64_t here = 0;
    std::map<SessionId, std::uint64_t> there;  // by the session of the server
  };

  /// Begins anew. For a server that owns the world from now on. Without this call, it has always
  /// owned it.
  void begin(TimeUs now_us) {
    *this = {};
    next_us_ = now_us + kOwnerPauseUs;
  }
  /// Returns true if look() has something to do.
  bool is_due(TimeUs now_us) const { return !window_us_ || now_us - *window_us_ >= kOwnerWindowUs; }
  /// Ends a window if it is due. Returns the server to which the world should move now, or nullopt.
  std::optional<SessionId> look(Counts counts, TimeUs now_us) {
    if (!is_due(now_us)) return std::nullopt;
    const bool is_first = !window_us_;
    const TimeUs length_us = is_first ? 0 : now_us - *window_us_;
    const auto busiest = is_first ? std::nullopt : busiest_of(counts, length_us);
    window_us_ = now_us;
    counts_ = std::move(counts);
    windows_ = !busiest ? 0 : busiest == candidate_ ? windows_ + 1 : 1;
    candidate_ = busiest;
    if (windows_ < kOwnerWindows || now_us < next_us_) return std::nullopt;
    windows_ = 0;
    next_us_ = now_us + kOwnerPauseUs;
    return busiest;
  }

 private:
  /// Returns the server with enough edits in the window, or nullopt.
  std::optional<SessionId> busiest_of(const Counts& counts, TimeUs length_us) const {
    std::uint64_t all = counts.here - counts_.here, most = 0;
    std::optional<SessionId> busiest;
    for (const auto& [server, total] : counts.there) {
      const auto before = counts_.there.find(server);
      const std::uint64_t edits = total - (before == counts_.there.end() ? 0 : before->second);
      all += edits;
      if (edits <= most) continue;
      most = edits;
      busiest = server;
    }
    const auto seconds = static_cast<std::uint64_t>(length_us) / 1'000'000;
    const bool has_enough = most * 4 > all * 3 && most >= kOwnerEditsPerSecond * seconds;
    return has_enough ? busiest : std::nullopt;
  }

  std::optional<TimeUs> window_us_;  // when the window under way began
  Counts counts_;                    // at that time
  std::optional<SessionId> candidate_;
  int windows_ = 0;  // in a row in which the candidate had enough edits
  TimeUs next_us_ = 0;
};

}  // namespace runstone
