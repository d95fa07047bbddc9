// PlaySchedule: when the recorded edits of one author are submitted again. Open loop: each edit is
// due at its time, whatever became of the edits before. It is late in three cases only:
//   - kPlayUnansweredMax edits wait for an answer.
//   - The rate would exceed kPlayRateMax. A server ends a session that sends too many messages.
//   - The server rejected edits for a while, because of a rate limit or a full log. Then nothing is
//     submitted until every open edit is answered and a pause is over. The retries come first, in
//     their old order. From the second pause on, the rate stays below what the server accepted
//     since the last.
// If retry() was never called, the server gets the edits in their order. Pure: times are arguments,
// in microseconds of one steady clock. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

inline constexpr std::size_t kPlayUnansweredMax = 1024;
/// Edits per second. By default servers accept 10,000 messages per second.
inline constexpr double kPlayRateMax = 8'000;
inline constexpr TimeUs kPlayPauseUs = 250'000;

class PlaySchedule {
 public:
  /// `offsets_us`: the recorded time of each edit since the start. Requires values that are not
  /// negative and never decrease. `speed`: 2 plays twice as fast. 0 submits whenever there is room;
  /// then each edit is due when it is submitted.
  PlaySchedule(std::vector<TimeUs> offsets_us, double speed);

  void begin(TimeUs now_us);

  struct DueEdit {
    std::size_t index = 0;  // of the edit
    TimeUs due_us = 0;
  };
  /// Returns the edit to offer now, or nullopt if none is due or allowed. The caller must answer
  /// it with accepted(), dropped() or retry().
  std::optional<DueEdit> next(TimeUs now_us);
  /// The edit was applied.
  void accepted();
  /// The edit was rejected finally, or its outcome is unknown.
  void dropped();
  /// The edit was rejected for a while and must be submitted again.
  void retry(const DueEdit& due, TimeUs now_us);

  /// Returns the number of edits that were due until now.
  std::uint64_t due(TimeUs now_us) const;
  std::size_t unanswered() const { return unanswered_; }
  /// Returns the number of retries that were not submitted yet.
  std::size_t waiting() const { return retries_.size(); }
  /// Returns true if every edit was submitted and answered.
  bool done() const { return next_ == offsets_us_.size() && retries_.empty() && unanswered_ == 0; }

 private:
  TimeUs due_of(std::size_t index, TimeUs now_us) const;

  std::vector<TimeUs> offsets_us_;
  double speed_;
  std::optional<TimeUs> began_us_;
  std::size_t next_ = 0;
  std::map<std::size_t, TimeUs> retries_;  // due times, by index
  std::size_t unanswered_ = 0;
  double rate_ = kPlayRateMax, free_us_ = 0;  // the next edit is allowed from then on
  // Since the last pause.
  bool is_paused_ = false;  // until every edit is answered and the pause is over
  std::uint64_t pauses_ = 0, accepted_ = 0;
  TimeUs paused_us_ = 0;
};

}  // namespace runstone
