// PlaySchedule: when one author's recorded edits are handed in again. Open loop: each is due at its time, whatever
// became of the ones before. It gives way in three cases only:
//   - kPlayUnansweredMax edits wait for an answer;
//   - kPlayRateMax, since a server ends a session that sends more messages than it takes;
//   - the server pushed edits back (its rate limit, a full log): then nothing is handed in until all that is on its
//     way is answered and a pause is over; what was pushed back comes first again, in its old order, and from the
//     second time on the rate stays below what the server took since the time before.
// So where `pushed_back()` was never called, the server gets the edits in their order. Pure: times are arguments
// (microseconds of one steady clock). One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

inline constexpr std::size_t kPlayUnansweredMax = 1024;
inline constexpr double kPlayRateMax =
    8'000;  // edits a second; servers take 10,000 messages a second by default
inline constexpr TimeUs kPlayPauseUs = 250'000;

class PlaySchedule {
 public:
  /// `offsets_us`: of each edit since the start as recorded, never falling, not negative. `speed`: 2 plays twice as
  /// fast; 0 hands in whenever there is room, then each is due when it is handed in.
  PlaySchedule(std::vector<TimeUs> offsets_us, double speed);

  void begin(TimeUs now_us);

  struct Turn {
    std::size_t index = 0;  // of the edit
    TimeUs due_us = 0;
  };
  /// The edit to hand in now; nothing if none is due, or none may be. The caller owes one of the answers below for it.
  std::optional<Turn> next(TimeUs now_us);
  /// Applied.
  void accepted();
  /// Refused for good, or nobody knows.
  void dropped();
  /// To be offered again.
  void pushed_back(const Turn& turn, TimeUs now_us);

  std::uint64_t due(TimeUs now_us) const;  // edits whose time came
  std::size_t unanswered() const { return unanswered_; }
  /// Pushed back and not handed in again yet.
  std::size_t waiting() const { return again_.size(); }
  /// Every edit was handed in and answered.
  bool done() const { return next_ == offsets_us_.size() && again_.empty() && unanswered_ == 0; }

 private:
  TimeUs due_of(std::size_t index, TimeUs now_us) const;

  std::vector<TimeUs> offsets_us_;
  double speed_;
  std::optional<TimeUs> began_us_;
  std::size_t next_ = 0;
  std::map<std::size_t, TimeUs> again_;  // when each was due
  std::size_t unanswered_ = 0;
  double rate_ = kPlayRateMax, free_us_ = 0;  // the next one may be handed in from then on
  // Since the last time that the server pushed back.
  bool is_held_ = false;  // until all is answered and the pause is over
  std::uint64_t pushes_ = 0, accepted_ = 0;
  TimeUs pushed_us_ = 0;
};

}  // namespace runstone
