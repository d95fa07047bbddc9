#include "server/world/request_handlers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "protocol/rules/edit_check.hpp"
#include "protocol/rules/edit_price.hpp"
#include "server/world/delivery.hpp"
#include "server/world/handover.hpp"
#include "server/world/quotas.hpp"
#include "server/world/rights_handlers.hpp"

namespace runstone {
namespace {

// Bytes that count as read for each chunk that a client requests: with the default
// `read_kib_per_second`, a session gets 4,096 chunks a second.
constexpr std::size_t kRequestedChunkBytes = 256;

bool is_within_reach(const WorldState& world, WorldSession& session, const EditDescriptor& edit,
                     const Clocks& now) {
  const WorldConfig& config = world.config;
  if (config.reach_max == 0) return true;
  const WorldPos& from = session.position.follow(session.pose.at, config.speed_max, now.steady_us);
  return within_reach(edit, from, config.reach_max);
}

/// Returns the reason for a rejection as busy, for the player. It is empty if it passes soon.
const char* why_busy(const WorldState& world, const EditDescriptor& edit, AuthorId author) {
  if (world.disk_is_full) return kDiskIsFull;
  if (is_memory_full(world)) return kMemoryIsFull;
  return world.authority.queue().has_room_for(edit, author)
             ? ""
             : "too many large edits of players wait";
}

}  // namespace

std::string fault_text(const Error& fault) {
  return std::string(fault.what) + " (at byte " + std::to_string(fault.offset) + ")";
}

void on_chunk_request(WorldState& world, SessionId session, const ChunkRequest& request,
                      const Clocks& now) {
  WorldSession& mine = *world.find(session);
  world.output.charge_reading(session, request.keys.size() * kRequestedChunkBytes);
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
  // An invalid descriptor touches nothing: it costs the least that an edit costs.
  const Payer payer = edit_payer(world, mine.key, mine.address);
  const std::uint64_t price =
      request.fault ? 1 : edit_price(request.edit, world.config.chunk_edge, payer.budget);
  std::optional<RejectReason> refusal;
  std::string detail;
  const bool has_room =
      world.accepts_edits && !world.disk_is_full && !is_memory_full(world) &&
      world.environment.log_has_room(world.authority.queue().size() + 1) &&
      (request.fault || world.authority.queue().has_room_for(request.edit, mine.author));
  // An edit that waits for its commit is answered by the commit.
  if (world.authority.queue().has(op)) return;
  if (world.authority.resolved().knows(op)) {
    refusal = world.authority.resolved().answer_to(op);
  } else if (request.action != 0 && request.action == mine.refused_action) {
    refusal = mine.refused_reason;
    detail = kActionRefused;
    world.authority.reject(op, *refusal);
  } else if (!has_room) {
    refusal = RejectReason::busy;
    world.authority.reject(op, *refusal);
  } else if (const auto unpaid = world.edit_ledger.charge(payer, price, now.steady_us)) {
    refusal = RejectReason::rate_limited;
    detail = fmt::format("the edit budget of your {} is used up: again in {:.1f} s", unpaid->whose,
                         static_cast<double>(unpaid->wait_us) / 1e6);
    world.authority.reject(op, *refusal);
  } else if (request.fault) {
    refusal = RejectReason::bad_edit;
    world.authority.reject(op, *refusal);
  } else if (!is_within_reach(world, mine, request.edit, now)) {
    refusal = RejectReason::out_of_reach;
    world.authority.reject(op, *refusal);
  } else if (const auto wrong = world.authority.check(request.edit)) {
    refusal = wrong;
    world.authority.reject(op, *refusal);
  } else if (auto why = edit_refusal(world, mine.key, request.edit)) {
    refusal = RejectReason::not_permitted;
    detail = *std::move(why);
    world.authority.reject(op, *refusal);
  } else {
    refusal = world.authority.submit(
        {op, Cause::player, request.submitted_us, request.edit, 0, request.action, now.steady_us});
  }
  if (!refusal) return count_edit(world, session);
  if (*refusal == RejectReason::bad_edit && request.fault) detail = fault_text(*request.fault);
  if (*refusal == RejectReason::busy && detail.empty())
    detail = why_busy(world, request.edit, mine.author);
  ++world.counters.edits_rejected;
  if (*refusal != RejectReason::already_resolved) {
    if (request.action != 0) {
      mine.refused_action = request.action;
      mine.refused_reason = *refusal;
    }
    // The details of other reasons have numbers that differ each time.
    const bool has_detail = *refusal == RejectReason::not_permitted;
    world.refusals.add(
        mine.key, std::string("edit: ") + (has_detail ? detail : to_string(*refusal)), now.utc_us);
  }
  // Edits that are offered again after a reconnection are no misuse.
  if (*refusal != RejectReason::already_resolved)
    world.output.charge_reading(session, kRejectionBytes);
  const bool maybe_applied = *refusal == RejectReason::already_resolved;
  const Sequence applied_by = maybe_applied ? world.authority.head() : 0;
  mine.awaits_durable = std::max(mine.awaits_durable, applied_by);
  send_reject(world, session, {request.client_seq, *refusal, std::move(detail), applied_by});
}

void on_move(WorldState& world, SessionId session, const Move& move, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.position.follow(mine.pose.at, world.config.speed_max, now.steady_us);
  if (mine.pose == move.pose) return;
  mine.pose = move.pose;
  mine.pose_changed = true;
}

void on_ping(WorldState& world, SessionId session, const Ping& ping, const Clocks& now) {
  send_or_skip(world, session, encode_message(Pong{ping.sent_us, now.steady_us}));
}

}  // namespace runstone
