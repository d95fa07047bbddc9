#include "server/world/time_travel.hpp"

#include <utility>

#include "server/world/delivery.hpp"
#include "server/world/past_tiles.hpp"
#include "server/world/quotas.hpp"
#include "server/world/rights_handlers.hpp"

namespace runstone {
namespace {

/// Makes all chunks of the view wanted again, and cancels the session's loads and claims.
void want_all(WorldState& world, SessionId session) {
  for (const ChunkKey& key : world.loads.cancel(session)) {
    world.interest.set_state(session, key, ChunkInterest::wanted);
  }
  world.interest.want_all_again(session);
  world.find(session)->claims.clear();
  collect_released(world);
}

/// Answers a request: the session sees another state of the world from here on.
void begin_state(WorldState& world, SessionId session, std::uint32_t request, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.history_request = request;
  mine.begins_due = view_state(world, session, ViewPhase::begins);
  mine.refused_due.reset();
  mine.complete_due.reset();
  mine.is_view_complete = mine.begins_due->view == 0;
  want_all(world, session);
  move_tiles_in_time(world, session, now);
  deliver(world, session, now);
}

void return_to_live(WorldState& world, SessionId session, std::uint32_t request,
                    const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.history.reset();
  begin_state(world, session, request, now);
}

void refuse_history(WorldState& world, SessionId session, std::uint32_t request, std::string why,
                    const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.history_request = request;
  mine.refused_due = view_state(world, session, ViewPhase::refused);
  mine.refused_due->text = std::move(why);
  deliver(world, session, now);
}

/// Carries out the session's newest request, unless it must wait: for the answer to the request
/// before, for a worker, or because every state makes the whole view wanted again and so costs as
/// much as a new view.
void open_next(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (!mine.next_history_request || mine.is_opening_history ||
      now.steady_us < mine.history_due_us || world.histories_opening >= kHistoriesOpeningMax)
    return;
  mine.history_due_us = now.steady_us + world.config.view_interval_us;
  if (mine.next_history_request->to == HistoryTarget::live) {
    const std::uint32_t request = mine.next_history_request->request;
    mine.next_history_request.reset();
    return return_to_live(world, session, request, now);
  }
  if (!decide(world, mine.key, Right::look_back).is_allowed) {
    const std::uint32_t request = mine.next_history_request->request;
    mine.next_history_request.reset();
    return refuse_history(world, session, request, "your role does not allow to see the past", now);
  }
  mine.is_opening_history = true;
  ++world.histories_opening;
  world.environment.open_history(session, *mine.next_history_request);
}

}  // namespace

void on_history_request(WorldState& world, SessionId session, const HistoryRequest& request,
                        const Clocks& now) {
  world.find(session)->next_history_request = request;
  open_next(world, session, now);
}

void open_waiting_history(WorldState& world, const Clocks& now) {
  for (const SessionId id : world.open_sessions()) {
    if (world.histories_opening >= kHistoriesOpeningMax) return;
    if (world.find(id) != nullptr) open_next(world, id, now);
  }
}

void on_history_opened(WorldState& world, SessionId session, std::uint32_t request,
                       const Result<OpenedHistory, std::string>& opened, const Clocks& now) {
  --world.histories_opening;
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  mine->is_opening_history = false;
  // A newer request has replaced this one.
  if (!mine->next_history_request || mine->next_history_request->request != request)
    return open_next(world, session, now);
  mine->next_history_request.reset();
  if (!opened) return refuse_history(world, session, request, opened.error(), now);
  HistoryView history;
  history.number = HistoryNumber{++world.history_count};
  history.seq = opened->seq;
  history.utc_us = opened->utc_us;
  if (mine->history) history.sent = std::move(mine->history->sent);
  mine->history = std::move(history);
  begin_state(world, session, request, now);
}

void deliver_history(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  HistoryView& history = *mine.history;
  while (history.loading < kHistoryChunksLoadingMax) {
    const auto key = world.interest.nearest_wanted(session);
    if (!key) break;
    if (!pay_load(world, mine, now)) {
      mine.stalled_us = now.steady_us;
      break;
    }
    world.interest.set_state(session, *key, ChunkInterest::loading_history);
    ++history.loading;
    world.environment.load_history_chunk(session, history.number, history.seq, *key);
  }
}

void on_history_chunk(WorldState& world, SessionId session, HistoryNumber number,
                      const ChunkKey& key, const ChunkPtr& chunk, const Clocks& now) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr || !mine->history || mine->history->number != number)
    return;  // an answer for an earlier history view
  HistoryView& history = *mine->history;
  --history.loading;
  if (world.interest.find(session)->state(key) == ChunkInterest::loading_history) {
    const auto sent = history.sent.find(key);
    if (chunk != nullptr && sent != history.sent.end() && sent->second == chunk->version) {
      world.interest.set_state(session, key, ChunkInterest::history_sent);
    } else if (send_chunk(world, session, key, chunk, ChunkInterest::history_sent, now) &&
               chunk != nullptr) {
      history.sent[key] = chunk->version;
    }
  }
  deliver(world, session, now);
}

void forget_sent(WorldSession& session) {
  if (session.history) session.history->sent.clear();
}

}  // namespace runstone
