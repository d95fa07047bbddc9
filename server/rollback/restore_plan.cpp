#include "server/rollback/restore_plan.hpp"

#include <algorithm>
#include <utility>

#include "common/edits/apply/edit_changes.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/restore/voxel_restore.hpp"
#include "common/runs/reorder.hpp"
#include "server/rollback/chunk_past.hpp"
#include "server/rollback/few_voxels.hpp"
#include "server/rollback/log_restore.hpp"
#include "server/store/read_span.hpp"

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
  // Stored form and log are read at one moment: retention moves edits from one to the other.
  if (const auto begun = reader_.begin_reads(); !begun) return failure(begun.error());
  auto made = [&]() -> StoreResult<RestorePlan> {
    auto stored = stored_form(reader_, key, selected.front() - 1);
    if (!stored) return failure(stored.error());
    return plan_from(*std::move(stored), {key, selected}, box, end);
  }();
  if (const auto ended = reader_.end_reads(); !ended && made) return failure(ended.error());
  return made;
}

void RestorePlanner::in_batches(
    std::span<const Item> items, Sequence end,
    const std::function<bool(const Item&, StoreResult<StoredForm>)>& each) {
  std::size_t batch_max = kBatchChunks;
  while (!items.empty()) {
    const auto batch = items.first(std::min(items.size(), batch_max));
    std::vector<StoreResult<StoredForm>> stored;
    stored.reserve(batch.size());
    std::vector<ChunkLogs::Need> needs;
    const auto head = reader_.log_head();
    {
      ReadSpan reads(reader_);
      for (const Item& item : batch) {
        if (should_continue_ && !should_continue_()) {
          each(batch.front(), cancelled(reader_));
          return;
        }
        if (const auto begun = reads.next(); !begun) {
          stored.push_back(failure(begun.error()));
          continue;
        }
        stored.push_back(stored_form(reader_, item.key, item.selected.front() - 1));
        if (!stored.back()) continue;
        const StoredForm& form = *stored.back();
        needs.push_back({item.key, form ? form->version.seq + 1 : 1});
      }
    }
    const auto read = logs_.read_ahead(needs, end);
    // Retention may have moved edits from the log into the base meanwhile.
    const auto head_now = reader_.log_head();
    if (head && head_now && *head != *head_now) continue;
    if (read && !*read && batch.size() > 1) {
      batch_max = batch.size() / 2;
      continue;
    }
    if (read && !*read) {
      if (!one_at_one_moment(batch.front(), each)) return;
      items = items.subspan(1);
      continue;
    }
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const bool goes_on = each(
          batch[i], read ? std::move(stored[i]) : StoreResult<StoredForm>(failure(read.error())));
      if (!goes_on) return;
    }
    items = items.subspan(batch.size());
  }
}

bool RestorePlanner::one_at_one_moment(
    const Item& item, const std::function<bool(const Item&, StoreResult<StoredForm>)>& each) {
  if (const auto begun = reader_.begin_reads(); !begun) return each(item, failure(begun.error()));
  const bool goes_on = each(item, stored_form(reader_, item.key, item.selected.front() - 1));
  // If the transaction cannot be ended, the next read fails.
  static_cast<void>(reader_.end_reads());
  return goes_on;
}

void RestorePlanner::plan_all(std::span<const Item> items, const std::optional<VoxelBox>& box,
                              Sequence end, const EachPlan& each) {
  in_batches(items, end, [&](const Item& item, StoreResult<StoredForm> stored) {
    if (!stored) return each(item.key, failure(stored.error()));
    return each(item.key, plan_from(*std::move(stored), item, box, end));
  });
}

void RestorePlanner::count_all(std::span<const Item> items, const std::optional<VoxelBox>& box,
                               Sequence end, const EachCount& each) {
  in_batches(items, end, [&](const Item& item, StoreResult<StoredForm> stored) {
    if (!stored) return each(item.key, failure(stored.error()));
    return each(item.key, count_from(*std::move(stored), item, box, end));
  });
}

StoreResult<std::uint64_t> RestorePlanner::count_from(StoredForm stored, const Item& item,
                                                      const std::optional<VoxelBox>& box,
                                                      Sequence end) {
  if (should_continue_ && !should_continue_()) return cancelled(reader_);
  const std::int32_t edge = reader_.meta().chunk_edge;
  const VoxelBox chunk = box_of(item.key.at, edge);
  const auto records = logs_.in_memory(item.key, stored ? stored->version.seq + 1 : 1, end);
  const VoxelBox inside_box = box ? intersect(*box, chunk) : chunk;
  auto voxels = records ? few_voxels(*records, item.selected, inside_box, edge) : std::nullopt;
  if (!voxels) {
    const auto plan = plan_from(std::move(stored), item, box, end);
    if (!plan) return failure(plan.error());
    return plan->voxels;
  }
  auto before = materials_of(*voxels, stored, generator_, item.key, edge);
  LogRestore<VoxelRestore> log(VoxelRestore(*std::move(voxels), std::move(before)), item.selected);
  for (const EditRecord* record : *records) log.add(*record, scratch_.apply);
  return log.restore().differences();
}

StoreResult<RestorePlan> RestorePlanner::plan_from(StoredForm stored, const Item& item,
                                                   const std::optional<VoxelBox>& box,
                                                   Sequence end) {
  if (should_continue_ && !should_continue_()) return cancelled(reader_);
  const auto& [key, selected] = item;
  const std::int32_t edge = reader_.meta().chunk_edge;
  const VoxelPos origin = origin_of(key.at, edge);
  // No digest is computed: the plan has none.
  Chunk start;
  if (stored) {
    start = *std::move(stored);
  } else {
    start.voxels = generator_.generate(origin, Extent::cube(static_cast<unsigned>(edge)));
  }
  start.voxels = in_cheapest_order(std::move(start.voxels));
  auto before = replayed_to(std::move(start), key, edge, logs_, selected.front() - 1, scratch_);
  if (!before) return failure(before.error());
  RestorePlan plan;
  plan.key = key;
  plan.version = before->version;
  LogRestore<ChunkRestore> log(ChunkRestore(std::move(before->voxels), origin), selected);
  const auto read = logs_.visit(key, selected.front(), end, [&](const EditRecord& record) {
    log.add(record, scratch_.apply);
    plan.version = record.version;
  });
  if (!read) return failure(read.error());
  plan.edits = log.edits();
  plan.subject = log.subject();
  log.restore().flush(scratch_.apply);
  plan.now = log.restore().now();
  plan.restored = log.restore().restored();
  append_differences(plan.now, plan.restored, plan.differences);
  const VoxelBox here = box_of(key.at, edge);
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
