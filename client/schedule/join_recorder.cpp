#include "client/schedule/join_recorder.hpp"

#include <algorithm>
#include <cmath>

namespace runstone {
namespace {

std::size_t chunk_count(const View& view) {
  std::size_t columns = 0;
  for (int x = -view.radius_h; x <= view.radius_h; ++x) {
    for (int z = -view.radius_h; z <= view.radius_h; ++z) {
      columns += x * x + z * z <= view.radius_h * view.radius_h ? 1 : 0;
    }
  }
  return columns * (2 * std::size_t{view.radius_v} + 1);
}

void count(JoinedPart& part, TimeUs since_us) {
  ++part.done;
  if (!part.first_us) part.first_us = since_us;
  const auto most =
      static_cast<std::size_t>(std::ceil(kJoinMost * static_cast<double>(part.chunks)));
  if (part.done == most) part.most_us = since_us;
  if (part.done == part.chunks) part.all_us = since_us;
}

}  // namespace

void JoinRecorder::begin(const View& view, TimeUs began_us) {
  if (view_) return;
  view_ = near_ = view;
  near_.radius_h = std::min(view.radius_h, kJoinNearRadius);
  near_.radius_v = std::min(view.radius_v, kJoinNearRadius);
  began_us_ = began_us;
  report_.view.chunks = chunk_count(view);
  report_.near.chunks = chunk_count(near_);
}

void JoinRecorder::done(const ChunkKey& key, TimeUs at_us) {
  if (!is_open() || key.lod != 0 || !view_->contains(key.at) || !seen_.insert(key.at).second)
    return;
  const TimeUs since_us = at_us - began_us_;
  count(report_.view, since_us);
  if (near_.contains(key.at)) count(report_.near, since_us);
  if (!is_open()) seen_.clear();
}

}  // namespace runstone
