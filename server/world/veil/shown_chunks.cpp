#include "server/world/veil/shown_chunks.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "common/core/assert.hpp"
#include "common/materials/veil_visibility.hpp"
#include "common/runs/layer_diff.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

/// Returns true if the edit must not be sent, because the true and the shown chunk may differ after
/// it, or because it has materials of voxels that are enclosed.
bool is_sent_as_result(const OrderedEdit& ordered) {
  return ordered.edit.mask.kind == MaskKind::only_material || ordered.cause == Cause::rollback ||
         ordered.cause == Cause::undo || ordered.cause == Cause::redo;
}

ChunkKey beside(const ChunkKey& key, Direction direction) {
  return {key.lod, neighbour(key.at, direction)};
}

/// Returns the version of a chunk that is made or uncovered when this record is the newest one. In a
/// world without records all versions are the base.
Version version_at(const Version& newest) { return newest.seq == 0 ? Version{} : newest; }

}  // namespace

ShownChunks::ShownChunks(const WorldChunks& chunks, std::int32_t edge,
                         const MaterialTable& materials)
    : chunks_(chunks), edge_(edge) {
  set_materials(materials);
}

bool ShownChunks::set_materials(const MaterialTable& materials) {
  std::vector<Visibility> visibilities = veil_visibilities(materials);
  // A world without a material that covers encloses no voxel, and needs no filler.
  const bool has_cover = std::ranges::find(visibilities, Visibility::opaque) != visibilities.end();
  VisibilityTable covers(visibilities);
  bool is_reshaped = false;
  if (covers_) {
    // A material of the table before covers as before, unless it got a shape.
    for (std::size_t id = 0; id < known_; ++id) {
      const auto material = static_cast<Material>(id);
      is_reshaped = is_reshaped || (*covers_)[material] != covers[material];
    }
  }
  known_ = visibilities.size();
  covers_.emplace(std::move(covers));
  filler_ = has_cover ? veil_filler(*covers_) : kEmpty;
  if (is_reshaped) drop_all();
  return is_reshaped;
}

ChunkPtr ShownChunks::find(const ChunkKey& key) {
  Entry* const entry = entries_.find(key);
  if (entry == nullptr) return nullptr;
  if (entry->sent == nullptr) {
    const Chunk& shown = *entry->shown;
    entry->sent = shown.voxels.order == kVeilOrder
                      ? entry->shown
                      : std::make_shared<const Chunk>(
                            Chunk{reorder(shown.voxels, kVeilOrder), shown.version, shown.digest});
  }
  return entry->sent;
}

ChunkPtr ShownChunks::make(const ChunkKey& key, const Version& newest) {
  if (entries_.contains(key)) return find(key);
  const ChunkPtr held = chunks_.find(key);
  if (held == nullptr) return nullptr;
  RUNSTONE_ASSERT(held->version.seq <= newest.seq);
  RunChunk veil = veil_of(held->voxels, neighbours(key, {}), {*covers_, filler_}, scratch_);
  const Digest digest = digest_of(veil);
  const Version version = version_at(newest);
  Entry& entry = entries_[key];
  ++count_;
  if (held->voxels.order == kVeilOrder) {
    set_shown(entry, {std::move(veil), version, digest});
  } else {
    set_shown(entry, {reorder(veil, held->voxels.order), version, digest});
    entry.sent = std::make_shared<const Chunk>(Chunk{std::move(veil), version, digest});
  }
  return find(key);
}

void ShownChunks::drop(const ChunkKey& key) {
  const Entry* const entry = entries_.find(key);
  if (entry == nullptr) return;
  bytes_ -= entry->shown->voxels.runs.byte_capacity();
  --count_;
  entries_.erase(key);
}

void ShownChunks::drop_all() {
  entries_ = {};
  count_ = bytes_ = 0;
}

void ShownChunks::set_shown(Entry& entry, Chunk chunk) {
  if (entry.shown != nullptr) bytes_ -= entry.shown->voxels.runs.byte_capacity();
  bytes_ += chunk.voxels.runs.byte_capacity();
  entry.shown = std::make_shared<const Chunk>(std::move(chunk));
  entry.sent = nullptr;
}

const RunChunk* ShownChunks::truth(const ChunkKey& key, const Between& between) const {
  if (const auto found = between.find(key); found != between.end())
    return found->second == nullptr ? nullptr : &found->second->voxels;
  const ChunkPtr published = chunks_.find(key);  // stays published during the call
  return published == nullptr ? nullptr : &published->voxels;
}

ShownChunks::Neighbours ShownChunks::neighbours(const ChunkKey& key, const Between& between) const {
  Neighbours out{};
  for (std::size_t d = 0; d < out.size(); ++d)
    out[d] = truth(beside(key, static_cast<Direction>(d)), between);
  return out;
}

bool ShownChunks::find_changes(const ChunkKey& key, const Entry& entry, SlowLayers layers,
                               const Between& between) {
  const RunChunk& voxels = *truth(key, between);
  const VeilBorders borders(voxels, neighbours(key, between), *covers_, MissingSide::closed,
                            layers);
  find_uncovered(voxels, borders, entry.shown->voxels, {*covers_, filler_}, layers, scratch_,
                 patch_);
  return !patch_.empty();
}

/// Applies patch_.
ShownPatch ShownChunks::apply_patch_of(const ChunkKey& key, Entry& entry, const Version& after) {
  Chunk next = *entry.shown;
  const Version before = next.version;
  apply_patch(patch_, next.voxels);
  next.version = after;
  next.digest = digest_of(next.voxels);
  set_shown(entry, std::move(next));
  return {key, before, after, in_order(patch_, kVeilOrder)};
}

std::vector<ShownEdit> ShownChunks::apply(const OrderedBatch& batch) {
  std::vector<ShownEdit> out(batch.commit.edits.size());
  if (count_ == 0) return out;
  // The true chunks that a shown chunk depends on, as they were before the commit.
  Between between;
  std::map<ChunkKey, std::size_t> edits_left;
  for (std::size_t i = 0; i < batch.all_touched.size(); ++i) {
    const ChunkKey& key = batch.all_touched[i];
    bool is_needed = entries_.contains(key);
    for (int d = 0; d < kDirectionCount && !is_needed; ++d)
      is_needed = entries_.contains(beside(key, static_cast<Direction>(d)));
    if (is_needed) between.emplace(key, batch.before[i]);
  }
  for (const std::vector<ChunkKey>& touched : batch.touched) {
    for (const ChunkKey& key : touched) {
      if (between.contains(key)) ++edits_left[key];
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const OrderedEdit& ordered = batch.commit.edits[i];
    const std::vector<ChunkKey>& touched = batch.touched[i];
    out[i] = apply_edit(ordered, {batch.commit.epoch, ordered.seq}, touched, between, edits_left);
  }
  return out;
}

ShownEdit ShownChunks::apply_edit(const OrderedEdit& ordered, const Version& version,
                                  const std::vector<ChunkKey>& touched, Between& between,
                                  std::map<ChunkKey, std::size_t>& edits_left) {
  ShownEdit out;
  // The edit of the true chunks.
  std::map<ChunkKey, DirtyLayers> dirty;
  std::set<ChunkKey> near;
  for (const ChunkKey& key : touched) {
    const auto found = between.find(key);
    if (found == between.end()) continue;
    ChunkPtr next = chunks_.find(key);
    if (--edits_left[key] > 0 && found->second != nullptr) {
      Chunk copy = *found->second;
      apply_stack(copy.voxels, copy.digest, origin_of(key.at, edge_), {&ordered.edit, 1}, apply_);
      next = std::make_shared<const Chunk>(std::move(copy));
    }
    const ChunkPtr before = std::exchange(found->second, next);
    if (before == nullptr || next == nullptr) continue;
    DirtyLayers changed = changed_layers(before->voxels, next->voxels);
    if (!changed.any()) continue;
    if (entries_.contains(key)) near.insert(key);
    for (int d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const ChunkKey other = beside(key, direction);
      if (border_dirty(changed, direction, static_cast<unsigned>(edge_)) &&
          entries_.contains(other))
        near.insert(other);
    }
    dirty.emplace(key, changed);
  }
  // The layers of the shown chunks that may need changes.
  std::vector<std::pair<ChunkKey, SlowLayers>> layers;
  for (const ChunkKey& key : near) {
    std::array<DirtyLayers, kDirectionCount> beyond;
    for (std::size_t d = 0; d < beyond.size(); ++d) {
      const auto found = dirty.find(beside(key, static_cast<Direction>(d)));
      if (found != dirty.end()) beyond[d] = found->second;
    }
    const auto own = dirty.find(key);
    const SlowLayers some = layers_beside(*truth(key, between),
                                          own == dirty.end() ? DirtyLayers{} : own->second, beyond);
    if (!some.empty()) layers.emplace_back(key, some);
  }
  const bool is_seen = std::ranges::any_of(layers, [&](const auto& each) {
    return find_changes(each.first, *entries_.find(each.first), each.second, between);
  });
  if (!is_seen) return out;
  out.form = is_sent_as_result(ordered) ? ShownForm::result : ShownForm::descriptor;
  if (out.form == ShownForm::descriptor) {
    for (std::size_t c = 0; c < touched.size(); ++c) {
      Entry* const entry = entries_.find(touched[c]);
      if (entry == nullptr) {
        out.previous.push_back(ordered.previous[c]);
        continue;
      }
      out.previous.push_back(entry->shown->version.seq);
      Chunk next = *entry->shown;
      apply_stack(next.voxels, next.digest, origin_of(touched[c].at, edge_), {&ordered.edit, 1},
                  apply_);
      next.version = version;
      set_shown(*entry, std::move(next));
    }
  }
  for (const auto& [key, some] : layers) {
    Entry& entry = *entries_.find(key);
    if (find_changes(key, entry, some, between))
      out.patches.push_back(apply_patch_of(key, entry, version));
  }
  return out;
}

std::vector<ShownPatch> ShownChunks::uncover_beside(const ChunkKey& arrived,
                                                    const Version& newest) {
  std::vector<ShownPatch> out;
  const ChunkPtr chunk = chunks_.find(arrived);
  if (chunk == nullptr) return out;
  const Version version = version_at(newest);
  for (int d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    const ChunkKey key = beside(arrived, direction);
    Entry* const entry = entries_.find(key);
    if (entry == nullptr) continue;
    // All voxels of the arrived chunk count as changed.
    std::array<DirtyLayers, kDirectionCount> beyond;
    beyond[static_cast<std::size_t>(opposite(direction))] = all_layers(chunk->voxels.extent);
    const SlowLayers layers = layers_beside(*truth(key, {}), {}, beyond);
    if (!find_changes(key, *entry, layers, {})) continue;
    out.push_back(apply_patch_of(key, *entry, version));
  }
  std::ranges::sort(out, {}, &ShownPatch::key);
  return out;
}

}  // namespace runstone
