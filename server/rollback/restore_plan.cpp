#include "server/rollback/restore_plan.hpp"

#include <algorithm>
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

}  // namespace

StoreResult<RestorePlan> RestorePlanner::plan(const ChunkKey& key,
                                              std::span<const Sequence> selected,
                                              const std::optional<VoxelBox>& box, Sequence end) {
  if (should_continue_ && !should_continue_()) return cancelled(reader_);
  auto before = chunk_past(reader_, generator_, logs_, key, selected.front() - 1, scratch_);
  if (!before) return failure(before.error());
  const std::int32_t edge = reader_.meta().chunk_edge;
  const VoxelPos origin = origin_of(key.at, edge);
  RestorePlan plan;
  plan.key = key;
  plan.version = before->version;
  ChunkRestore restore(std::move(before->voxels), origin);
  const VoxelBox here = box_of(key.at, edge);
  auto next = selected.begin();
  const auto read = logs_.visit(key, selected.front(), end, [&](const EditRecord& record) {
    while (next != selected.end() && *next < record.version.seq) ++next;
    const bool is_selected = next != selected.end() && *next == record.version.seq;
    if (is_selected) {
      ++plan.edits;
      plan.subject = record.version.seq;
    }
    restore.add(record.edit, is_selected, scratch_.apply);
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
