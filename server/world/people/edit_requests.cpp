#include "server/world/people/edit_requests.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/rules/edit_price.hpp"
#include "protocol/rules/refusal_text.hpp"
#include "server/world/environment/world_border.hpp"
#include "server/world/people/reach.hpp"

namespace runstone {
namespace {

// Bytes that count as read for each rejection, so that messages that gain nothing do not keep the
// world busy: with the default `read_kib_per_second`, a session gets some 220 rejections a second.
constexpr std::size_t kRejectionBytes = 4'096;
// A look-up of an action may read many rows of the log, so it counts as a large message.
constexpr std::size_t kLookupBytes = 64 * 1024;
constexpr TimeUs kLookupAgainUs = 1'000'000;
constexpr const char* kActionUnknown =
    "the log does not have the first edit of this action: begin another one";
constexpr const char* kWatermarkLost =
    "this world was repaired and does not know which of your edits it has: start your client again";
constexpr const char* kActionEnded = "you have undone this action: it takes no more edits";

/// Describes what is wrong with a descriptor, for the author of the client.
std::string fault_text(const Error& fault) {
  return std::string(fault.what) + " (at byte " + std::to_string(fault.offset) + ")";
}

}  // namespace

std::optional<EditRequests::Refusal> EditRequests::check_action(const Attempt& attempt) {
  const ClientSequence action = attempt.request.action;
  const auto refused = refused_.find(attempt.session.id);
  if (action != 0 && refused != refused_.end() && refused->second.action == action) {
    const bool is_unknown = refused->second.reason == RejectReason::unknown_action;
    return Refusal{refused->second.reason, is_unknown ? kActionUnknown : kActionRefused};
  }
  return attempt.is_patient() ? check_standing(attempt) : std::nullopt;
}

std::optional<EditRequests::Refusal> EditRequests::check_standing(const Attempt& attempt) {
  Authority& authority = order_.authority();
  const ClientSequence action = attempt.request.action;
  const OperationId first_op{attempt.op.author, attempt.op.instance, action};
  switch (authority.large_actions().find(first_op)) {
    case LargeActions::Standing::open:
      return std::nullopt;
    case LargeActions::Standing::ended:
      return Refusal{RejectReason::action_ended, kActionEnded};
    case LargeActions::Standing::unknown:
      break;
  }
  if (action == attempt.op.seq) return std::nullopt;  // it is the first edit
  // A watermark below the first edit shows that it was never ordered, and a rejection that is kept
  // shows it, too.
  if (!authority.resolved().knows(first_op) ||
      authority.resolved().answer_to(first_op) != RejectReason::already_resolved)
    return Refusal{RejectReason::unknown_action, kActionUnknown};
  const auto [lookup, is_new] = looked_up_.try_emplace(attempt.session.id, Lookup{first_op});
  if (is_new || attempt.now.steady_us >= lookup->second.again_us) {
    lookup->second = {first_op};
    environment_.find_action(first_op);
    sessions_.charge_reading(attempt.session, kLookupBytes);
  }
  return Refusal{RejectReason::busy, {}, true};
}

void EditRequests::action_found(const OperationId& first_op,
                                const std::optional<FoundAction>& found, const Clocks& now) {
  const bool is_known = found && found->first != 0;
  if (is_known)
    order_.authority().large_actions().remember(first_op, found->first, found->is_undone);
  for (auto lookup = looked_up_.begin(); lookup != looked_up_.end();) {
    if (lookup->second.first_op != first_op) {
      ++lookup;
    } else if (!found) {
      (lookup++)->second.again_us = now.steady_us + kLookupAgainUs;
    } else {
      if (!is_known) refused_[lookup->first] = {first_op.seq, RejectReason::unknown_action};
      lookup = looked_up_.erase(lookup);
    }
  }
}

std::optional<EditRequests::Refusal> EditRequests::check_room(const Attempt& attempt) {
  const EditRequest& request = attempt.request;
  const bool has_room = order_.log_accepts() && !order_.is_disk_full() &&
                        !order_.is_memory_full() && order_.log_has_room() &&
                        (request.fault || order_.authority().queue().has_room_for(
                                              request.edit, attempt.session.author));
  if (has_room) return std::nullopt;
  // A full disk may stay full for hours, and a stop ends with the session.
  const bool passes_soon = order_.log_accepts() && !order_.is_disk_full();
  return Refusal{RejectReason::busy, {}, attempt.is_patient() && passes_soon};
}

std::optional<EditRequests::Refusal> EditRequests::check_budget(const Attempt& attempt) {
  // An invalid descriptor touches nothing: it costs the least that an edit costs.
  const std::uint64_t price =
      attempt.request.fault
          ? 1
          : edit_price(attempt.request.edit, config_.chunk_edge, attempt.payer.budget);
  const auto unpaid = quotas_.charge_edit(attempt.payer, price, attempt.now.steady_us);
  if (!unpaid) return std::nullopt;
  if (attempt.is_patient()) return Refusal{RejectReason::rate_limited, {}, true};
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

std::optional<EditRequests::Refusal> EditRequests::check_border(const Attempt& attempt) {
  if (!config_.border || !has_voxels(attempt.request.edit)) return std::nullopt;
  if (is_within(*config_.border, bounding_box(attempt.request.edit))) return std::nullopt;
  return Refusal{RejectReason::outside_world, "the edit reaches beyond the border of this world: " +
                                                  border_text(*config_.border)};
}

std::optional<EditRequests::Refusal> EditRequests::check_edit(const Attempt& attempt) {
  const auto wrong = order_.authority().check(attempt.request.edit);
  if (!wrong) return std::nullopt;
  return Refusal{*wrong, refusal_words(*wrong, attempt.request.edit, order_.authority().limits())};
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
  // It is not resolved by this, so that the edits behind it are refused, too.
  if (authority.resolved().may_be_applied(attempt.op))
    return Refusal{RejectReason::not_permitted, kWatermarkLost};
  constexpr Check kChecks[] = {
      &EditRequests::check_action, &EditRequests::check_room,   &EditRequests::check_budget,
      &EditRequests::check_bytes,  &EditRequests::check_reach,  &EditRequests::check_edit,
      &EditRequests::check_border, &EditRequests::check_rights,
  };
  for (const Check check : kChecks) {
    auto refusal = (this->*check)(attempt);
    if (!refusal) continue;
    if (!refusal->is_to_wait) authority.reject(attempt.op, refusal->reason);
    return refusal;
  }
  const EditRequest& request = attempt.request;
  const auto queued =
      authority.enqueue({attempt.op, Cause::player, request.submitted_us, request.edit, 0,
                         request.action, attempt.now.steady_us, attempt.is_patient()});
  if (queued && attempt.is_patient() && request.action == attempt.op.seq)
    authority.large_actions().begin(attempt.op);
  if (queued) return std::nullopt;
  return Refusal{queued.error()};
}

/// Returns the reason for a rejection as busy, for the player. It is empty if it passes soon.
const char* EditRequests::why_busy(const Attempt& attempt) const {
  if (order_.is_disk_full()) return order_.disk_reason();
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
    const bool ends_action =
        request.action != 0 && !(request.is_optional && session.has(kFeatureLargeActions));
    if (ends_action) refused_[session.id] = {request.action, refusal.reason};
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

EditRequests::Verdict EditRequests::decide(Session& session, const EditRequest& request,
                                           const Clocks& now) {
  const OperationId op{session.author, session.instance, request.client_seq};
  const Attempt attempt{session, request, op, quotas_.edit_payer(session.key, session.address),
                        now};
  auto refusal = check_and_enqueue(attempt);
  if (!refusal) return Verdict::accepted;
  if (refusal->is_to_wait) return Verdict::waits;
  refuse(attempt, *std::move(refusal));
  return Verdict::rejected;
}

void EditRequests::keep_waiting(Session& session, const EditRequest& request) {
  if (waiting_.has_room_for(session.id, request)) return waiting_.push(session.id, request);
  sessions_.close(
      session, GoodbyeReason::flooding,
      fmt::format(
          "more than {} edits, or {} KiB of them, are under way: keep to waiting_edits_max of Welcome",
          kWaitingEditsMax, kWaitingEditBytesMax / 1024));
}

bool EditRequests::on_edit(Session& session, const EditRequest& request, const Clocks& now) {
  const OperationId op{session.author, session.instance, request.client_seq};
  // An edit that waits for its commit is answered by the commit.
  if (order_.authority().queue().has(op) || waiting_.has(session.id, op.seq)) return false;
  // Behind edits that wait, only an edit that is resolved already is answered at once.
  if (waiting_.has_any(session.id) && !order_.authority().resolved().knows(op)) {
    keep_waiting(session, request);
    return false;
  }
  const Verdict verdict = decide(session, request, now);
  if (verdict == Verdict::waits) keep_waiting(session, request);
  return verdict == Verdict::accepted;
}

void EditRequests::step(const Clocks& now, const std::function<void(Session&)>& on_accepted) {
  if (order_.is_following()) {
    waiting_.clear();
    looked_up_.clear();
  }
  std::vector<SessionId> ready = waiting_.sessions();
  std::size_t left = kEditsPerStep;
  while (!ready.empty()) {
    std::vector<SessionId> again;  // their next edits may go on, too
    for (const SessionId id : ready) {
      if (left == 0) return waiting_.begin_turn_at(id);
      Session* const session = sessions_.find(id);
      if (session == nullptr) {
        waiting_.forget(id);
        continue;
      }
      const Verdict verdict = decide(*session, waiting_.front(id), now);
      if (verdict == Verdict::waits) continue;
      --left;
      waiting_.pop(id);
      if (verdict == Verdict::accepted) on_accepted(*session);
      if (waiting_.has_any(id)) again.push_back(id);
    }
    ready = std::move(again);
  }
}

bool EditRequests::reject_invalid(Session& session, const EditRequest& request) {
  const auto found = refused_.find(session.id);
  const bool is_refused =
      request.action != 0 && found != refused_.end() && found->second.action == request.action;
  if (!request.fault && !is_refused) return false;
  const bool ends_action =
      request.action != 0 && !(request.is_optional && session.has(kFeatureLargeActions));
  if (ends_action) refused_[session.id] = {request.action, RejectReason::bad_edit};
  sessions_.charge_reading(session, kRejectionBytes);
  receipts_.reject(session, {request.client_seq, RejectReason::bad_edit,
                             request.fault ? fault_text(*request.fault) : kActionRefused, 0});
  return true;
}

}  // namespace runstone
