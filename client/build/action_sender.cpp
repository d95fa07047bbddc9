#include "client/build/action_sender.hpp"

#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/rules/refusal_text.hpp"

namespace runstone {

void ActionSender::take_answers(const EditPort& port) {
  for (auto sent = under_way_.begin(); sent != under_way_.end();) {
    if (!port.is_answered(sent->first)) {
      ++sent;
      continue;
    }
    ++progress_.edits_done;
    progress_.voxels_done += sent->second.voxels;
    refused_in_row_ = 0;
    if (sent->first == first_) action_ = std::exchange(first_, 0);
    sent = under_way_.erase(sent);
  }
}

void ActionSender::rejected(const RejectedEdit& reject, TimeUs now_us) {
  const auto found = under_way_.find(reject.seq);
  if (found == under_way_.end()) return;
  const Sent sent = std::move(found->second);
  under_way_.erase(found);
  if (reject.seq == first_) first_ = 0;
  progress_.now_us = now_us;
  const bool is_about_action =
      reject.reason == RejectReason::unknown_action || reject.detail == kActionRefused;
  switch (reject.reason) {
    case RejectReason::busy:
    case RejectReason::rate_limited:
    case RejectReason::unknown_action:
      break;
    case RejectReason::action_ended:
      return stop("you have undone it");
    case RejectReason::bad_edit:
    case RejectReason::unknown_material:
      refused(sent.voxels, reject.detail);
      return stop(std::string("the server does not take its edits (") + to_string(reject.reason) +
                  ")");
    default:
      if (is_about_action) break;
      return refused(sent.voxels, reject.detail.empty() ? to_string(reject.reason) : reject.detail);
  }
  // The rest of an action that the server does not know, or refuses, is another action.
  if (is_about_action && sent.action == action_) action_ = 0;
  if (!has_stopped_) again_.push_back(sent.edit);
  if (!is_about_action) again_us_ = now_us + kAgainUs;
  progress_.voxels_sent -= sent.voxels;
}

void ActionSender::refused(std::uint64_t voxels, const std::string& why) {
  ++progress_.edits_refused;
  progress_.voxels_refused += voxels;
  progress_.refusal = why;
  ++refused_in_row_;
  if (on_refusal_ == OnRefusal::stop) return stop("a part of it was refused: " + why);
  if (refused_in_row_ >= kRefusedInRowMax) {
    stop("the last " + std::to_string(kRefusedInRowMax) + " parts were refused: " + why);
  }
}

void ActionSender::stop(std::string why) {
  if (has_stopped_ || has_ended()) return;
  has_stopped_ = true;
  progress_.stop_reason = std::move(why);
  progress_.waits_for.clear();
  ahead_.reset();
  again_.clear();
}

void ActionSender::cancel() { stop("you have stopped it"); }

const EditDescriptor* ActionSender::next(TimeUs now_us) {
  if (!again_.empty()) {
    if (now_us >= again_us_) return &again_.front();
    progress_.waits_for = "the server is busy";
    return nullptr;
  }
  while (!has_stopped_ && !has_source_ended_) {
    if (!ahead_) ahead_ = source_->next();
    switch (ahead_->kind) {
      case SourceStep::Kind::edit:
        return &ahead_->edit;
      case SourceStep::Kind::wait:
        progress_.waits_for = std::move(ahead_->why);
        ahead_.reset();
        return nullptr;
      case SourceStep::Kind::barrier:
        if (!under_way_.empty()) return nullptr;
        ahead_.reset();
        if (progress_.edits_refused > 0)
          stop("a part of it was refused, and the rest needs that part: " + progress_.refusal);
        break;
      case SourceStep::Kind::failed:
        stop(std::string(ahead_->why));
        break;
      case SourceStep::Kind::end:
        ahead_.reset();
        has_source_ended_ = true;
        break;
    }
  }
  return nullptr;
}

void ActionSender::pop() {
  if (!again_.empty()) {
    again_.pop_front();
  } else {
    ahead_.reset();
  }
}

bool ActionSender::offer_next(EditPort& port, TimeUs now_us) {
  // The answer to the first edit decides whether it names the action.
  if (action_ == 0 && first_ != 0) return false;
  const EditDescriptor* const edit = next(now_us);
  if (edit == nullptr || !port.has_room(*edit)) return false;
  if (port.wait_us(*edit, now_us) > 0) {
    progress_.waits_for = "your edit budget";
    return false;
  }
  if (edits_of_action_ >= port.action_edits_max()) action_ = 0;
  const std::uint64_t voxels = counted_voxels(*edit);
  const InAction in_action(action_ != 0 ? action_ : kBeginsAction, true, true);
  const auto seq = port.offer(*edit, in_action, now_us);
  if (!progress_.began_us) progress_.began_us = now_us;
  progress_.now_us = now_us;
  progress_.voxels_sent += voxels;
  if (!seq) {
    pop();
    refused(voxels, seq.error());
    return !has_stopped_;
  }
  under_way_[*seq] = {*edit, voxels, action_ != 0 ? action_ : *seq};
  pop();
  if (action_ == 0) {
    first_ = *seq;
    edits_of_action_ = 0;
  }
  ++edits_of_action_;
  return true;
}

void ActionSender::step(EditPort& port, TimeUs now_us, std::size_t edits_max) {
  if (has_ended()) return;
  if (progress_.voxels == 0) progress_.voxels = source_->voxels();
  const std::uint64_t done_before = progress_.edits_done;
  take_answers(port);
  if (progress_.edits_done != done_before) progress_.now_us = now_us;
  progress_.waits_for = port.why_closed();
  if (progress_.waits_for.empty()) {
    while (edits_max > 0 && !has_stopped_ && offer_next(port, now_us)) --edits_max;
  }
  end_if_answered();
}

void ActionSender::end_if_answered() {
  const bool has_more = !has_stopped_ && (!has_source_ended_ || !again_.empty());
  if (has_more) return;
  state_ = State::finishing;
  if (!under_way_.empty()) return;
  state_ = has_stopped_ ? State::stopped : State::done;
  progress_.waits_for.clear();
}

}  // namespace runstone
