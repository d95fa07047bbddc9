#include "server/world/ground/views.hpp"

#include <algorithm>
#include <utility>

namespace runstone {
namespace {

// A view is compared with each claim that waits, which takes some 3 ns. With the default
// `read_kib_per_second`, a session gets so many views that this takes a hundredth of a core.
constexpr std::size_t kClaimsPerByte = 8;

}  // namespace

bool Views::is_due(const Viewer& viewer, const Clocks& now) const {
  const ViewDue& due = viewer.view;
  return due.next &&
         (!due.applied_us || now.steady_us - *due.applied_us >= base_.config.view_interval_us);
}

void Views::apply(Viewer& viewer, const Clocks& now) {
  const SessionId id = viewer.id();
  ViewDue& due = viewer.view;
  // Chunks that wait for a load become wanted, so that the new view decides their order.
  for (const ChunkKey& key : loads_.cancel(id))
    base_.interest.set_state(id, key, ChunkInterest::wanted);
  std::vector<View> skipped = due.skipped;
  if (due.has_skipped_too_many) skipped.push_back({});  // it has no tiles
  std::size_t visited = 1 + tiles_.set_view(viewer, *due.next, skipped);
  const bool has_skipped = due.has_skipped_too_many || !due.skipped.empty();
  if (due.has_skipped_too_many) {
    visited += base_.interest.want_all_again(id);
  } else if (has_skipped) {
    visited += base_.interest.want_again_outside(id, due.skipped);
  }
  due.skipped.clear();
  due.has_skipped_too_many = false;
  const std::optional<View>& seen = base_.interest.find(id)->view();
  const bool same_chunks = seen && seen->same_chunks(*due.next);
  visited += base_.interest.set_view(id, *std::exchange(due.next, std::nullopt));
  chunks_left_ -= std::min(chunks_left_, visited);
  if (!same_chunks) {
    // The client may have dropped chunks of the past.
    if (viewer.sees_past()) viewer.past.view->sent.clear();
    viewer.ground.are_boxes_due = true;
  }
  if (!same_chunks || has_skipped) sending_.forget_unsent(viewer);
  viewer.chunks.is_view_complete = false;
  viewer.chunks.complete.reset();
  due.applied_us = now.steady_us;
  loads_.collect_released();
}

bool Views::on_view(Viewer& viewer, View view, const Clocks& now) {
  ViewDue& due = viewer.view;
  if (view.number <= due.number) {
    base_.sessions.close(viewer.session, GoodbyeReason::malformed_message,
                         "the numbers of views do not ascend");
    return false;
  }
  due.number = view.number;
  const std::uint8_t radius_max = base_.quotas.view_radius_max_of(viewer.session.key);
  view.radius_h = std::min(view.radius_h, radius_max);
  view.radius_v = std::min(view.radius_v, radius_max);
  tiles_.limit_levels(viewer.session, view);
  if (due.next && !due.next->same_chunks(view)) {
    // A client may drop chunks outside of any view that it sent, even one that never took effect
    // here. So chunks outside of a skipped view are sent again.
    if (due.skipped.size() < kSkippedViewsMax) {
      due.skipped.push_back(*due.next);
    } else {
      due.has_skipped_too_many = true;
    }
  }
  due.next = view;
  CacheClaims& claims = viewer.chunks.claims;
  base_.sessions.charge_reading(viewer.session, claims.count() / kClaimsPerByte);
  claims.keep(view);
  if (do_some_wait_ || chunks_left_ == 0 || !is_due(viewer, now)) return false;
  apply(viewer, now);
  return true;
}

void Views::apply_due(const Clocks& now) {
  chunks_left_ = base_.config.view_chunks_per_tick;
  std::vector<Viewer*> due = base_.open();
  std::erase_if(due, [&](const Viewer* viewer) { return !is_due(*viewer, now); });
  // Sessions behind the one served last come first, so that every session is served.
  std::ranges::rotate(due, std::ranges::upper_bound(due, applied_last_, {}, &Viewer::id));
  do_some_wait_ = false;
  for (Viewer* viewer : due) {
    if (chunks_left_ == 0) {
      do_some_wait_ = true;
      return;
    }
    applied_last_ = viewer->id();
    apply(*viewer, now);
    base_.deliveries.insert(viewer->id());
  }
}

}  // namespace runstone
