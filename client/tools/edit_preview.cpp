#include "client/tools/edit_preview.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "common/edits/apply/edit_changes.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/straight_paste.hpp"
#include "common/runs/run_builder.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {
namespace {

/// Some voxels of a chunk, and nothing elsewhere, in ascending order.
struct Stretches {
  Stretches(Extent extent, AxisOrder order) : runs(extent, order), volume(extent.volume()) {}
  void add(std::uint32_t first, std::uint32_t last, Material material) {
    runs.append_to(first, kEmpty);
    runs.append_to(last, material);
    voxels += last - first;
  }
  RunChunk finish() {
    runs.append_to(volume, kEmpty);
    return runs.finish();
  }
  RunBuilder runs;
  const std::uint32_t volume;
  std::uint64_t voxels = 0;
};

}  // namespace

void EditPreview::set(std::vector<EditDescriptor> edits) {
  if (edits == edits_) return;
  edits_ = std::move(edits);
  is_restarted_ = true;
}

void EditPreview::set_materials(MeshMaterialsPtr materials) {
  materials_ = std::move(materials);
  is_restarted_ = true;
}

bool EditPreview::step(const Replica& replica, std::size_t chunks_max) {
  if (is_restarted_ || is_outdated(replica)) begin(replica);
  if (stage_ == Stage::complete) return false;
  std::size_t left = chunks_max;
  for (; stage_ == Stage::compare && left > 0; --left) {
    if (next_ == chunks_.size()) {
      stage_ = Stage::mesh;
      next_ = 0;
      break;
    }
    compare(chunks_[next_], parts_[chunks_[next_]]);
    ++next_;
  }
  for (; stage_ == Stage::mesh && left > 0; --left) {
    if (next_ == chunks_.size()) {
      ghosts_ = std::exchange(made_, {});
      placed_ = made_placed_;
      removed_ = made_removed_;
      stage_ = Stage::complete;
      return true;
    }
    const ChunkCoord at = chunks_[next_++];
    GhostChunk ghost{{0, at},
                     edge_,
                     mesh(at, &Part::placed, &Part::has_placed),
                     mesh(at, &Part::removed, &Part::has_removed)};
    if (ghost.placed || ghost.removed) made_.push_back(std::move(ghost));
  }
  return false;
}

void EditPreview::straighten() {
  applied_ = edits_;
  for (EditDescriptor& edit : applied_) {
    const auto* const paste = std::get_if<Paste>(&edit.shape);
    if (paste == nullptr || paste->orientation == Orientation{}) continue;
    if (straight_.clipboard != paste->clipboard || straight_.orientation != paste->orientation) {
      straight_ = {paste->clipboard, paste->orientation,
                   straight_paste({{0, 0, 0}, paste->clipboard, paste->orientation})};
    }
    if (!straight_.straight) continue;
    Paste moved = *straight_.straight;
    moved.at = {moved.at.x + paste->at.x, moved.at.y + paste->at.y, moved.at.z + paste->at.z};
    edit.shape = std::move(moved);
  }
}

void EditPreview::begin(const Replica& replica) {
  if (std::exchange(is_restarted_, false)) straighten();
  edge_ = replica.chunk_edge();
  chunks_.clear();
  parts_.clear();
  made_.clear();
  made_placed_ = made_removed_ = 0;
  missing_ = 0;
  is_cut_ = false;
  next_ = 0;
  stage_ = Stage::compare;
  for (const EditDescriptor& edit : applied_) {
    is_cut_ = is_cut_ || touched_chunks_bound(edit, edge_) > kChunksMax;
    if (touched_chunks_bound(edit, edge_) > kTouchedChunksMax) continue;  // it will be refused
    const std::vector<ChunkCoord> touched = touched_chunks(edit, edge_);
    chunks_.insert(chunks_.end(), touched.begin(), touched.end());
  }
  std::sort(chunks_.begin(), chunks_.end());
  chunks_.erase(std::unique(chunks_.begin(), chunks_.end()), chunks_.end());
  is_cut_ = is_cut_ && chunks_.size() > kChunksMax;
  if (chunks_.size() > kChunksMax) chunks_.resize(kChunksMax);
  watch(replica);
  for (const ChunkCoord at : chunks_) {
    const ShownPtr& shown = watched_.at(at);
    if (!shown) ++missing_;
    parts_[at].shown = shown;
  }
}

void EditPreview::watch(const Replica& replica) {
  watched_.clear();
  const auto add = [&](ChunkCoord at) {
    const auto [it, is_new] = watched_.try_emplace(at);
    if (is_new) it->second = replica.shown({0, at});
  };
  for (const ChunkCoord at : chunks_) {
    add(at);
    for (int i = 0; i < kDirectionCount; ++i) add(neighbour(at, static_cast<Direction>(i)));
  }
}

bool EditPreview::is_outdated(const Replica& replica) const {
  if (edge_ != replica.chunk_edge()) return true;
  return std::any_of(watched_.begin(), watched_.end(), [&](const auto& entry) {
    return replica.shown({0, entry.first}) != entry.second;
  });
}

void EditPreview::compare(ChunkCoord at, Part& part) {
  if (!part.shown) return;
  const RunChunk& before = *part.shown;
  const std::span<const Change> changes =
      find_changes(before, origin_of(at, edge_), applied_, apply_);
  if (changes.empty()) return;
  Stretches placed(before.extent, before.order), removed(before.extent, before.order);
  before.runs.visit([&]<class Runs>(Runs runs) {
    RunCursor<Runs> cursor(runs);
    for (const Change& change : changes) {
      if (change.material != kEmpty) {
        placed.add(change.first, change.last, change.material);
        continue;
      }
      cursor.seek(change.first);
      for (VoxelIndex from = change.first; from < change.last;) {
        const VoxelIndex end = std::min(cursor.end(), change.last);
        removed.add(from, end, cursor.material());
        from = end;
        if (from < change.last) cursor.next();
      }
    }
  });
  made_placed_ += placed.voxels;
  made_removed_ += removed.voxels;
  part.has_placed = placed.voxels != 0;
  part.has_removed = removed.voxels != 0;
  if (part.has_placed) part.placed = placed.finish();
  if (part.has_removed) part.removed = removed.finish();
}

std::shared_ptr<const ChunkMesh> EditPreview::mesh(ChunkCoord at, RunChunk Part::* runs,
                                                   bool Part::* has) {
  const Part& part = parts_.at(at);
  if (!(part.*has)) return nullptr;
  MeshNeighbours neighbours{};
  for (int i = 0; i < kDirectionCount; ++i) {
    const auto it = parts_.find(neighbour(at, static_cast<Direction>(i)));
    if (it != parts_.end() && it->second.*has)
      neighbours[static_cast<std::size_t>(i)] = &(it->second.*runs);
  }
  auto out = std::make_shared<ChunkMesh>();
  mesh_chunk(part.*runs, neighbours, MeshBorders{}, *materials_, mesher_, *out);
  return out;
}

}  // namespace runstone
