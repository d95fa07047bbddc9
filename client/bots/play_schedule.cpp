#include "client/bots/play_schedule.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr double kRateShare = 0.9;    // of the rate that the server accepted
constexpr double kRateMin = 1;        // edits a second
constexpr double kSlackUs = 50'000;   // a late caller catches up by this much
constexpr double kFarthestUs = 1e18;  // bounds a due time at any speed

}  // namespace

PlaySchedule::PlaySchedule(std::vector<TimeUs> offsets_us, double speed)
    : offsets_us_(std::move(offsets_us)), speed_(speed) {
  RUNSTONE_ASSERT(speed >= 0);
}

void PlaySchedule::begin(TimeUs now_us) {
  began_us_ = paused_us_ = now_us;
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
  std::size_t low = next_, high = offsets_us_.size();  // submitted edits were due
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

std::optional<PlaySchedule::DueEdit> PlaySchedule::next(TimeUs now_us) {
  if (!began_us_ || unanswered_ >= kPlayUnansweredMax) return std::nullopt;
  if (is_paused_) {
    if (unanswered_ != 0 || now_us - paused_us_ < kPlayPauseUs) return std::nullopt;
    is_paused_ = false;
    free_us_ = static_cast<double>(now_us);  // no catching up after a pause
  }
  const auto now = static_cast<double>(now_us);
  if (free_us_ > now) return std::nullopt;
  DueEdit due;
  if (!retries_.empty()) {
    due = {retries_.begin()->first, retries_.begin()->second};
    retries_.erase(retries_.begin());
  } else {
    if (next_ == offsets_us_.size()) return std::nullopt;
    due = {next_, due_of(next_, now_us)};
    if (due.due_us > now_us) return std::nullopt;
    ++next_;
  }
  free_us_ = std::max(free_us_, now - kSlackUs) + 1e6 / rate_;
  ++unanswered_;
  return due;
}

void PlaySchedule::accepted() {
  ++accepted_;
  dropped();
}

void PlaySchedule::dropped() {
  RUNSTONE_ASSERT(unanswered_ > 0);
  --unanswered_;
}

void PlaySchedule::retry(const DueEdit& due, TimeUs now_us) {
  dropped();
  retries_.emplace(due.index, due.due_us);
  if (is_paused_) return;  // sent before the pause began
  is_paused_ = true;
  // The first pause shows the burst that the server accepts. Later pauses show its lasting rate.
  if (++pauses_ > 1) {
    const double seconds = static_cast<double>(now_us - paused_us_) / 1e6;
    rate_ = std::clamp(kRateShare * static_cast<double>(accepted_) / seconds, kRateMin, rate_);
  }
  accepted_ = 0;
  paused_us_ = now_us;
}

}  // namespace runstone
