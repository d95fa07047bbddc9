// ShownChunks: the chunks that veiled sessions see. A shown chunk stands beside its true chunk and
// is shared by all veiled sessions (docs/veil.md). Invariants:
//   - A shown chunk exists only while its true chunk is in memory. Both have one axis order.
//   - Each of its voxels has its true material, or is enclosed in the true chunk and shows a material
//     that covers. The neighbours of the true chunk that are in memory count as they are, and the
//     others as closed.
//   - It begins as the veil of the true chunk. A voxel that has once shown its true material keeps
//     it, unless an edit changes it.
//   - The version is that of the newest record when the chunk was made, and moves to the version of
//     each edit that changes it, or touches it and is sent as a descriptor. So the versions of a
//     chunk that is dropped and made again never fall.
// Edits of a commit are applied one after another, because each of them is sent or hidden by itself.
//
// Thread: the world strand.
#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/chunk.hpp"
#include "common/veil/uncovered.hpp"
#include "server/interest/chunk_hash_map.hpp"
#include "server/world/order/authority.hpp"
#include "server/world/veil/shown_edit.hpp"

namespace runstone {

class ShownChunks {
 public:
  /// `chunks`: the true chunks. It must outlive the object.
  ShownChunks(const WorldChunks& chunks, std::int32_t edge, const MaterialTable& materials);

  /// Takes the materials of a table that continues the one before. If materials got shapes, all
  /// shown chunks are dropped, because some voxels are enclosed no longer. Returns true in this case.
  bool set_materials(const MaterialTable& materials);

  /// Returns the shown chunk as it is sent, in the axis order kVeilOrder: the order of the true chunk
  /// depends on hidden voxels. Returns null if there is none. Cost: that of reorder() at the first
  /// call after a change, if the orders differ.
  ChunkPtr find(const ChunkKey& key);
  bool has(const ChunkKey& key) const { return entries_.contains(key); }
  /// Returns find(), and makes the shown chunk first if there is none. `newest`: the last record of
  /// the log. Returns null if the true chunk is not in memory. Cost: that of veil_of().
  ChunkPtr make(const ChunkKey& key, const Version& newest);
  /// Forgets a shown chunk. Call it before its true chunk leaves memory.
  void drop(const ChunkKey& key);
  void drop_all();

  /// Applies a commit, whose true chunks are published, to the shown chunks. Returns what is sent of
  /// each of its edits. Cost: for each edit O(runs) of the chunks near it, and that of
  /// find_uncovered().
  std::vector<ShownEdit> apply(const OrderedBatch& batch);
  /// Uncovers what a true chunk that has just arrived in memory uncovers in its neighbours. The
  /// patches of each neighbour are to be sent.
  std::vector<ShownPatch> uncover_beside(const ChunkKey& arrived, const Version& newest);

  std::size_t count() const { return count_; }
  /// Returns the bytes of the runs of the shown chunks.
  std::size_t bytes() const { return bytes_; }

 private:
  struct Entry {
    ChunkPtr shown;  // in the axis order of the true chunk
    ChunkPtr sent;   // the same in kVeilOrder, or null until it is needed
  };
  using Neighbours = std::array<const RunChunk*, kDirectionCount>;
  /// The true chunks during a commit: those that its edits touch, between two of them.
  using Between = std::map<ChunkKey, ChunkPtr>;

  const RunChunk* truth(const ChunkKey& key, const Between& between) const;
  Neighbours neighbours(const ChunkKey& key, const Between& between) const;
  /// Applies one edit of a commit. `edits_left`: the edits of the commit that touch a chunk, this one
  /// and those behind it.
  ShownEdit apply_edit(const OrderedEdit& ordered, const Version& version,
                       const std::vector<ChunkKey>& touched, Between& between,
                       std::map<ChunkKey, std::size_t>& edits_left);
  /// Replaces patch_ by the changes that a shown chunk needs in these layers. Returns true if there
  /// are any.
  bool find_changes(const ChunkKey& key, const Entry& entry, SlowLayers layers,
                    const Between& between);
  void set_shown(Entry& entry, Chunk chunk);
  ShownPatch apply_patch_of(const ChunkKey& key, Entry& entry, const Version& after);

  const WorldChunks& chunks_;
  std::int32_t edge_;
  std::size_t known_ = 0;  // materials of the table
  std::optional<VisibilityTable> covers_;
  Material filler_ = kEmpty;
  ChunkHashMap<Entry> entries_;
  std::size_t count_ = 0, bytes_ = 0;
  VeilScratch scratch_;
  ApplyScratch apply_;
  VeilPatch patch_;
};

}  // namespace runstone
