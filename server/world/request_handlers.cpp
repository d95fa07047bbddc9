#include "server/world/request_handlers.hpp"

#include <algorithm>
#include <string>

#include "protocol/rules/edit_check.hpp"
#include "server/world/delivery.hpp"

namespace runstone {
namespace {

/// Returns what is wrong with the descriptor, for the author of the client, or why the server is
/// busy, for the player.
std::string detail_of(const WorldState& world, RejectReason reason, const EditRequest& request) {
  if (reason == RejectReason::busy && world.disk_is_full) return kDiskIsFull;
  if (reason != RejectReason::bad_edit || !request.fault) return "";
  return std::string(request.fault->what) + " (at byte " + std::to_string(request.fault->offset) +
         ")";
}

}  // namespace

void on_chunk_request(WorldState& world, SessionId session, const ChunkRequest& request,
                      const Clocks& now) {
  WorldSession& mine = *world.find(session);
  for (const ChunkKey& key : request.keys) {
    mine.claims.drop(key);  // the client rejects its copy
    const auto state = world.interest.find(session)->state(key);
    const bool is_answered = state == ChunkInterest::subscribed ||
                             state == ChunkInterest::unavailable ||
                             state == ChunkInterest::history_sent;
    if (is_answered) {
      if (mine.history) mine.history->sent.erase(key);
      world.interest.set_state(session, key, ChunkInterest::wanted);
      ++world.counters.chunks_requested;
    }
  }
  deliver(world, session, now);
  collect_released(world);
}

void on_edit(WorldState& world, SessionId session, const EditRequest& request, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  const OperationId op{mine.author, mine.instance, request.client_seq};
  const double reach = world.config.reach_max;
  // An invalid descriptor touches nothing: it costs the least that an edit costs.
  const std::uint64_t cost = request.fault ? 1 : edit_tokens(request.edit, world.config.chunk_edge);
  const std::uint64_t tokens = std::min(cost, world.config.edit_burst);
  std::optional<RejectReason> refusal;
  if (world.authority.resolved().knows(op)) {
    refusal = world.authority.resolved().answer_to(op);
  } else if (!mine.edits.take(tokens, now.steady_us)) {
    refusal = RejectReason::rate_limited;
    world.authority.reject(op, *refusal);
  } else if (request.fault) {
    refusal = RejectReason::bad_edit;
    world.authority.reject(op, *refusal);
  } else if (reach > 0 && !within_reach(request.edit, mine.pose.at, reach)) {
    refusal = RejectReason::out_of_reach;
    world.authority.reject(op, *refusal);
  } else {
    const bool has_room = world.accepts_edits && !world.disk_is_full &&
                          world.environment.log_has_room(world.authority.queued() + 1);
    refusal = world.authority.submit({op, Cause::player, request.submitted_us, request.edit, 0},
                                     has_room);
  }
  if (!refusal) return;
  ++world.counters.edits_rejected;
  const bool maybe_applied = *refusal == RejectReason::already_resolved;
  const Sequence applied_by = maybe_applied ? world.authority.sequence_bound() : 0;
  mine.awaits_durable = std::max(mine.awaits_durable, applied_by);
  send_reject(world, session,
              {request.client_seq, *refusal, detail_of(world, *refusal, request), applied_by});
}

void on_move(WorldState& world, SessionId session, const Move& move) {
  WorldSession& mine = *world.find(session);
  if (mine.pose == move.pose) return;
  mine.pose = move.pose;
  mine.pose_changed = true;
}

void on_ping(WorldState& world, SessionId session, const Ping& ping, const Clocks& now) {
  send_or_skip(world, session, encode_message(Pong{ping.sent_us, now.steady_us}));
}

}  // namespace runstone
