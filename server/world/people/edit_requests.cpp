#include "server/world/people/edit_requests.hpp"

#include <fmt/format.h>

#include <utility>

#include "protocol/rules/edit_price.hpp"
#include "server/world/people/reach.hpp"

namespace runstone {
namespace {

// Bytes that count as read for each rejection, so that messages that gain nothing do not keep the
// world busy: with the default `read_kib_per_second`, a session gets some 220 rejections a second.
constexpr std::size_t kRejectionBytes = 4'096;
constexpr const char* kActionRefused = "an earlier edit of the same action was refused";

/// Describes what is wrong with a descriptor, for the author of the client.
std::string fault_text(const Error& fault) {
  return std::string(fault.what) + " (at byte " + std::to_string(fault.offset) + ")";
}

}  // namespace

std::optional<EditRequests::Refusal> EditRequests::check_action(const Attempt& attempt) {
  const ClientSequence action = attempt.request.action;
  const auto refused = refused_.find(attempt.session.id);
  if (action == 0 || refused == refused_.end() || refused->second.action != action)
    return std::nullopt;
  return Refusal{refused->second.reason, kActionRefused};
}

std::optional<EditRequests::Refusal> EditRequests::check_room(const Attempt& attempt) {
  const EditRequest& request = attempt.request;
  const bool has_room = order_.log_accepts() && !order_.is_disk_full() &&
                        !order_.is_memory_full() && order_.log_has_room() &&
                        (request.fault || order_.authority().queue().has_room_for(
                                              request.edit, attempt.session.author));
  if (has_room) return std::nullopt;
  return Refusal{RejectReason::busy};
}

std::optional<EditRequests::Refusal> EditRequests::check_budget(const Attempt& attempt) {
  // An invalid descriptor touches nothing: it costs the least that an edit costs.
  const std::uint64_t price =
      attempt.request.fault
          ? 1
          : edit_price(attempt.request.edit, config_.chunk_edge, attempt.payer.budget);
  const auto unpaid = quotas_.charge_edit(attempt.payer, price, attempt.now.steady_us);
  if (!unpaid) return std::nullopt;
  return Refusal{RejectReason::rate_limited,
                 fmt::format("the edit budget of your {} is used up: again in {:.1f} s",
                             unpaid->whose, static_cast<double>(unpaid->wait_us) / 1e6)};
}

std::optional<EditRequests::Refusal> EditRequests::check_bytes(const Attempt& attempt) {
  if (!attempt.request.fault) return std::nullopt;
  return Refusal{RejectReason::bad_edit};
}

std::optional<EditRequests::Refusal> EditRequests::check_reach(const Attempt& attempt) {
  if (is_within_reach(config_, attempt.session, attempt.request.edit, attempt.now))
    return std::nullopt;
  return Refusal{RejectReason::out_of_reach};
}

std::optional<EditRequests::Refusal> EditRequests::check_edit(const Attempt& attempt) {
  const auto wrong = order_.authority().check(attempt.request.edit);
  if (!wrong) return std::nullopt;
  return Refusal{*wrong};
}

std::optional<EditRequests::Refusal> EditRequests::check_rights(const Attempt& attempt) {
  auto why = rights_.edit_refusal(attempt.session.key, attempt.request.edit);
  if (!why) return std::nullopt;
  return Refusal{RejectReason::not_permitted, *std::move(why)};
}

std::optional<EditRequests::Refusal> EditRequests::check_and_enqueue(const Attempt& attempt) {
  Authority& authority = order_.authority();
  if (authority.resolved().knows(attempt.op))
    return Refusal{authority.resolved().answer_to(attempt.op)};
  constexpr Check kChecks[] = {
      &EditRequests::check_action, &EditRequests::check_room,  &EditRequests::check_budget,
      &EditRequests::check_bytes,  &EditRequests::check_reach, &EditRequests::check_edit,
      &EditRequests::check_rights,
  };
  for (const Check check : kChecks) {
    auto refusal = (this->*check)(attempt);
    if (!refusal) continue;
    authority.reject(attempt.op, refusal->reason);
    return refusal;
  }
  const EditRequest& request = attempt.request;
  const auto queued = authority.enqueue({attempt.op, Cause::player, request.submitted_us,
                                         request.edit, 0, request.action, attempt.now.steady_us});
  if (queued) return std::nullopt;
  return Refusal{queued.error()};
}

/// Returns the reason for a rejection as busy, for the player. It is empty if it passes soon.
const char* EditRequests::why_busy(const Attempt& attempt) const {
  if (order_.is_disk_full()) return kDiskIsFull;
  if (order_.is_memory_full()) return kMemoryIsFull;
  return order_.authority().queue().has_room_for(attempt.request.edit, attempt.session.author)
             ? ""
             : "too many large edits of players wait";
}

void EditRequests::refuse(const Attempt& attempt, Refusal refusal) {
  const EditRequest& request = attempt.request;
  Session& session = attempt.session;
  if (refusal.reason == RejectReason::bad_edit && request.fault)
    refusal.detail = fault_text(*request.fault);
  if (refusal.reason == RejectReason::busy && refusal.detail.empty())
    refusal.detail = why_busy(attempt);
  ++counters_.edits_rejected;
  // Edits that are offered again after a reconnection are no misuse.
  const bool maybe_applied = refusal.reason == RejectReason::already_resolved;
  if (!maybe_applied) {
    if (request.action != 0) refused_[session.id] = {request.action, refusal.reason};
    // The details of other reasons have numbers that differ each time.
    const bool has_detail = refusal.reason == RejectReason::not_permitted;
    rights_.note_refusal(
        session.key,
        std::string("edit: ") + (has_detail ? refusal.detail : to_string(refusal.reason)),
        attempt.now.utc_us);
    sessions_.charge_reading(session, kRejectionBytes);
  }
  const Sequence applied_by = maybe_applied ? order_.head() : 0;
  receipts_.expect_durable(session, applied_by);
  receipts_.reject(session,
                   {request.client_seq, refusal.reason, std::move(refusal.detail), applied_by});
}

bool EditRequests::on_edit(Session& session, const EditRequest& request, const Clocks& now) {
  const OperationId op{session.author, session.instance, request.client_seq};
  // An edit that waits for its commit is answered by the commit.
  if (order_.authority().queue().has(op)) return false;
  const Attempt attempt{session, request, op, quotas_.edit_payer(session.key, session.address),
                        now};
  auto refusal = check_and_enqueue(attempt);
  if (!refusal) return true;
  refuse(attempt, *std::move(refusal));
  return false;
}

bool EditRequests::reject_invalid(Session& session, const EditRequest& request) {
  const auto found = refused_.find(session.id);
  const bool is_refused =
      request.action != 0 && found != refused_.end() && found->second.action == request.action;
  if (!request.fault && !is_refused) return false;
  if (request.action != 0) refused_[session.id] = {request.action, RejectReason::bad_edit};
  sessions_.charge_reading(session, kRejectionBytes);
  receipts_.reject(session, {request.client_seq, RejectReason::bad_edit,
                             request.fault ? fault_text(*request.fault) : kActionRefused, 0});
  return true;
}

}  // namespace runstone
