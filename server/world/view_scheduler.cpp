#include "server/world/view_scheduler.hpp"

#include "server/world/time_travel.hpp"

#include <algorithm>
#include <utility>

#include "server/world/delivery.hpp"

namespace runstone {
namespace {

bool has_turn(const WorldState& world, const WorldSession& session, const Clocks& now) {
  return session.next_view && (!session.viewed_us ||
                               now.steady_us - *session.viewed_us >= world.config.view_interval_us);
}

void take_effect(WorldState& world, SessionId id, const Clocks& now) {
  WorldSession& mine = *world.find(id);
  // What waited for a load waits by its distance in the new view, if it is still seen at all.
  for (const ChunkKey& key : world.loads.take_back(id)) {
    world.interest.set_state(id, key, ChunkInterest::wanted);
  }
  if (mine.has_passed_too_many) {
    world.interest.want_again(id, {});
  } else if (!mine.passed_views.empty()) {
    world.interest.want_again(id, mine.passed_views);
  }
  mine.passed_views.clear();
  mine.has_passed_too_many = false;
  const std::optional<View>& seen = world.interest.find(id)->view();
  const bool only_turns = seen && seen->same_chunks(*mine.next_view);
  const std::size_t entered =
      world.interest.set_view(id, *std::exchange(mine.next_view, std::nullopt));
  world.view_chunks_left -= std::min(world.view_chunks_left, entered + 1);
  if (!only_turns) {
    forget_sent(mine);
    forget_unsent(world, id);
  }
  mine.viewed_us = now.steady_us;
  collect_released(world);
  deliver(world, id, now);
}

}  // namespace

void on_view(WorldState& world, SessionId session, View view, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  view.radius_h = std::min(view.radius_h, world.config.view_radius_max);
  view.radius_v = std::min(view.radius_v, world.config.view_radius_max);
  if (mine.next_view && !mine.next_view->same_chunks(view)) {
    // The client may have forgotten what lies outside of the view it leaves, so that has to be sent again.
    if (mine.passed_views.size() < kPassedViewsMax) {
      mine.passed_views.push_back(*mine.next_view);
    } else {
      mine.has_passed_too_many = true;
    }
  }
  mine.next_view = view;
  mine.claims.keep(view);
  if (!world.views_wait && world.view_chunks_left > 0 && has_turn(world, mine, now)) {
    take_effect(world, session, now);
  }
}

void give_view_turns(WorldState& world, const Clocks& now) {
  world.view_chunks_left = world.config.view_chunks_per_tick;
  std::vector<SessionId> turns;
  for (const auto& [id, session] : world.sessions) {
    if (has_turn(world, session, now)) turns.push_back(id);
  }
  // Those behind the last one served come first, so that nobody is passed over for ever.
  std::rotate(turns.begin(), std::upper_bound(turns.begin(), turns.end(), world.view_served),
              turns.end());
  world.views_wait = false;
  for (const SessionId id : turns) {
    if (world.view_chunks_left == 0) {
      world.views_wait = true;
      return;
    }
    world.view_served = id;
    take_effect(world, id, now);
  }
}

}  // namespace runstone
