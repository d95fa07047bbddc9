#include "client/bots/play_schedule.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr double kRateShare = 0.9;    // of what the server took
constexpr double kRateMin = 1;        // edits a second
constexpr double kSlackUs = 50'000;   // a caller that comes late catches up so much
constexpr double kFarthestUs = 1e18;  // a due time stays a number, at any speed

}  // namespace

PlaySchedule::PlaySchedule(std::vector<TimeUs> offsets_us, double speed)
    : offsets_us_(std::move(offsets_us)), speed_(speed) {
  RUNSTONE_ASSERT(speed >= 0);
}

void PlaySchedule::begin(TimeUs now_us) {
  began_us_ = pushed_us_ = now_us;
  free_us_ = static_cast<double>(now_us) - kSlackUs;
}

TimeUs PlaySchedule::due_of(std::size_t index, TimeUs now_us) const {
  if (speed_ == 0) return now_us;
  return *began_us_ + static_cast<TimeUs>(
                          std::min(static_cast<double>(offsets_us_[index]) / speed_, kFarthestUs));
}

std::uint64_t PlaySchedule::due(TimeUs now_us) const {
  if (!began_us_) return 0;
  if (speed_ == 0) return offsets_us_.size();
  std::size_t low = next_, high = offsets_us_.size();  // what was handed in was due
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (due_of(middle, now_us) <= now_us) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

std::optional<PlaySchedule::Turn> PlaySchedule::next(TimeUs now_us) {
  if (!began_us_ || unanswered_ >= kPlayUnansweredMax) return std::nullopt;
  if (is_held_) {
    if (unanswered_ != 0 || now_us - pushed_us_ < kPlayPauseUs) return std::nullopt;
    is_held_ = false;
    free_us_ = static_cast<double>(now_us);  // the pause is for the server: nothing to catch up
  }
  const auto now = static_cast<double>(now_us);
  if (free_us_ > now) return std::nullopt;
  Turn turn;
  if (!again_.empty()) {
    turn = {again_.begin()->first, again_.begin()->second};
    again_.erase(again_.begin());
  } else {
    if (next_ == offsets_us_.size()) return std::nullopt;
    turn = {next_, due_of(next_, now_us)};
    if (turn.due_us > now_us) return std::nullopt;
    ++next_;
  }
  free_us_ = std::max(free_us_, now - kSlackUs) + 1e6 / rate_;
  ++unanswered_;
  return turn;
}

void PlaySchedule::accepted() {
  ++accepted_;
  dropped();
}

void PlaySchedule::dropped() {
  RUNSTONE_ASSERT(unanswered_ > 0);
  --unanswered_;
}

void PlaySchedule::pushed_back(const Turn& turn, TimeUs now_us) {
  dropped();
  again_.emplace(turn.index, turn.due_us);
  if (is_held_) return;  // one of those that were on their way together
  is_held_ = true;
  // The first time tells how many the server takes at a stretch, only later ones how many it takes for long.
  if (++pushes_ > 1) {
    const double seconds = static_cast<double>(now_us - pushed_us_) / 1e6;
    rate_ = std::clamp(kRateShare * static_cast<double>(accepted_) / seconds, kRateMin, rate_);
  }
  accepted_ = 0;
  pushed_us_ = now_us;
}

}  // namespace runstone
