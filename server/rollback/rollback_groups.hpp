// RollbackGroups: the rollbacks that the log holds. A rollback, and the undo of one, is a *group*: the edits of one
// author and client instance with one cause, with client sequences from kGroupBegins. Its id is the sequence of its
// first edit. A player's own undo and redo are no groups: their client sequences lie above. Blocks on the disk.
#pragma once
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
  Sequence taken_back_by =
      0;  // the newest group with cause undo that answers one of its edits; 0: none
};

/// The group whose id this is. bad_request if that edit begins none. O(edits with its cause since).
StoreResult<RollbackGroup> rollback_group(LogReader& reader, Sequence id);

/// The newest `count_max` groups with cause rollback, oldest first. O(edits with cause rollback or undo).
StoreResult<std::vector<RollbackGroup>> rollback_groups(LogReader& reader, std::size_t count_max);

}  // namespace runstone
