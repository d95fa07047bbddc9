#include "server/world/time_travel.hpp"

#include <utility>

#include "server/world/delivery.hpp"

namespace runstone {
namespace {

/// Makes all chunks of the view wanted again, and cancels the session's loads and claims.
void want_all(WorldState& world, SessionId session) {
  for (const ChunkKey& key : world.loads.cancel(session)) {
    world.interest.set_state(session, key, ChunkInterest::wanted);
  }
  world.interest.want_again(session, {});
  world.find(session)->claims.clear();
  collect_released(world);
}

void open_next(WorldState& world, SessionId session) {
  WorldSession& mine = *world.find(session);
  if (!mine.next_history_request || mine.is_opening_history ||
      world.histories_opening >= kHistoriesOpeningMax)
    return;
  mine.is_opening_history = true;
  ++world.histories_opening;
  world.environment.open_history(session, *mine.next_history_request);
}

void return_to_live(WorldState& world, SessionId session, std::uint32_t request,
                    const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.history.reset();
  mine.history_start_due = ViewState{request, ViewPhase::begins, false, 0, 0, ""};
  mine.history_report_due.reset();
  want_all(world, session);
  deliver(world, session, now);
}

}  // namespace

void on_history_request(WorldState& world, SessionId session, const HistoryRequest& request,
                        const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (request.to == HistoryTarget::live) {
    mine.next_history_request.reset();  // ignores the answer to a request that is being opened
    return return_to_live(world, session, request.request, now);
  }
  mine.next_history_request = request;
  open_next(world, session);
}

void open_waiting_history(WorldState& world) {
  for (const auto& [id, session] : world.sessions) {
    if (world.histories_opening >= kHistoriesOpeningMax) return;
    if (session.next_history_request) open_next(world, id);
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
    return open_next(world, session);
  mine->next_history_request.reset();
  if (!opened) {
    const bool is_past = mine->history.has_value();
    mine->history_report_due =
        ViewState{request, ViewPhase::refused, is_past, is_past ? mine->history->seq : 0,
                     0,       opened.error()};
    return deliver(world, session, now);
  }
  HistoryView history;
  history.number = ++world.history_count;
  history.request = request;
  history.seq = opened->seq;
  if (mine->history) history.sent = std::move(mine->history->sent);
  mine->history = std::move(history);
  mine->history_report_due.reset();
  mine->history_start_due =
      ViewState{request, ViewPhase::begins, true, opened->seq, opened->utc_us, ""};
  want_all(world, session);
  deliver(world, session, now);
}

void deliver_history(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  HistoryView& history = *mine.history;
  while (history.loading < kHistoryChunksLoadingMax) {
    const auto key = world.interest.nearest_wanted(session);
    if (!key) break;
    world.interest.set_state(session, *key, ChunkInterest::loading_history);
    ++history.loading;
    world.environment.load_history_chunk(session, history.number, history.seq, *key);
  }
  if (history.loading != 0 || history.is_complete || world.interest.nearest_wanted(session)) return;
  history.is_complete = true;
  mine.history_report_due =
      ViewState{history.request, ViewPhase::complete, true, history.seq, 0, ""};
  deliver(world, session, now);
}

void on_history_chunk(WorldState& world, SessionId session, std::uint32_t view_number,
                      const ChunkKey& key, const ChunkPtr& chunk, const Clocks& now) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr || !mine->history || mine->history->number != view_number)
    return;  // an answer for an earlier view
  HistoryView& history = *mine->history;
  --history.loading;
  if (world.interest.find(session)->state(key) == ChunkInterest::loading_history) {
    const auto sent = history.sent.find(key);
    if (chunk != nullptr && sent != history.sent.end() && sent->second == chunk->version) {
      world.interest.set_state(session, key, ChunkInterest::history_sent);
    } else if (answer_chunk(world, session, key, chunk, ChunkInterest::history_sent, now) &&
               chunk != nullptr) {
      history.sent[key] = chunk->version;
    }
  }
  deliver(world, session, now);
}

void forget_sent(WorldSession& session) {
  if (!session.history) return;
  session.history->sent.clear();
  session.history->is_complete = false;
}

}  // namespace runstone
