// EditOutcomes: follows the edits of a WorldClient from submit() until they are durable, rejected
// or unseen, and makes their events. The number of an edit is its first client sequence. An edit
// that the session offers again, as a new one, keeps its number. Thread: one. Bound: the edits that
// LocalEdits and LostEdits keep.
#pragma once
#include <map>

#include "client/api/event_queue.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class EditOutcomes {
 public:
  /// Follows an edit that was offered.
  void add(ClientSequence seq) { open_.emplace(seq, Stage::waits); }
  /// Returns the number of edits without a final outcome.
  std::size_t count() const { return open_.size(); }
  /// Takes the changes of the edits. Call it after each tick of the session, before the next
  /// message is received. `changes` are those of the session's replica.
  void take(const ReplicaChanges& changes, const ClientSession& session, EventQueue& events);
  /// Ends all edits, because another world is open.
  void world_changed(EventQueue& events);

 private:
  enum class Stage : std::uint8_t { waits, is_lost, confirmed };
  EditNumber number_of(ClientSequence seq) const;
  void note_offers(const ClientSession& session, EventQueue& events);
  bool end(EditNumber edit, ClientSequence seq);

  std::map<EditNumber, Stage> open_;
  std::map<ClientSequence, EditNumber> again_;  // of edits that were offered again
  std::size_t lost_ = 0;                        // edits in the stage is_lost
};

}  // namespace runstone
