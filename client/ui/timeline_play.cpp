#include "client/ui/timeline_play.hpp"

#include <algorithm>

namespace runstone {

std::optional<Sequence> TimelinePlay::step(Sequence newest, Sequence shown, bool is_loading,
                                           double seconds, double log_seconds) {
  if (!at_) return std::nullopt;
  const auto end = static_cast<double>(newest);
  at_ = std::min(end, *at_ + seconds * end / log_seconds);
  if (is_loading) return std::nullopt;
  if (requested_ && *requested_ != shown) {
    stop();
    return std::nullopt;
  }
  const auto wanted = static_cast<Sequence>(*at_);
  if (wanted >= newest) {
    stop();
    return newest;
  }
  if (requested_ == wanted) return std::nullopt;
  requested_ = wanted;
  return wanted;
}

}  // namespace runstone
