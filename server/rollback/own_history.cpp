#include "server/rollback/own_history.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "server/rollback/restore_plan.hpp"

namespace runstone {
namespace {

constexpr Sequence kFirstWindow = 4096;

}  // namespace

StoreResult<std::vector<OwnRecord>> own_records(Store& reader, AuthorId author, Sequence end) {
  // The index is read upward only, so the log is taken in windows from its end, each twice as wide as the one
  // before; one with too much in it is left for half of it.
  std::vector<OwnRecord> newest;
  std::size_t actions = 0;
  Sequence width = kFirstWindow;
  for (Sequence last = end; last > 0 && actions < kUndoActionsMax && newest.size() < kOwnRecordsMax;) {
    const Sequence first = last > width ? last - width + 1 : 1;
    LogQuery query;
    query.author = author;
    query.first = first;
    query.last = last;
    std::vector<OwnRecord> window;
    const auto read = reader.query_log(query, [&](const EditRecord& record) {
      window.push_back({record.version.seq, record.cause, record.subject});
      return window.size() <= kOwnRecordsMax;
    });
    if (!read) return Unexpected<StoreError>{read.error()};
    if (window.size() > kOwnRecordsMax && first < last) {
      width = (last - first + 1) / 2;
      continue;
    }
    for (const OwnRecord& record : window) actions += record.cause == Cause::player ? 1 : 0;
    newest.insert(newest.begin(), window.begin(), window.end());
    last = first - 1;
    width *= 2;
  }
  return newest;
}

StoreResult<std::optional<OwnChange>> next_own_change(Store& reader, const Generator& generator,
                                                      AuthorId author, Cause cause, Sequence end) {
  RUNSTONE_ASSERT(cause == Cause::undo || cause == Cause::redo);
  const auto records = own_records(reader, author, end);
  if (!records) return Unexpected<StoreError>{records.error()};
  const OwnActions actions(*records);
  const bool is_undo = cause == Cause::undo;
  std::vector<Sequence> candidates = is_undo ? actions.undoable() : actions.redoable();
  if (candidates.size() > kUndoActionsMax) candidates.resize(kUndoActionsMax);
  RestorePlanner planner(reader, generator);
  for (const Sequence action : candidates) {
    auto selection = is_undo ? select_edits(reader, actions.to_undo(action), actions.undo_core(action))
                             : select_edits(reader, actions.to_redo(action), actions.redo_core(action));
    if (!selection) return Unexpected<StoreError>{selection.error()};
    for (const auto& [key, edits] : selection->chunks) {
      const auto plan = planner.plan(key, edits, std::nullopt, end);
      if (!plan) return Unexpected<StoreError>{plan.error()};
      if (plan->voxels > 0) return std::optional(OwnChange{action, *std::move(selection)});
    }
  }
  return std::optional<OwnChange>();
}

}  // namespace runstone
