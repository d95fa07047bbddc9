#include "server/rollback/restore_plan.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/edits/apply/edit_changes.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/rollback/chunk_past.hpp"

namespace runstone {
namespace {

/// Returns the parts of the differences that lie inside `spans`. Requires that the spans ascend and
/// are disjoint.
std::vector<Difference> inside(const std::vector<Difference>& all,
                               const std::vector<IndexSpan>& spans) {
  std::vector<Difference> out;
  auto span = spans.begin();
  for (const Difference& d : all) {
    while (span != spans.end() && span->last <= d.first) ++span;
    for (auto at = span; at != spans.end() && at->first < d.last; ++at) {
      out.push_back({std::max(d.first, at->first), std::min(d.last, at->last), d.now, d.restored});
    }
  }
  return out;
}

/// The points of a chunk before each rollback, and before each undo of one, so that an edit that
/// takes one back can return to it.
class RestorePoints {
 public:
  /// Returns the point to which the record returns, or null: its subject is no rollback whose point
  /// is kept.
  const RestorePoint* target_of(const EditRecord& record) const {
    const auto group = group_of_.find(record.subject);
    if (group == group_of_.end()) return nullptr;
    const auto point = points_.find(group->second);
    return point == points_.end() ? nullptr : &point->second;
  }
  /// Keeps the point before the record if it begins a rollback in this chunk, or an undo of one.
  void add(const EditRecord& record, ChunkRestore& restore, ApplyScratch& scratch) {
    const bool is_rollback = record.cause == Cause::rollback;
    const bool is_undo = record.cause == Cause::undo && group_of_.contains(record.subject);
    if (!is_rollback && !is_undo) return;
    const auto first =
        first_of_.try_emplace({record.op.author, record.op.instance}, record.version.seq);
    group_of_[record.version.seq] = first.first->second;
    if (!first.second) return;
    points_.emplace(record.version.seq, restore.point(scratch));
    if (points_.size() > kPointsMax) points_.erase(points_.begin());
  }

 private:
  // Of a chunk that was rolled back more often, the oldest rollbacks are edits like others.
  static constexpr std::size_t kPointsMax = 64;
  std::map<std::pair<AuthorId, ClientInstance>, Sequence> first_of_;  // in this chunk
  std::map<Sequence, Sequence> group_of_;                             // first edit, by edit
  std::map<Sequence, RestorePoint> points_;                           // by first edit
};

}  // namespace

StoreResult<RestorePlan> RestorePlanner::plan(const ChunkKey& key,
                                              std::span<const Sequence> selected,
                                              const std::optional<VoxelBox>& box, Sequence end) {
  auto stored = stored_form(reader_, generator_, key, selected.front() - 1);
  if (!stored) return failure(stored.error());
  return plan_from(*std::move(stored), {key, selected}, box, end);
}

void RestorePlanner::plan_all(std::span<const Item> items, const std::optional<VoxelBox>& box,
                              Sequence end, const EachPlan& each) {
  std::size_t batch_max = kBatchChunks;
  while (!items.empty()) {
    const auto batch = items.first(std::min(items.size(), batch_max));
    std::vector<StoreResult<Chunk>> stored;
    std::vector<ChunkLogs::Need> needs;
    for (const Item& item : batch) {
      if (should_continue_ && !should_continue_()) {
        each(batch.front().key, cancelled(reader_));
        return;
      }
      stored.push_back(stored_form(reader_, generator_, item.key, item.selected.front() - 1));
      if (stored.back()) needs.push_back({item.key, stored.back()->version.seq + 1});
    }
    const auto read = logs_.read_ahead(needs, end);
    if (read && !*read && batch.size() > 1) {
      batch_max = batch.size() / 2;
      continue;
    }
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (read && stored[i]) {
        if (!each(batch[i].key, plan_from(*std::move(stored[i]), batch[i], box, end))) return;
      } else {
        const StoreError& why = read ? stored[i].error() : read.error();
        if (!each(batch[i].key, failure(why))) return;
      }
    }
    items = items.subspan(batch.size());
  }
}

StoreResult<RestorePlan> RestorePlanner::plan_from(Chunk stored, const Item& item,
                                                   const std::optional<VoxelBox>& box,
                                                   Sequence end) {
  if (should_continue_ && !should_continue_()) return cancelled(reader_);
  const auto& [key, selected] = item;
  const std::int32_t edge = reader_.meta().chunk_edge;
  auto before = replayed_to(std::move(stored), key, edge, logs_, selected.front() - 1, scratch_);
  if (!before) return failure(before.error());
  const VoxelPos origin = origin_of(key.at, edge);
  RestorePlan plan;
  plan.key = key;
  plan.version = before->version;
  ChunkRestore restore(std::move(before->voxels), origin);
  const VoxelBox here = box_of(key.at, edge);
  RestorePoints points;
  auto next = selected.begin();
  const auto read = logs_.visit(key, selected.front(), end, [&](const EditRecord& record) {
    while (next != selected.end() && *next < record.version.seq) ++next;
    const bool is_selected = next != selected.end() && *next == record.version.seq;
    if (is_selected) {
      ++plan.edits;
      plan.subject = record.version.seq;
    }
    const RestorePoint* const target = is_selected ? nullptr : points.target_of(record);
    points.add(record, restore, scratch_.apply);
    if (target != nullptr) {
      restore.add_return(record.edit, *target, scratch_.apply);
    } else {
      restore.add(record.edit, is_selected, scratch_.apply);
    }
    plan.version = record.version;
  });
  if (!read) return failure(read.error());
  restore.flush(scratch_.apply);
  plan.now = restore.now();
  plan.restored = restore.restored();
  append_differences(plan.now, plan.restored, plan.differences);
  if (box && intersect(*box, here) != here && !plan.differences.empty()) {
    std::vector<IndexSpan> spans;
    append_spans({FillBox{intersect(*box, here)}, {}, kEmpty}, origin, plan.now.extent,
                 plan.now.order, spans);
    plan.differences = inside(plan.differences, spans);
    plan.restored = plan.now;
    std::vector<Change> changes;
    changes.reserve(plan.differences.size());
    for (const Difference& d : plan.differences) changes.push_back({d.first, d.last, d.restored});
    write_changes(plan.restored, changes, scratch_.apply);
  }
  for (const Difference& d : plan.differences) plan.voxels += d.last - d.first;
  return plan;
}

}  // namespace runstone
