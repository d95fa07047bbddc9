#include "client/tools/edit_preview.hpp"

#include <algorithm>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/run_builder.hpp"

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

/// The voxels in which two states of a chunk differ.
struct Difference {
  Difference(Extent extent, AxisOrder order) : placed(extent, order), removed(extent, order) {}
  template <class Before, class After>
  void read(const Before& before, const After& after) {
    std::size_t b = 0, a = 0;
    for (std::uint32_t first = 0; first < placed.volume;) {
      const Material was = before.material(b), is = after.material(a);
      const std::uint32_t was_end = before.end(b), is_end = after.end(a);
      const std::uint32_t last = std::min(was_end, is_end);
      if (was != is) (is == kEmpty ? removed : placed).add(first, last, is == kEmpty ? was : is);
      b += static_cast<std::size_t>(was_end == last);
      a += static_cast<std::size_t>(is_end == last);
      first = last;
    }
  }
  Stretches placed, removed;
};

}  // namespace

void EditPreview::set(std::vector<EditDescriptor> edits) {
  if (edits == edits_) return;
  edits_ = std::move(edits);
  is_restarted_ = true;
}

void EditPreview::set_visibility(const VisibilityTable& visibility) {
  visibility_ = visibility;
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

void EditPreview::begin(const Replica& replica) {
  is_restarted_ = false;
  edge_ = replica.chunk_edge();
  chunks_.clear();
  parts_.clear();
  made_.clear();
  made_placed_ = made_removed_ = 0;
  missing_ = 0;
  is_cut_ = false;
  next_ = 0;
  stage_ = Stage::compare;
  for (const EditDescriptor& edit : edits_) {
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
  RunChunk after = before;
  Digest digest;  // nobody compares it
  apply_stack(after, digest, origin_of(at, edge_), edits_, apply_, applied_);
  if (!applied_.changed) return;
  Difference difference(before.extent, before.order);
  before.runs.visit([&](const auto& was) {
    after.runs.visit([&](const auto& is) { difference.read(was, is); });
  });
  made_placed_ += difference.placed.voxels;
  made_removed_ += difference.removed.voxels;
  part.has_placed = difference.placed.voxels != 0;
  part.has_removed = difference.removed.voxels != 0;
  if (part.has_placed) part.placed = difference.placed.finish();
  if (part.has_removed) part.removed = difference.removed.finish();
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
  mesh_rdm(part.*runs, neighbours, visibility_, mesher_, *out);
  return out;
}

}  // namespace runstone
