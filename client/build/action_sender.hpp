// ActionSender: sends one action of any size. It takes the edits of a source as there is room in the
// window and in the player's budget, keeps those that are under way until they are answered, and
// counts. A lost connection delays it: the session offers again what has no answer, by the operation
// ids, and the sender goes on.
//
//   - The first edit names the action, so the second is sent when the first was applied. If the first
//     is refused, the next one begins the action.
//   - A refused edit is skipped and counted, unless OnRefusal::stop: then the action ends, because
//     its later edits need the refused one. Skipping ends after kRefusedInRowMax refusals in a row,
//     and where no edit of the player can be accepted (bad_edit, unknown_material).
//   - Edits that are refused for a while (busy, rate_limited) are offered again, as new edits.
//   - If the server does not know the action any more (unknown_action), the rest is another action.
//   - cancel() sends nothing more. The action ends when what is under way is answered. The player may
//     then undo what was done.
// Bounds: the edits of the window, and those that were refused for a while.
// Pure: times are arguments, in microseconds of one steady clock. One thread.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "client/build/action_progress.hpp"
#include "client/build/edit_port.hpp"
#include "client/build/edit_source.hpp"
#include "client/replica/replica_changes.hpp"

namespace runstone {

/// The effect of the refusal of one edit on the other edits of its action.
enum class OnRefusal : std::uint8_t {
  skip,  // they go on
  stop,  // they need it: nothing more is sent
};

class ActionSender {
 public:
  /// Refused edits in a row, with none that is applied between them, after which the action stops.
  static constexpr std::size_t kRefusedInRowMax = 64;
  /// The time from a refusal that passes to the next attempt.
  static constexpr TimeUs kAgainUs = 1'000'000;

  enum class State : std::uint8_t {
    sending,    // there is more to send, or it waits
    finishing,  // all was sent, or nothing more will be: some edits have no answer
    done,       // the source has ended, and every edit was answered
    stopped,    // it ended before its source: progress().stop_reason says why
  };

  ActionSender(std::unique_ptr<EditSource> source, OnRefusal on_refusal = OnRefusal::skip)
      : source_(std::move(source)), on_refusal_(on_refusal) {}

  /// Takes the rejects that the replica has reported. Call it for each drained ReplicaChanges, before
  /// step().
  void take(const ReplicaChanges& changes, TimeUs now_us) {
    for (const RejectedEdit& reject : changes.rejects) rejected(reject, now_us);
  }
  /// Takes a reject. It is ignored if the edit is none of this action.
  void rejected(const RejectedEdit& reject, TimeUs now_us);
  /// Takes up answers and offers what fits now, at most `edits_max` edits. Call it every turn.
  void step(EditPort& port, TimeUs now_us, std::size_t edits_max = 64);
  /// Sends nothing more. Does nothing if the action has ended.
  void cancel();

  State state() const { return state_; }
  bool has_ended() const { return state_ == State::done || state_ == State::stopped; }
  const ActionProgress& progress() const { return progress_; }
  /// Returns the number of edits that were offered and are not answered.
  std::size_t under_way() const { return under_way_.size(); }
  /// Returns the client sequence of the first edit of the action, 0 if none was applied.
  ClientSequence action() const { return action_; }

 private:
  struct Sent {
    EditDescriptor edit;
    std::uint64_t voxels = 0;
    ClientSequence action = 0;
  };
  void take_answers(const EditPort& port);
  /// Returns the next edit to offer, which stays the next one until pop(), or null if there is none
  /// now.
  const EditDescriptor* next(TimeUs now_us);
  void pop();
  /// Returns false if nothing can be offered now.
  bool offer_next(EditPort& port, TimeUs now_us);
  void refused(std::uint64_t voxels, const std::string& why);
  void stop(std::string why);
  void end_if_answered();

  std::unique_ptr<EditSource> source_;
  const OnRefusal on_refusal_;
  State state_ = State::sending;
  std::optional<SourceStep> ahead_;  // taken from the source and not offered
  bool has_source_ended_ = false;
  bool has_stopped_ = false;  // nothing more is sent
  std::map<ClientSequence, Sent> under_way_;
  std::deque<EditDescriptor> again_;  // refused for a while, in their order
  TimeUs again_us_ = 0;
  ClientSequence action_ = 0;        // of an edit that was applied
  ClientSequence first_ = 0;         // under way, and begins the action if it is applied
  std::size_t edits_of_action_ = 0;  // offered under `action_`
  std::size_t refused_in_row_ = 0;
  ActionProgress progress_;
};

}  // namespace runstone
