#include "server/world/ground/time_travel.hpp"

#include <utility>

namespace runstone {

/// Makes all chunks of the view wanted again, and cancels the session's loads and claims.
void TimeTravel::want_all(Viewer& viewer) {
  for (const ChunkKey& key : loads_.cancel(viewer.id()))
    base_.interest.set_state(viewer.id(), key, ChunkInterest::wanted);
  base_.interest.want_all_again(viewer.id());
  viewer.chunks.claims.clear();
  loads_.collect_released();
}

/// Answers a request: the session sees another state of the world from here on.
void TimeTravel::begin_state(Viewer& viewer, std::uint32_t request, const Clocks& now) {
  viewer.past.request = request;
  ChunksDue& due = viewer.chunks;
  due.begins = sending_.view_state(viewer, ViewPhase::begins);
  due.refused.reset();
  due.complete.reset();
  due.is_view_complete = due.begins->view == 0;
  want_all(viewer);
  tiles_.move_in_time(viewer, now);
}

void TimeTravel::refuse(Viewer& viewer, std::uint32_t request, std::string why) {
  viewer.past.request = request;
  viewer.chunks.refused = sending_.view_state(viewer, ViewPhase::refused);
  viewer.chunks.refused->text = std::move(why);
}

bool TimeTravel::open_next(Viewer& viewer, const Clocks& now) {
  PastSeen& past = viewer.past;
  if (!past.next || past.is_opening || now.steady_us < past.due_us || !can_open()) return false;
  past.due_us = now.steady_us + base_.config.view_interval_us;
  if (past.next->to == HistoryTarget::live) {
    const std::uint32_t request = past.next->request;
    past.next.reset();
    past.view.reset();
    begin_state(viewer, request, now);
    return true;
  }
  if (!base_.rights.decide(viewer.session.key, Right::look_back).is_allowed) {
    const std::uint32_t request = past.next->request;
    past.next.reset();
    refuse(viewer, request, "your role does not allow to see the past");
    return true;
  }
  past.is_opening = true;
  ++opening_;
  base_.environment.open_history(viewer.id(), *past.next);
  return false;
}

bool TimeTravel::on_request(Viewer& viewer, const HistoryRequest& request, const Clocks& now) {
  viewer.past.next = request;
  return open_next(viewer, now);
}

bool TimeTravel::opened(Viewer& viewer, std::uint32_t request,
                        const Result<OpenedHistory, std::string>& opened, const Clocks& now) {
  PastSeen& past = viewer.past;
  past.is_opening = false;
  // A newer request has replaced this one.
  if (!past.next || past.next->request != request) return open_next(viewer, now);
  past.next.reset();
  if (!opened) {
    refuse(viewer, request, opened.error());
    return true;
  }
  HistoryView view;
  view.number = HistoryNumber{++count_};
  view.seq = opened->seq;
  view.utc_us = opened->utc_us;
  if (past.view) view.sent = std::move(past.view->sent);
  past.view = std::move(view);
  begin_state(viewer, request, now);
  return true;
}

void TimeTravel::load_chunks(Viewer& viewer, const Clocks& now) {
  HistoryView& view = *viewer.past.view;
  while (view.loading < kHistoryChunksLoadingMax) {
    const auto key = base_.interest.nearest_wanted(viewer.id());
    if (!key) break;
    if (!base_.quotas.pay_load(viewer.session, now)) {
      viewer.chunks.stalled_us = now.steady_us;
      break;
    }
    base_.interest.set_state(viewer.id(), *key, ChunkInterest::loading_history);
    ++view.loading;
    base_.environment.load_history_chunk(viewer.id(), view.number, view.seq, *key);
  }
}

bool TimeTravel::chunk_made(Viewer& viewer, HistoryNumber number, const ChunkKey& key,
                            const ChunkPtr& chunk, const Clocks& now) {
  if (!viewer.sees_past() || viewer.past.view->number != number)
    return false;  // an answer for an earlier history view
  HistoryView& view = *viewer.past.view;
  --view.loading;
  if (base_.interest.find(viewer.id())->state(key) == ChunkInterest::loading_history) {
    const auto sent = view.sent.find(key);
    if (chunk != nullptr && sent != view.sent.end() && sent->second == chunk->version) {
      base_.interest.set_state(viewer.id(), key, ChunkInterest::history_sent);
    } else if (sending_.send_chunk(viewer, key, chunk, ChunkInterest::history_sent, now) &&
               chunk != nullptr) {
      view.sent[key] = chunk->version;
    }
  }
  return true;
}

}  // namespace runstone
