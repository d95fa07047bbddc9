#include "server/world/view_scheduler.hpp"

#include <algorithm>
#include <utility>

#include "server/world/delivery.hpp"
#include "server/world/protected_ground.hpp"
#include "server/world/quotas.hpp"
#include "server/world/tile_handlers.hpp"
#include "server/world/time_travel.hpp"

namespace runstone {
namespace {

bool is_due(const WorldState& world, const WorldSession& session, const Clocks& now) {
  return session.next_view &&
         (!session.view_applied_us ||
          now.steady_us - *session.view_applied_us >= world.config.view_interval_us);
}

void apply_view(WorldState& world, SessionId id, const Clocks& now) {
  WorldSession& mine = *world.find(id);
  // Chunks that wait for a load become wanted, so that the new view decides their order.
  for (const ChunkKey& key : world.loads.cancel(id)) {
    world.interest.set_state(id, key, ChunkInterest::wanted);
  }
  std::vector<View> skipped = mine.skipped_views;
  if (mine.has_skipped_too_many) skipped.push_back({});  // it has no tiles
  std::size_t visited = 1 + set_tile_view(world, id, *mine.next_view, skipped);
  const bool has_skipped = mine.has_skipped_too_many || !mine.skipped_views.empty();
  if (mine.has_skipped_too_many) {
    visited += world.interest.want_all_again(id);
  } else if (has_skipped) {
    visited += world.interest.want_again_outside(id, mine.skipped_views);
  }
  mine.skipped_views.clear();
  mine.has_skipped_too_many = false;
  const std::optional<View>& seen = world.interest.find(id)->view();
  const bool same_chunks = seen && seen->same_chunks(*mine.next_view);
  visited += world.interest.set_view(id, *std::exchange(mine.next_view, std::nullopt));
  world.view_chunks_left -= std::min(world.view_chunks_left, visited);
  if (!same_chunks) {
    forget_sent(mine);
    mark_ground(world, id);
  }
  if (!same_chunks || has_skipped) forget_unsent(world, id);
  mine.is_view_complete = false;
  mine.complete_due.reset();
  mine.view_applied_us = now.steady_us;
  collect_released(world);
}

}  // namespace

void on_view(WorldState& world, SessionId session, View view, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (view.number <= mine.view_number) {
    return close_session(world, session, GoodbyeReason::malformed_message,
                         "the numbers of views do not ascend");
  }
  mine.view_number = view.number;
  const std::uint8_t radius_max = view_radius_max_of(world, mine.key);
  view.radius_h = std::min(view.radius_h, radius_max);
  view.radius_v = std::min(view.radius_v, radius_max);
  limit_levels(world, mine, view);
  if (mine.next_view && !mine.next_view->same_chunks(view)) {
    // A client may drop chunks outside of any view that it sent, even one that never took effect
    // here. So chunks outside of a skipped view are sent again.
    if (mine.skipped_views.size() < kSkippedViewsMax) {
      mine.skipped_views.push_back(*mine.next_view);
    } else {
      mine.has_skipped_too_many = true;
    }
  }
  mine.next_view = view;
  mine.claims.keep(view);
  if (!world.views_wait && world.view_chunks_left > 0 && is_due(world, mine, now)) {
    apply_view(world, session, now);
    deliver(world, session, now);
  }
}

void apply_due_views(WorldState& world, const Clocks& now) {
  world.view_chunks_left = world.config.view_chunks_per_tick;
  std::vector<SessionId> due;
  for (const auto& [id, session] : world.sessions) {
    if (is_due(world, session, now)) due.push_back(id);
  }
  // Sessions behind the one served last come first, so that every session is served.
  std::rotate(due.begin(), std::upper_bound(due.begin(), due.end(), world.view_applied_last),
              due.end());
  world.views_wait = false;
  for (const SessionId id : due) {
    if (world.view_chunks_left == 0) {
      world.views_wait = true;
      return;
    }
    world.view_applied_last = id;
    apply_view(world, id, now);
    world.deliveries.insert(id);
  }
}

}  // namespace runstone
