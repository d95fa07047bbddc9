// LocalEdits: the edits of this client, from the click until they are known to be on disk. The
// server acknowledges an edit twice: by its commit, or by a reject, and by the durable watermark.
// Every client session uses this one state machine, whether it has a replica or not.
//
//   add --> pending --confirm--> confirmed --retire--> (removed, durable)
//                 |   --reject----> (removed, rejected)
//                 |   --reject "already resolved"--> unseen --retire--> (removed, unseen)
//                 |   --resume, at most the server's mark--> asking --> the transitions of pending
//   resume, above the server's mark: every state --> pending, and the edit is offered again
//
// An edit may be offered again at any time: its operation id makes sure that it is applied once.
// Client sequences are assigned here, from 1, without gaps. One thread.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Bound of the edits kept at a time. When it is reached, add() fails until the server catches
/// up.
inline constexpr std::size_t kLocalEditsMax = 16384;

enum class LocalEditState : std::uint8_t {
  /// The server has not answered. A replica predicts the edit.
  pending,
  /// The server has resolved the edit, but the answer was lost. It is sent again to get the answer.
  asking,
  /// Its commit arrived. The edit is kept until it is durable, in case the server loses it.
  confirmed,
  /// The server has resolved the edit, and its commit will not arrive.
  unseen,
};

/// The value of `action` for the first edit of a new action.
inline constexpr ClientSequence kBeginsAction = UINT64_MAX;

/// The place of an edit in an action, and who handles its rejection.
struct InAction {
  /// The first edit of the action, kBeginsAction, or 0: the edit is an action by itself.
  ClientSequence action = 0;
  /// The action goes on without the edit if the server rejects it.
  bool is_optional = false;
  /// An ActionSender has the edit, and offers it again if it is rejected for a while.
  bool has_sender = false;
  /// The rejected edit that this one repeats (LostEdits), or 0.
  ClientSequence again_of = 0;
  InAction(ClientSequence action_ = 0, bool is_optional_ = false, bool has_sender_ = false)
      : action(action_), is_optional(is_optional_), has_sender(has_sender_) {}
};

struct LocalEdit {
  static constexpr TimeUs kNever = INT64_MIN;

  EditDescriptor edit;
  ClientSequence action = 0;     // the first edit of its action; 0: it is an action by itself
  std::vector<ChunkKey> chunks;  // touched, in touched_chunks() order; empty without a replica
  TimeUs submitted_us = 0;       // this client's steady clock: the click, or the scheduled time
  TimeUs sent_us = kNever;       // last put on the wire
  LocalEditState state = LocalEditState::pending;
  bool is_optional = false, has_sender = false;  // as in InAction
  ClientSequence again_of = 0;                   // as in InAction
  Version version;                               // confirmed: of its commit; unseen: an upper bound

  bool needs_answer() const {
    return state == LocalEditState::pending || state == LocalEditState::asking;
  }
};

/// Counts since the object was made. An edit that is offered again may be confirmed again.
struct LocalEditCounters {
  std::uint64_t submitted = 0;
  std::uint64_t confirmed = 0;
  std::uint64_t rejected = 0;
  std::uint64_t durable = 0;
  std::uint64_t unseen = 0;
  std::uint64_t offered_again = 0;
};

class LocalEdits {
 public:
  using Map = std::map<ClientSequence, LocalEdit>;

  /// Adds a pending edit, which may begin an action (kBeginsAction). Fails if
  /// kLocalEditsMax edits are kept.
  Result<ClientSequence> add(const EditDescriptor& edit, std::vector<ChunkKey> chunks,
                             TimeUs submitted_us, InAction in_action = {});
  /// Notes that the edit was put on the wire. An edit that left already is ignored.
  void mark_sent(ClientSequence seq, TimeUs now_us);

  /// Takes the commit of an edit. Returns the state before, or nullopt if the edit is not kept.
  std::optional<LocalEditState> confirm(ClientSequence seq, const Version& version);

  struct Rejection {
    LocalEdit edit;            // as it was before the answer
    bool is_resolved = false;  // the server had resolved the edit before: it is unseen now
  };
  /// Takes a reject. "Already resolved" makes the edit unseen: it is durable once `reject.seq` is,
  /// or `newest` if the server does not know its sequence. Any other reason removes the edit.
  /// Returns nullopt, and changes nothing, if no edit of this sequence needs an answer.
  std::optional<Rejection> reject(const Reject& reject, const Version& newest);

  /// Starts a new connection: `resolved` is the highest client sequence that the server has
  /// resolved. The server lost the edits above it, even if their commits were seen. They become
  /// pending and are returned, ascending. Pending edits up to it become asking.
  std::vector<ClientSequence> resume(ClientSequence resolved);

  /// Edits that left because they are on disk, ascending.
  struct Retired {
    std::vector<ClientSequence> durable;  // their commits were seen
    std::vector<ClientSequence> unseen;   // the chunks show whether they were applied
  };
  /// Removes the edits that the server has resolved at or below the durable sequence.
  Retired retire(Sequence durable);
  void clear() {
    edits_.clear();
    bytes_ = 0;
    under_way_ = {};
  }
  /// The edits that were sent and have no answer, and the bytes that they count for
  /// (window_bytes()).
  struct UnderWay {
    std::size_t edits = 0, bytes = 0;
  };
  const UnderWay& under_way() const { return under_way_; }
  /// Returns the memory of the edits that are kept.
  std::size_t bytes() const { return bytes_; }

  const LocalEdit* find(ClientSequence seq) const;
  const Map& all() const { return edits_; }
  /// Returns the edits to send after a connection opened, ascending: those that need an answer.
  std::vector<ClientSequence> unanswered() const;
  /// Returns the edits that need an answer and were sent at `sent_us_max` or earlier, ascending.
  /// Ends at the first edit that was never sent or was sent later.
  std::vector<ClientSequence> overdue(TimeUs sent_us_max) const;
  std::size_t pending_count() const;
  const LocalEditCounters& counters() const { return counters_; }

 private:
  static std::size_t bytes_of(const LocalEdit& local);
  /// Sets when the edit was sent and its state, and counts it in under_way_.
  void set(LocalEdit& local, TimeUs sent_us, LocalEditState state);
  void count_under_way(const LocalEdit& local, bool is_added);
  Map::iterator erase(Map::iterator it);

  Map edits_;
  std::size_t bytes_ = 0;  // of edits_
  UnderWay under_way_;
  ClientSequence last_ = 0;
  LocalEditCounters counters_;
};

}  // namespace runstone
