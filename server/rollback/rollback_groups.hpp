// RollbackGroups: the rollbacks that the log holds. A rollback, and the undo of one, is a *group*:
// the edits of one author and client instance with one cause, with client sequences from
// kGroupBegins. Its id is the sequence of its first edit. A player's undo or redo of an action is
// no group: its client sequences are greater. All functions block on the disk.
#pragma once
#include <optional>
#include <vector>

#include "server/store/log_reader.hpp"

namespace runstone {

/// The client sequence that begins a group.
inline constexpr ClientSequence kGroupBegins = 1;

struct RollbackGroup {
  Sequence id = 0;
  OperationId op;  // of its first edit
  Cause cause = Cause::rollback;
  TimeUs time_us = 0;           // of its first edit, UTC
  std::vector<Sequence> edits;  // ascending
  /// Of an undo: the group that has the subjects of its edits, or 0 if there is none.
  Sequence takes_back = 0;
  /// Of a rollback: the newest undo of it that no other undo has taken back, or 0 if there is none.
  Sequence taken_back_by = 0;
};

/// Returns the group with this id. Fails (bad_request) if that edit does not begin a group. Cost:
/// O(later edits with its cause).
StoreResult<RollbackGroup> rollback_group(LogReader& reader, Sequence id);

/// Returns the newest `count_max` groups with cause rollback, oldest first. With an author, only the
/// groups of this author count. Cost: O(edits with cause rollback or undo).
StoreResult<std::vector<RollbackGroup>> rollback_groups(LogReader& reader, std::size_t count_max,
                                                        std::optional<AuthorId> author);

}  // namespace runstone
