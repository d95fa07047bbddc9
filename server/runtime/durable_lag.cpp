#include "server/runtime/durable_lag.hpp"

namespace runstone {

void DurableLag::observe(Sequence head, Sequence durable, TimeUs now_us) {
  if (!has_begun_ || head < head_) {
    has_begun_ = true;
    head_ = head;
    marks_.clear();
  }
  if (head > head_) {
    if (marks_.size() >= kMarksMax) {
      marks_.back().last = head;
      marks_.back().edits += head - head_;
    } else {
      marks_.push_back({head, head - head_, now_us});
    }
    head_ = head;
  }
  while (!marks_.empty() && marks_.front().last <= durable) {
    waits_.add(now_us - marks_.front().ordered_us, marks_.front().edits);
    marks_.pop_front();
  }
}

TimeUs DurableLag::lag_us(TimeUs now_us) const {
  return marks_.empty() ? 0 : now_us - marks_.front().ordered_us;
}

}  // namespace runstone
