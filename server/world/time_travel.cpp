#include "server/world/time_travel.hpp"

#include <utility>

#include "server/world/delivery.hpp"

namespace runstone {
namespace {

/// Everything in view is to be sent again; what was on its way is not wanted any more.
void want_all(WorldState& world, SessionId session) {
  for (const ChunkKey& key : world.loads.take_back(session)) {
    world.interest.set_state(session, key, ChunkInterest::wanted);
  }
  world.interest.want_again(session, {});
  world.find(session)->claims.clear();
  collect_released(world);
}

void open_next(WorldState& world, SessionId session) {
  WorldSession& mine = *world.find(session);
  if (!mine.next_travel || mine.opens_moment || world.moments_opening >= kMomentsOpeningMax) return;
  mine.opens_moment = true;
  ++world.moments_opening;
  world.ports.open_moment(session, *mine.next_travel);
}

void return_to_live(WorldState& world, SessionId session, std::uint32_t request,
                    const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.visit.reset();
  mine.begins_due = HistoryState{request, HistoryPhase::begins, false, 0, 0, ""};
  mine.word_due.reset();
  want_all(world, session);
  deliver(world, session, now);
}

}  // namespace

void on_history_request(WorldState& world, SessionId session, const HistoryRequest& travel,
                        const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (travel.to == HistoryTarget::live) {
    mine.next_travel.reset();  // a moment being opened is not wanted any more
    return return_to_live(world, session, travel.request, now);
  }
  mine.next_travel = travel;
  open_next(world, session);
}

void open_waiting_moments(WorldState& world) {
  for (const auto& [id, session] : world.sessions) {
    if (world.moments_opening >= kMomentsOpeningMax) return;
    if (session.next_travel) open_next(world, id);
  }
}

void on_moment_opened(WorldState& world, SessionId session, std::uint32_t request,
                      const Result<OpenedMoment, std::string>& opened, const Clocks& now) {
  --world.moments_opening;
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  mine->opens_moment = false;
  // Another wish came meanwhile: nobody waits for this one.
  if (!mine->next_travel || mine->next_travel->request != request) return open_next(world, session);
  mine->next_travel.reset();
  if (!opened) {
    const bool is_past = mine->visit.has_value();
    mine->word_due = HistoryState{
        request, HistoryPhase::refused, is_past, is_past ? mine->visit->seq : 0, 0, opened.error()};
    return deliver(world, session, now);
  }
  HistoryView visit;
  visit.number = ++world.visits;
  visit.request = request;
  visit.seq = opened->seq;
  if (mine->visit) visit.sent = std::move(mine->visit->sent);
  mine->visit = std::move(visit);
  mine->word_due.reset();
  mine->begins_due =
      HistoryState{request, HistoryPhase::begins, true, opened->seq, opened->utc_us, ""};
  want_all(world, session);
  deliver(world, session, now);
}

void deliver_past(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  HistoryView& visit = *mine.visit;
  while (visit.loading < kPastChunksLoadingMax) {
    const auto key = world.interest.nearest_wanted(session);
    if (!key) break;
    world.interest.set_state(session, *key, ChunkInterest::loading_history);
    ++visit.loading;
    world.ports.load_past_chunk(session, visit.number, visit.seq, *key);
  }
  if (visit.loading != 0 || visit.is_complete || world.interest.nearest_wanted(session)) return;
  visit.is_complete = true;
  mine.word_due = HistoryState{visit.request, HistoryPhase::complete, true, visit.seq, 0, ""};
  deliver(world, session, now);
}

void on_past_chunk(WorldState& world, SessionId session, std::uint32_t visit_number,
                   const ChunkKey& key, const ChunkPtr& chunk, const Clocks& now) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr || !mine->visit || mine->visit->number != visit_number) return;  // it went on
  HistoryView& visit = *mine->visit;
  --visit.loading;
  if (world.interest.find(session)->state(key) == ChunkInterest::loading_history) {
    const auto sent = visit.sent.find(key);
    if (chunk != nullptr && sent != visit.sent.end() && sent->second == chunk->version) {
      world.interest.set_state(session, key, ChunkInterest::recalled);
    } else if (answer_chunk(world, session, key, chunk, ChunkInterest::recalled, now) &&
               chunk != nullptr) {
      visit.sent[key] = chunk->version;
    }
  }
  deliver(world, session, now);
}

void forget_sent(WorldSession& session) {
  if (!session.visit) return;
  session.visit->sent.clear();
  session.visit->is_complete = false;
}

}  // namespace runstone
