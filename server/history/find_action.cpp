#include "server/history/find_action.hpp"

#include <optional>
#include <set>

namespace runstone {
namespace {

/// Returns true if the log has this operation of a player at `seq`, and it may begin an action.
StoreResult<bool> is_at(LogReader& reader, const OperationId& op, Sequence seq) {
  bool is_it = false;
  const auto read = reader.read_log(seq, seq, [&](const EditRecord& record) {
    is_it = record.op == op && record.cause == Cause::player && record.subject == 0;
    return true;
  });
  if (!read) return failure(read.error());
  return is_it;
}

}  // namespace

StoreResult<FoundAction> find_action(LogReader& reader, const OperationId& first_op) {
  std::set<Sequence> undone, redone;  // actions whose newest toggle is an undo or a redo
  std::set<Sequence> others;          // first edits of other actions of the instance
  for (Sequence last = kSequenceMax; last > 0;) {
    std::optional<LogRow> candidate;  // the first edit itself, or an edit that may be of its action
    const auto read = reader.rows_of_author(first_op.author, last, [&](const LogRow& row) {
      if (row.cause == Cause::undo && !redone.contains(row.subject)) undone.insert(row.subject);
      if (row.cause == Cause::redo && !undone.contains(row.subject)) redone.insert(row.subject);
      if (row.cause != Cause::player || row.op.instance != first_op.instance) return true;
      // The client sequences of an instance ascend in the log.
      if (row.op.seq < first_op.seq) return false;
      const bool is_first = row.op.seq == first_op.seq;
      if (is_first || (row.subject != 0 && !others.contains(row.subject))) candidate = row;
      return !candidate;
    });
    if (!read) return failure(read.error());
    if (!candidate) break;
    const Sequence first =
        candidate->op.seq == first_op.seq ? candidate->version.seq : candidate->subject;
    const auto is_it = is_at(reader, first_op, first);
    if (!is_it) return failure(is_it.error());
    if (*is_it) return FoundAction{first, undone.contains(first)};
    others.insert(first);
    last = candidate->version.seq - 1;
  }
  return FoundAction{};
}

}  // namespace runstone
