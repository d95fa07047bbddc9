#include "server/rollback/rollback_preview.hpp"

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "server/rollback/count_text.hpp"

namespace runstone {
namespace {

/// Returns a box as commands take it: both corners are inside.
std::string text_of_box(const VoxelBox& box) {
  return text_of(box.min) + " to " + text_of(VoxelPos{box.max.x - 1, box.max.y - 1, box.max.z - 1});
}

}  // namespace

void RollbackPreview::compute(WorldReader& reader, const Generator& generator,
                              const SelectionFilter& filter, Sequence end,
                              const PlanViewer& view_plan, const Summary& summarise) {
  const auto should_continue = [this] { return is_wanted->load(); };
  auto selected = select_edits(reader, filter, should_continue);
  if (!selected) {
    error = should_continue() ? selected.error().message() : "cancelled";
    return;
  }
  selection = std::make_shared<const Selection>(*std::move(selected));
  std::vector<RestorePlanner::Item> items;
  items.reserve(selection->chunks.size());
  for (const auto& [key, edits] : selection->chunks) items.push_back({key, edits});
  progress->edits.store(selection->edits);
  progress->chunks.store(items.size());
  RestorePlanner(reader, generator, should_continue)
      .plan_all(items, selection->box, end,
                [&](const ChunkKey&, const StoreResult<RestorePlan>& plan) {
                  if (!plan) {
                    error = should_continue() ? plan.error().message() : "cancelled";
                    return false;
                  }
                  ++progress->chunks_done;
                  voxels += plan->voxels;
                  chunks += plan->voxels > 0 ? 1 : 0;
                  if (view_plan && plan->voxels > 0) view_plan(*plan);
                  return true;
                });
  if (!error.empty()) return;
  if (summarise && voxels > 0) summary = summarise(reader, generator, id(), should_continue);
}

std::string RollbackPreview::progress_text() const {
  const std::uint64_t chunks_all = progress->chunks.load();
  if (chunks_all == 0) return "looking for the edits";
  return counted(progress->edits.load(), "edit") + ", " +
         std::to_string(progress->chunks_done.load()) + " of " + counted(chunks_all, "chunk");
}

std::string RollbackPreview::text_of_nothing() const {
  const std::string why = selection->edits == 0
                              ? "no edit matches"
                              : counted(selection->edits, "edit") +
                                    " match, but nothing of them is left: others have built there, "
                                    "or it was taken back before";
  return "rollback preview: nothing to do: " + why;
}

std::string RollbackPreview::text() const {
  const Selection& s = *selection;
  std::string text = "preview " + id() + ": would take back " + counted(s.edits, "edit") + " (" +
                     utc_text(s.first_us) + " to " + utc_text(s.last_us) +
                     "): " + counted(voxels, "voxel") + " in " + counted(chunks, "chunk") +
                     " would change\n";
  text += "area " + text_of_box(*s.area()) + "\n";
  if (!summary.empty()) text += summary + "\n";
  text += "nothing has changed yet: `rollback apply " + id() + "` does it, `rollback cancel " +
          id() + "` forgets it";
  return text;
}

}  // namespace runstone
