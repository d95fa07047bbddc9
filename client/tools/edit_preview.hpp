// EditPreview: the exact effect of edits that are not made yet, as ghosts that are drawn over the
// world. The changes to the shown runs are found by the search of apply_stack(), the function of
// the server, and are meshed. Work is divided over turns: step() does a bounded part, and the
// ghosts of the previous edits stay until all of the new ones are made. One thread. No clock.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "client/render/ghost.hpp"
#include "client/replica/replica.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/mesh/chunk_mesher.hpp"
#include "common/mesh/mesh_materials.hpp"

namespace runstone {

class EditPreview {
 public:
  /// The largest number of chunks in one preview. If the edits touch more, only the first ones are
  /// previewed.
  static constexpr std::size_t kChunksMax = 512;

  /// Shows these edits, in this order, from the next step() on. Empty: shows nothing at once. Does
  /// nothing if they are the present edits. Requires valid edits that have voxels.
  void set(std::vector<EditDescriptor> edits);
  /// Sets the materials of the world. Makes all ghosts again.
  void set_materials(MeshMaterialsPtr materials);

  /// Compares the chunks with those that were previewed, and makes ghosts again where the edits or
  /// the chunks changed: at most `chunks_max` chunks in this call. Returns true if ghosts()
  /// changed. Requires an open replica. Cost: O(touched chunks), and for each chunk that is made
  /// O(rows of the edits + runs + quads).
  bool step(const Replica& replica, std::size_t chunks_max);
  /// Returns true if ghosts() shows the present edits on the chunks of the last step().
  bool is_complete() const { return stage_ == Stage::complete && !is_restarted_; }

  /// Returns true if a chunk that the edits touch, or a neighbour of one, changed since the work
  /// began. Tools read the neighbours, too. Cost: O(touched chunks).
  bool is_outdated(const Replica& replica) const;

  const std::vector<EditDescriptor>& edits() const { return edits_; }
  const std::vector<GhostChunk>& ghosts() const { return ghosts_; }
  /// Returns the number of touched chunks that are not here, and so have no ghost.
  std::size_t missing_chunks() const { return missing_; }
  /// Returns true if the edits touch more than kChunksMax chunks.
  bool is_cut() const { return is_cut_; }
  /// Returns the numbers of voxels that the edits would set and clear, in the chunks that are here.
  std::uint64_t placed_voxels() const { return placed_; }
  std::uint64_t removed_voxels() const { return removed_; }

 private:
  enum class Stage : std::uint8_t { compare, mesh, complete };
  struct Part {
    ShownPtr shown;            // the runs that were previewed; null: not here
    RunChunk placed, removed;  // voxels of the difference; empty elsewhere
    bool has_placed = false, has_removed = false;
  };

  /// A turned paste at the origin, and a paste without orientation that has the same effect.
  struct StraightPaste {
    std::shared_ptr<const Clipboard> clipboard;
    Orientation orientation;
    std::optional<Paste> straight;
  };

  /// Fills applied_ with edits_, and replaces turned pastes by pastes without orientation.
  void straighten();
  void begin(const Replica& replica);
  void watch(const Replica& replica);
  void compare(ChunkCoord at, Part& part);
  std::shared_ptr<const ChunkMesh> mesh(ChunkCoord at, RunChunk Part::* runs, bool Part::* has);

  std::vector<EditDescriptor> edits_;
  std::vector<EditDescriptor> applied_;
  StraightPaste straight_;  // of the last turned paste: moving it keeps its orientation
  std::int32_t edge_ = 0;
  std::vector<ChunkCoord> chunks_;  // ascending
  std::map<ChunkCoord, Part> parts_;
  /// The chunks and their neighbours, as they were when the work began.
  std::map<ChunkCoord, ShownPtr> watched_;
  Stage stage_ = Stage::complete;
  std::size_t next_ = 0;  // chunk of the stage
  bool is_restarted_ = false;
  std::vector<GhostChunk> ghosts_, made_;
  std::size_t missing_ = 0;
  bool is_cut_ = false;
  std::uint64_t placed_ = 0, removed_ = 0;
  std::uint64_t made_placed_ = 0, made_removed_ = 0;
  MeshMaterialsPtr materials_ = std::make_shared<const MeshMaterials>();
  ApplyScratch apply_;
  ChunkMeshScratch mesher_;
};

}  // namespace runstone
